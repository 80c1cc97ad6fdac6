//! The library, as called by a program other than `halfrow`.

// clippy.toml allows it inside #[test] functions, but not in the functions that several tests call.
#![allow(clippy::unwrap_used)]

mod coded;
mod corrected;
mod evidence;
mod logs;
mod outside;
mod own_link;
mod parts;
mod refused;
mod tree;
mod within;
mod words;

use std::sync::Mutex;

/// Held by tests that run in this process: a thread without a log of its own must not be the first at a place that logs while
/// another thread installs its log.
static RUNS: Mutex<()> = Mutex::new(());
