//! Judges whether a board that straightens fisheye Bayer video computes what it should, and if not, what is broken.
//!
//! ```text
//!  target ──► link ──► board ──┐                  ┌─► verdict
//!  tables, kernel, frames ─────┼─► run ─► compare ┼─► report
//!  halfrow_model ──────────────┘                  └─► diagnosis
//! ```
//!
//! A program describes what to judge in a [`Plan`], opens a link to a board or brings a [`Candidate`] with a link of its own, and
//! calls [`verify`] with [`RunOptions`]. This returns [`Finished`], which holds a [`Report`] with a [`Verdict`] and its
//! [`Cause`]; [`Finished::commit`] writes it to disk. A run takes the calling thread and one that
//! computes ahead of the board, and reports what it does to a [`Progress`]. The frames that it keeps have a budget,
//! [`RunOptions::evidence_bytes`], so its memory does not grow with the number of frames, except for some hundred bytes each in
//! the report.
//!
//! Errors are typed, and end with what to do. [`Problem::of`](result::Problem::of) makes data of any of them, with a stable code
//! to tell them apart by, which `docs/CODES.md` lists.
//!
//! Cargo's feature `sim` adds the targets of the simulated board, as in [`link`].
//!
//! This library prints nothing, knows no command-line options, and ends no process: its caller does. It knows which [`exit`] code
//! belongs to a result, since every document contains it. It logs to `tracing`; every line of a run is in a span `run` with the
//! target as `board`.
//!
//! # Two boards at once
//!
//! ```
#![doc = include_str!("../examples/two_boards.rs")]
//! ```
//!
//! # A link of one's own
//!
//! ```
#![doc = include_str!("../examples/own_link.rs")]
//! ```
//!
//! # Inside
//!
//! Only [`link`] touches a device, only [`board`] sends and receives, and [`run`] alone knows the order of things; its rules
//! write requests by hand. [`probe`] asks a device whether it is a board, [`link_test`] measures what a link can do,
//! [`correction`] uses a board to correct frames, [`lenses`] reads the files of calibration programs, [`optics`] makes plans of
//! them, and [`call`] checks the files and options of a call before anything is done.
//! [`compare`], [`diagnosis`], [`result`] and [`report`] see samples and counts, never a link.
//! [`words`] has the numbers and names in the form in which all of them are reported.

#![warn(missing_debug_implementations)]

pub mod board;
pub mod call;
pub mod compare;
pub mod correction;
pub mod coverage;
pub mod diagnosis;
pub mod exit;
pub mod kernels;
pub mod lenses;
pub mod link_test;
pub mod optics;
mod probe;
pub mod progress;
pub mod reference;
pub mod report;
pub mod result;
pub mod run;
pub mod tables;
pub mod verdict;
pub mod words;

pub use halfrow_files as files;
pub use halfrow_frames as frames;
pub use halfrow_link as link;
pub use halfrow_link::target;
pub use halfrow_model as model;

pub use board::Stop;
pub use link::{Candidate, Link, LinkError, Reopener};
pub use probe::probe;
pub use progress::{Event, Progress, Soaked, Step};
pub use report::ReportFolder;
pub use result::Report;
pub use run::{Finished, FrameSource, Misfit, Plan, RunOptions, verify};
pub use verdict::{Cause, StoppedBy, Verdict};

/// The abbreviated commit that this library was built from; `unknown` without git, and in builds that are not optimised.
pub const COMMIT: &str = env!("HALFROW_COMMIT");

/// The version and, in brackets, the commit.
pub const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), " (", env!("HALFROW_COMMIT"), ")");

/// The system that this library was built for, as Rust calls it.
pub const TARGET: &str = env!("HALFROW_TARGET");

/// The compiler that it was built by, with its version.
pub const RUSTC: &str = env!("HALFROW_RUSTC");
