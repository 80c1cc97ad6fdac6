//! Frames: files of every format, built-in frames, previews.

// clippy.toml allows this in #[test] functions, but not in the functions that several tests call.
#![allow(clippy::unwrap_used)]

mod builtin;
mod dng;
mod files;
mod fuzz;
mod misread;
mod photographs;
mod pictures;
mod preview;
mod samples;
mod street;
