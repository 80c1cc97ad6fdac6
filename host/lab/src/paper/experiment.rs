//! The experiment of Sect. 4.1 (Fig. 11): distort a photograph, mosaic it, correct it, and compare it with the mosaicked
//! original.

use std::sync::Arc;

use halfrow_model::{
    BitDepth, Equidistant, Frame, Geometry, Interpolant, Kernel, Phase, TableSet, correct_real,
    round_to_frame,
};

use super::distortion::distorted;
use super::photographs::{HEIGHT, WIDTH};
use super::{PaperError, psnr};
use halfrow::frames::mosaic;
use halfrow::frames::preview::RgbImage;
use halfrow::reference;

/// What all photographs share: a lens whose image circle is as wide as the picture, R = W/2 = 384, with its axis in the middle.
#[derive(Clone, Debug)]
pub(crate) struct Experiment {
    geometry: Geometry,
    lens: Equidistant,
    tables: TableSet,
}

/// One photograph, ready for correction.
#[derive(Clone, Debug)]
pub(crate) struct Trial {
    /// What a sensor would see without distortion.
    pub(crate) reference: Frame,
    /// What it sees with distortion.
    pub(crate) distorted: Arc<Frame>,
}

impl Experiment {
    /// The paper's experiment.
    ///
    /// # Errors
    /// Never, since its parameters are legal.
    pub(crate) fn new() -> Result<Self, PaperError> {
        let geometry = Geometry::centred(WIDTH, HEIGHT, BitDepth::Eight)?;
        let lens = Equidistant::from_radius(WIDTH as f64 / 2.0)?;
        let tables = TableSet::from_lens(geometry, &lens, None)?;
        Ok(Self { geometry, lens, tables })
    }

    /// The row factors.
    #[must_use]
    pub(crate) fn tables(&self) -> &TableSet {
        &self.tables
    }

    /// Distorts `photograph` and mosaics both to GRBG, 8 bits.
    ///
    /// # Errors
    /// [`PaperError::Frame`] when it has an odd width.
    pub(crate) fn trial(&self, photograph: &RgbImage) -> Result<Trial, PaperError> {
        let reference = mosaic(photograph, Phase::Grbg)?;
        let distorted = mosaic(&distorted(photograph, &self.lens), Phase::Grbg)?;
        Ok(Trial { reference, distorted: Arc::new(distorted) })
    }

    /// The distorted frame corrected in double precision, rounded to 8 bits.
    ///
    /// # Errors
    /// [`PaperError::Correct`] when the trial has another size.
    pub(crate) fn by_reals(&self, interpolant: Interpolant, trial: &Trial) -> Result<Frame, PaperError> {
        let samples = correct_real(&self.geometry, &self.lens, None, interpolant, &trial.distorted)?;
        Ok(round_to_frame(&samples, &trial.distorted)?)
    }

    /// The distorted frame, corrected by the integer datapath.
    ///
    /// # Errors
    /// [`PaperError::Correct`] when the trial has another size.
    pub(crate) fn by_integers(&self, interpolant: Interpolant, trial: &Trial) -> Result<Frame, PaperError> {
        Ok(reference::correct(&self.tables, &Kernel::from(interpolant), &trial.distorted)?)
    }
}

impl Trial {
    /// The PSNR of corrected samples against the reference, in dB, over the whole frame without leaving out a border.
    #[must_use]
    pub(crate) fn score(&self, corrected: &[u16]) -> f64 {
        psnr(self.reference.samples(), corrected)
    }
}
