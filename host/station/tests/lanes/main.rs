//! A station with several lanes, by its program: scans in, news out.

// A helper that cannot go on fails the test.
#![allow(clippy::panic, clippy::unwrap_used)]

mod ends;
mod floor;
mod hooks;
mod refused;
mod shift;
