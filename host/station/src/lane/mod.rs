//! A lane: one process that carries out the steps of one run, and the supervisor that can kill it.
//!
//! ```text
//!  supervisor ── a job, rulings, and a stop ────► stdin
//!             ◄── messages, one JSON line each ── stdout    lane ─► the judge ─► board
//! ```
//!
//! The lane has neither store nor verdict: it asks the station whether the device may have the serial number. It ends
//! when its stdin does, so it cannot outlive the station.

mod acts;
pub mod child;
mod doing;
pub(crate) mod kept_frame;
mod kept_report;
mod message;
mod progress;
pub mod supervisor;

/// The size of the largest file that a lane may write, that is written down of what it reports, or that is kept of both, in MiB.
/// All the frames that it keeps have half of that.
pub(crate) const FILE_MIB: u64 = 64;

/// How much memory a lane may have by default, in MiB of addresses. It takes some 60 MiB at work; the stacks and
/// arenas of its threads count as addresses, too.
pub const MEMORY_MIB: u64 = 4096;
/// How much it may be given, in MiB.
pub(crate) const MEMORIES_MIB: std::ops::RangeInclusive<u64> = 64..=1_048_576;

pub use doing::Doing;
pub use message::{Control, LaneJob, Message, Ruling};
