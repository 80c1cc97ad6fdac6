//! The station, by its library and by its program; one program of tests, which is linked once.

// A helper that cannot go on fails the test.
#![allow(clippy::panic, clippy::unwrap_used)]

mod clocks;
mod common;
mod compiled_once;
mod documents;
mod floor;
#[path = "../../../../tests/src/program/held.rs"]
// It is public where the tests of `halfrow` have it.
#[allow(unreachable_pub)]
mod held;
mod history;
mod jobs;
mod lanes;
mod manual;
mod metrics;
mod pages;
mod plans;
mod plant;
mod runs;
mod service;
mod settings;
mod sinks;
mod trial;
