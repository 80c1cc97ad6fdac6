//! A board in Rust: it corrects a frame as the hardware does, one pixel clock at a time.
//!
//! ```text
//! Options (the build) ─┐
//! Settings (the run) ──┼─► Player ─ one sample a pixel clock ─► Core ─ half a row later ─► OutBanks
//! Tables (two banks) ──┘   blanking, gaps, flush               ring, window, weights
//! ```
//!
//! [`Core`] is the datapath with its one ring of samples and its timing. [`Player`] feeds it rows and measures how long each
//! takes. [`Tables`] hold the row factors, or a grid of factors, and the kernel, in a shadow bank and an active one. Behind the
//! wire a board also makes and signs frames of its own, as `fpga/AT-SPEED.md` says. It makes about one of 1920 x 1080 with
//! every packet that it gets, so that this takes no time of its own either. [`BoardFault`] breaks one part of the board on
//! purpose, so that a judge of boards can be judged.
//!
//! The crate shares no arithmetic with the reference model: both follow `fpga/DATAPATH.md` on their own.

mod banks;
mod board;
mod burst;
mod connect;
mod content;
mod core;
mod depth;
mod faults;
mod gaps;
mod options;
mod player;
mod settings;
mod tables;

pub use crate::banks::{OutBanks, RowName, RowOut};
pub use crate::board::Board;
pub use crate::connect::{ConnectError, board_build, board_fault, connect};
pub use crate::core::{
    Core, Entering, GridShape, Kernel, Leaving, NODES, Node, RowBinding, RowValues, UNSTRETCHED, Weight,
};
pub use crate::depth::Depth;
pub use crate::faults::{BoardFault, Conduct, FAULTS, Misread, Streamed, catalogue};
pub use crate::options::{BurstBuild, OptionError, Options, TapCount};
pub use crate::player::{PlayError, Player, RowIn};
pub use crate::settings::{Settings, SettingsError};
pub use crate::tables::{Bank, Bound, Port, TableError, Tables};
