//! The program as its users meet it: run from outside, judged by exit codes, streams and files.

mod compare;
mod errors;
mod inspect;
#[cfg(unix)]
mod interrupt;
mod messages;
mod output;
mod picture;
mod sandbox;
#[cfg(unix)]
mod terminal;
mod texts;
mod verify;
mod whole;
mod work;
