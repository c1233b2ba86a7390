//! Scene files from bytes to scenes and messages, as a user sees it.

mod common;
mod hostile;
mod models;
mod overrides;
mod schema;
mod whole;
