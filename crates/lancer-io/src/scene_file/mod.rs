//! Scene files: YAML 1.2, and JSON as a part of it.

mod syntax;
