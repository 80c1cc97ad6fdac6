//! A lane: one process that carries out the steps of one run, and the supervisor that can kill it.
//!
//! ```text
//!  supervisor ── a job, then what to stop for ──► stdin
//!             ◄── messages, one JSON line each ── stdout    lane ─► the judge ─► board
//! ```
//!
//! The lane has neither store nor verdict: it asks the station whether the device may have the serial number. It ends when its stdin does, so that it cannot outlive the station.

mod acts;
pub mod child;
pub(crate) mod kept_frame;
mod message;
mod progress;
pub mod supervisor;

pub use message::{Control, Job, Message, Ruling, Stopper};
