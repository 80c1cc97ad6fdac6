//! The diagnosis against boards that are known to be broken: the mock's core, an implementation of its own with faults,
//! and frames that are altered by hand.

// clippy.toml allows these inside #[test] functions, but not in functions that several tests call.
#![allow(clippy::unwrap_used, clippy::panic)]

mod altered;
mod bench;
mod grids;
mod memory;
mod misread;
mod patterns;
mod read_back;
mod scenes;
mod settings;
mod share;
mod tables;
mod taps;
mod unsure;
mod words;
