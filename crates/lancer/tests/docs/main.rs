//! What the documents say holds: links lead somewhere, scenes read, messages are the program's own, code is compiled.
//!
//! The documents are the Markdown files of the repository. How a command line is written is checked beside the
//! parser of command lines, in `src/documents.rs`.

mod code;
mod links;
mod pages;
#[cfg(unix)]
mod scenes;
