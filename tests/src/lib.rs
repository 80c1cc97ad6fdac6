//! The same scenarios on every kind of board, the command line from outside, and campaigns of random faults.
//!
//! [`scenarios`] says what `halfrow verify` must find on which board; [`program`] starts the program as a user does. [`served`]
//! puts boards behind serial ports and TCP ports that the tests make, [`proxy`] spoils a connection, [`altered`] rewrites the
//! packets of a board, and [`through`] the exchanges of a link. [`campaign`] draws hundreds of single faults of the board, and
//! [`poor_links`] thousands of links; both call the library, so that a run costs no more than its samples.

// A crate for tests alone: it panics to say that something is wrong.
#![allow(clippy::unwrap_used, clippy::panic)]

pub mod altered;
pub mod campaign;
pub mod cases;
pub mod dice;
pub mod late_host;
pub mod not_tested;
pub mod parallel;
pub mod patience;
pub mod photographs;
pub mod poor_links;
pub mod program;
pub mod proxy;
pub mod scenario;
pub mod scenarios;
pub mod served;
pub mod system;
pub mod through;
pub mod usb;
