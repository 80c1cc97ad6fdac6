//! The library as a program other than `halfrow` calls it.

// clippy.toml allows it inside #[test] functions, but not in the functions that several tests call.
#![allow(clippy::unwrap_used)]

mod evidence;
mod logs;
mod outside;
mod tree;
mod words;
