//! The wire from outside: a host's bytes, a mock board's answers, and the clock between them.

// Test code: a failed unwrap is a failed test.
#![allow(clippy::panic, clippy::unwrap_used)]

mod clock;
mod endpoint;
mod exchange;
mod faults;
mod options;
mod support;
