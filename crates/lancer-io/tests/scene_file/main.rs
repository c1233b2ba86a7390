//! Scene files from bytes to scenes and messages, as a user sees it.

mod changes;
mod common;
mod hostile;
mod models;
mod overrides;
mod patch;
mod schema;
mod whole;
mod write;
