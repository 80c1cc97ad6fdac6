//! The laboratory next to the judge: [`paper`] reproduces the figures of the paper, [`training`] fits kernels to photographs, and
//! [`Residuals`] tell what tables leave of a lens's distortion. No judge of boards depends on it.

#![warn(missing_debug_implementations)]

pub mod paper;
mod residuals;
pub mod training;

pub use residuals::{Amounts, Part, Residuals};
