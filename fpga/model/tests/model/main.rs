//! The reference model against hand calculation, the paper's figures and values from other programs.

// clippy.toml allows `unwrap` inside #[test] functions, but not in the functions that several tests call.
#![allow(clippy::unwrap_used)]

mod at_speed;
mod calibrated;
mod camera;
mod corrector;
mod exhaustive;
mod fast;
mod geometry;
mod golden;
mod grid;
mod grid_fast;
mod grid_golden;
mod grid_legal;
mod grid_lens;
mod kernel;
mod lens;
mod projection;
mod real;
mod row_factor;
mod scenes;
mod table;

use halfrow_model::RowFactor;

/// A row factor of 1, in units of 2^-24.
const ONE: u32 = 1 << 24;

/// The row factor of `units`, which must be 1 to 2^24.
fn row_factor(units: u32) -> RowFactor {
    RowFactor::new(units).unwrap()
}
