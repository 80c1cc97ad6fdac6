//! Table and kernel files.

// clippy.toml allows it inside #[test] functions, but not in the functions that several tests call.
#![allow(clippy::unwrap_used)]

mod json;
mod mem;
mod properties;
mod refusals;
