//! The board's Verilog under Verilator, as a board.
//!
//! ```text
//! halfrow_pipe::Pipe ─ Board ─┬─ byte ports ───────────────────────────► halfrow_bridge
//!   speed, delay, faults      ├─ a UART's other end ── txd rxd rts cts ► halfrow_uart_bridge
//!                             └─ an FT2232H ── rd wr rxf txe siwu data ► halfrow_fifo_bridge
//! ```
//!
//! [`Board`] is an end of a pipe, like the mock, so the pipe's options and faults are the same for both. The pipe's clock
//! stands still while the design is simulated, as it does while the mock computes.
//!
//! [`Core`] is the corrector alone, clock by clock, for tests (feature `builds`). [`FaultyBoard`] is a build that contains many
//! faults, one of which is chosen by its number (feature `library`).

#[cfg(not(target_os = "linux"))]
compile_error!("halfrow-sim is for Linux alone; docs/portable.md says what works elsewhere");

mod board;
mod byte_port;
#[cfg(feature = "builds")]
mod core;
mod ffi;
mod ft2232h;
#[cfg(feature = "library")]
mod library;
mod port;
mod uart;

pub use crate::board::{Board, Build, Failure, Front, TraceError};
#[cfg(feature = "builds")]
pub use crate::core::{Core, CoreBuild};
#[cfg(feature = "builds")]
pub use crate::ffi::{CoreInputs, CoreOutputs};
#[cfg(feature = "library")]
pub use crate::library::{FaultyBoard, LibraryError};
