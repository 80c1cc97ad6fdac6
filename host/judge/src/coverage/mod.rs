//! Which single faults of the Verilog each part of a run finds, as measured, and what to take of a run for the time that there is.

mod choice;
mod faults;

pub use choice::{Choice, choose, steps};
pub use faults::{Faults, FaultsError, Which};
