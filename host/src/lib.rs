//! Tells whether a board that straightens fisheye Bayer video computes what it should, and if not, what is broken.
//!
//! ```text
//!  target ──► link ──► board ──┐                      ┌─► verdict
//!  tables, kernel, frames ─────┼─► session ─► compare ┼─► report
//!  halfrow_model ──────────────┘                      └─► diagnosis
//! ```
//!
//! Only [`link`] touches a device, only [`board`] speaks the protocol, and [`session`] is the one that knows the order of
//! things. [`discovery`] finds what could be a board, [`link_test`] measures what a link can do, [`serve`] puts a board of
//! this program behind a device of its own, [`lenses`] reads what calibrations leave, [`paper`] reproduces the figures of
//! the paper, and [`training`] fits kernels to photographs.
//! [`compare`], [`diagnosis`] and [`report`] see samples and counts, never a link.

pub mod board;
pub mod commands;
pub mod compare;
pub mod correction;
pub mod diagnosis;
pub mod discovery;
pub mod frames;
pub mod kernels;
pub mod lenses;
pub mod link;
pub mod link_test;
pub mod paper;
pub mod progress;
pub mod reference;
pub mod report;
pub mod result;
pub mod serve;
pub mod session;
pub mod settings;
pub mod tables;
pub mod target;
pub mod training;
pub mod verdict;
pub mod written_aside;
