//! Runs of the program, from the serial number to what is kept.

// A helper that cannot go on fails the test.
#![allow(clippy::unwrap_used)]

mod bench;
mod checked;
mod ends;
mod faults;
mod identity;
mod killed;
mod saved;
mod unsaved;
