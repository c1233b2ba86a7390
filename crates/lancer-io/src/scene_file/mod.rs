//! Scene files: YAML 1.2, and JSON as a part of it.

mod deserialize;
mod model;
mod schema;
mod syntax;

pub use schema::json_schema;
