//! What the programs `halfrow` and `halfrow-station` stand on, so that scripts and people find the same in both.
//!
//! * [`exit`]: the exit codes.
//! * [`console`]: the one place that writes to stdout and stderr.
//! * [`log`]: what goes to stderr when somebody wants to know.
//! * [`guard`]: a panic is an error with exit code 3, never 101.
//! * [`line`]: what a command line that asks for help, or is wrong, is told.

pub mod console;
pub mod exit;
pub mod guard;
pub mod line;
pub mod log;
