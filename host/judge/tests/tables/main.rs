//! Table and kernel files.

// clippy.toml allows this inside #[test] functions, but not in functions that several tests call.
#![allow(clippy::unwrap_used)]

mod json;
mod mem;
mod properties;
mod refusals;
