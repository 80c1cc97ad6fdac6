//! Which single faults of the Verilog each part of a run finds, as measured, and which parts to take for a given time.

mod choice;
mod faults;

pub use choice::{Choice, choose, steps};
pub use faults::{Faults, FaultsError, Which};
