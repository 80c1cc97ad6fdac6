//! Tells whether a board that straightens fisheye Bayer video computes what it should, and if not, what is broken.
//!
//! ```text
//!  target ──► link ──► board ──┐                  ┌─► verdict
//!  tables, kernel, frames ─────┼─► run ─► compare ┼─► report
//!  halfrow_model ──────────────┘                  └─► diagnosis
//! ```
//!
//! Only [`link`] touches a device, only [`board`] speaks the protocol, and [`run`] is the one that knows the order of
//! things. [`probe`] asks a device whether it is a board, [`link_test`] measures what a link can do, [`correction`] uses a
//! board to correct frames, and [`lenses`] reads what calibrations leave.
//! [`compare`], [`diagnosis`], [`result`] and [`report`] see samples and counts, never a link.

pub mod board;
pub mod compare;
pub mod correction;
pub mod diagnosis;
pub mod kernels;
pub mod lenses;
pub mod link_test;
mod probe;
pub mod progress;
pub mod reference;
pub mod report;
pub mod result;
pub mod run;
pub mod tables;
pub mod verdict;

pub use halfrow_frames as frames;
pub use halfrow_link as link;
pub use halfrow_link::target;
pub use probe::probe;

/// The commit that this library was built from, abbreviated; `unknown` without git.
pub const COMMIT: &str = env!("HALFROW_COMMIT");

/// The version and, in brackets, the commit.
pub const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), " (", env!("HALFROW_COMMIT"), ")");
