//! Files on disk, whatever is in them: outputs that are whole or as they were, inputs whose bytes can be looked at again, and the
//! text of small ones.

#![warn(missing_debug_implementations)]

#[cfg(not(target_os = "linux"))]
compile_error!("halfrow-files is for Linux alone; docs/portable.md says what works elsewhere");

mod regular;
mod system;
pub mod text;
pub mod written_aside;

pub use regular::{NotRegular, check_regular};
pub use system::{asked_of_system, is_of_system};
