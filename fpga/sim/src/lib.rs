//! The board's Verilog under Verilator, as a board.

mod core;
mod ffi;

pub use crate::core::{Core, CoreBuild};
pub use crate::ffi::{CoreInputs, CoreOutputs};
