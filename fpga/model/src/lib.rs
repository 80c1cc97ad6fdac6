//! The reference: what a board must compute.

mod bayer;
mod frame;

pub use bayer::{Colour, Phase, UnknownPhase};
pub use frame::{BitDepth, Frame, FrameError};
