//! The reference model against hand calculation, the paper's figures and values from other programs.

// clippy.toml allows it inside #[test] functions, but not in the functions that several tests call.
#![allow(clippy::unwrap_used)]

mod calibrated;
mod camera;
mod corrector;
mod exhaustive;
mod fast;
mod geometry;
mod golden;
mod kernel;
mod lens;
mod projection;
mod real;
mod scenes;
mod table;
