//! The mock board from outside: its datapath, its timing, its tables and its faults.

#![expect(clippy::unwrap_used, reason = "a test helper that cannot go on fails the test")]

mod edges;
mod faults;
mod golden;
mod illegal;
mod options;
mod player;
mod support;
mod table_faults;
mod tables;
mod timing;
