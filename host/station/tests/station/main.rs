//! The tests of the station by its library and by its program. They are one program, which is linked once.

// A helper that cannot go on fails the test.
#![allow(clippy::panic, clippy::unwrap_used)]

mod clocks;
mod common;
mod compiled_once;
mod documents;
mod floor;
#[path = "../../../../tests/src/program/held.rs"]
// It is public since the tests of `halfrow` need that.
#[allow(unreachable_pub)]
mod held;
mod history;
mod jobs;
mod lanes;
mod manual;
mod metrics;
mod named;
mod pages;
mod plans;
mod plant;
mod runs;
mod service;
mod settings;
mod sinks;
mod trial;
mod usage;
