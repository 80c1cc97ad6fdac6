//! The reference: what a board must compute.
//!
//! From the lens to the corrected frame, in the order of the data:
//!
//! ```text
//! Equidistant ──► TableSet ─┐                            row factors or a grid; Camera makes one for a calibrated lens
//! Interpolant ──► Kernel ───┼─► correct ──► Frame     the integer datapath, bit for bit
//! Frame ────────────────────┘
//! ```
//!
//! [`correct`] is the oracle: it implements `fpga/DATAPATH.md` and a board must equal it. [`Corrector`] gives the same bits
//! many times faster, with vector instructions where the processor has them, for every table that [`TableSet::check_ring`]
//! accepts. A [`Signer`] predicts the signatures of frames that a board makes on its own, from the [`Content`] of
//! `fpga/AT-SPEED.md`. [`correct_real`] computes the same correction in double precision, to show what the integers cost.
//! Equation and section numbers in this crate are those of Lai et al., *Real-time distortion correction of fish-eye lens based
//! on Bayer image signal*, Optical Review 2014. The crate knows no board, no protocol and no file format.

#![warn(missing_debug_implementations)]

mod bayer;
mod calibrated;
mod camera;
mod content;
mod corrector;
mod fast;
mod frame;
mod geometry;
mod grid;
mod interpolant;
mod kernel;
mod lens;
mod profile;
mod projection;
mod real;
mod ring;
mod row_factor;
mod table;

pub use bayer::{Colour, Phase, UnknownPhase};
pub use calibrated::CalibratedLens;
pub use camera::{Camera, CameraError, Residual, Target};
pub use content::{Content, frame_signature, row_signature, xorshift32};
pub use corrector::{
    CorrectError, Source, correct, correct_row, correct_row_of_values, source, source_by_entry,
};
pub use fast::{Corrector, ModelPath, Signer, UnavailablePath, UnknownPath};
pub use frame::{BitDepth, Frame, FrameError};
pub use geometry::{Geometry, GeometryError, MAX_HEIGHT, MAX_WIDTH, MIN_WIDTH};
pub use grid::{
    GridResidual, GridResiduals, GridRoomError, GridShape, GridShapeError, INNER_DEGREES, INNER_ROWS,
    ResidualSum, RowValues, VISIBLE,
};
pub use interpolant::{Interpolant, UnknownInterpolant};
pub use kernel::{Kernel, KernelError, NODES, TAP_NAMES, Taps, WEIGHT_NAMES, WEIGHT_ONE};
pub use lens::{Equidistant, LensError, MAX_RADIUS, MIN_RADIUS, Short, Spherical};
pub use profile::Profile;
pub use projection::{exact, exact_inverse, simplified, simplified_inverse, stretch_factor};
pub use real::{correct_real, round_to_frame};
pub use ring::LONGEST_RING;
pub use row_factor::{RowFactor, RowFactorError};
pub use table::{TableError, TableSet};
