//! The station's pages, by their program and over its socket.

// A helper that cannot go on fails the test.
#![allow(clippy::panic, clippy::unwrap_used)]

mod access;
mod browser;
mod fuzz;
mod http;
mod lanes;
mod station;
mod table;
