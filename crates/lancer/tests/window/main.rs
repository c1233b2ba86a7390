//! The window as its users meet it: on a virtual display, with mouse and keyboard, judged by pixels and files.
//!
//! Pictures of each step stay in `target/tmp/window`.
#![cfg(all(target_os = "linux", feature = "window"))]

mod controls;
mod files;
mod moving;
mod parameters;
mod rendering;
mod sitting;
mod starting;
