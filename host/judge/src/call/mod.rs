//! What every caller that judges boards or makes files needs: what a call reads and writes, and which of its options have an
//! effect.
//!
//! Options have the names that the caller gives them.

mod files;
mod input;
mod options;
mod size;

pub use files::{Files, FilesError, refuse_stdout};
pub use input::Input;
pub use options::{
    BESIDE_RECORDING, FRAMES, MOST_SECONDS, NoTime, REPEATS, VoidOption, Voided, WHILE_RECORDED, WITHIN,
    WITHIN_TAKES, seconds, time_limit, within,
};
pub use size::{FrameOfOtherSize, check_size};
