//! Fitting a kernel to photographs by least squares under the constraints of the datapath (DATAPATH.md, "Kernel").
//!
//! An output is linear in the weights of the two nodes around it. So the nodes that bring corrected photographs closest to the
//! originals solve one system of linear equations. G2 and R3 are never unknowns: their weights follow from the others, in the
//! equations as in the datapath. So a fitted kernel keeps a flat field, whatever the photographs are.

mod equations;
mod figures;
mod measure;
mod model;

pub use equations::{Equations, RIDGE};
pub use figures::noise_gain;
pub(crate) use measure::Warped;
pub use measure::{Gains, Spread, measure};
pub use model::{Model, Warp};

use halfrow_model::{
    CorrectError, FrameError, GeometryError, Interpolant, Kernel, KernelError, LensError, MAX_HEIGHT,
    MAX_WIDTH, MIN_WIDTH, TableError, Taps,
};

use halfrow::frames::preview::RgbImage;
use halfrow::link::Class;
use halfrow::progress::Progress;

/// A kernel and its gains.
#[derive(Clone, Debug)]
pub struct Trained {
    /// The weights.
    pub kernel: Kernel,
    /// The gain over Hermite on each photograph of a kernel fitted to all the others, in dB; none if the others determine no
    /// kernel, or if the photograph has no detail to gain on.
    pub held_out: Vec<Option<f64>>,
    /// The gain over Hermite on the photographs that it was fitted to, in dB; none if they have no detail to gain on.
    pub gain: Option<f64>,
}

/// What keeps a kernel from being fitted or measured.
#[derive(Debug, thiserror::Error)]
pub enum TrainingError {
    /// The photograph has a size that no frame can have.
    #[error(
        "a photograph cannot be a frame; scale it to {least} to {most} columns and at most {rows} rows",
        least = MIN_WIDTH,
        most = MAX_WIDTH,
        rows = MAX_HEIGHT
    )]
    Geometry(#[from] GeometryError),
    /// The photographs have too little detail to determine a kernel.
    #[error("the photographs determine no kernel; give some with detail in them")]
    Singular,
    /// A weight of the fitted kernel does not fit into 16 bits.
    #[error("the fitted kernel cannot be stored; give more photographs")]
    Kernel(#[from] KernelError),
    /// The photograph has too few rows for the experiment's lens.
    #[error("the photograph is too low for a lens; give one of more rows")]
    Lens(#[from] LensError),
    /// The row factors of the experiment could not be made.
    #[error("the tables of the experiment cannot be made; this is a fault of halfrow, so report it")]
    Table(#[from] TableError),
    /// A frame of the experiment could not be made.
    #[error("a frame of the experiment cannot be made; this is a fault of halfrow, so report it")]
    Frame(#[from] FrameError),
    /// A frame of the experiment could not be corrected.
    #[error("a frame of the experiment cannot be corrected; this is a fault of halfrow, so report it")]
    Correct(#[from] CorrectError),
}

impl TrainingError {
    /// Who can do something about it: photographs are the caller's, everything else is this program's.
    #[must_use]
    pub fn class(&self) -> Class {
        match self {
            Self::Table(_) | Self::Frame(_) | Self::Correct(_) => Class::Station,
            _ => Class::Call,
        }
    }
}

/// A squared error, in levels of 255, up to which there is none: what remains is rounding in the equations.
const EXACT: f64 = 1e-6;

/// The kernel that fits `photographs` best under all of [`Model::ALL`]. Each photograph has the same weight, whatever its size.
///
/// # Errors
/// [`TrainingError`] when no frame can have the size of a photograph, or the photographs determine no kernel.
pub fn train(
    photographs: &[RgbImage],
    taps: Taps,
    progress: &dyn Progress,
) -> Result<Trained, TrainingError> {
    let mut each = Vec::with_capacity(photographs.len());
    for (index, photograph) in photographs.iter().enumerate() {
        progress.frame(&format!("photograph {}", index + 1));
        each.push(equations_of(photograph)?);
        progress.rows(photograph.height as u64);
    }
    let mut all = Equations::new();
    for equations in &each {
        all.add(equations, 1.0);
    }
    let kernel = all.kernel(taps)?;
    let held_out = each.iter().map(|equations| {
        let mut others = all.clone();
        others.add(equations, -1.0);
        others.kernel(taps).ok().and_then(|kernel| gain(equations, &kernel))
    });
    let held_out = held_out.collect();
    Ok(Trained { gain: gain(&all, &kernel), kernel, held_out })
}

/// Checks that the experiments can use the size of `photograph`.
///
/// # Errors
/// [`TrainingError`] when they cannot.
pub fn check(photograph: &RgbImage) -> Result<(), TrainingError> {
    Model::ALL.iter().try_for_each(|model| model.tables(photograph.width & !1, photograph.height).map(drop))
}

/// The equations of a photograph under all models, per sample.
fn equations_of(photograph: &RgbImage) -> Result<Equations, TrainingError> {
    let mut equations = Equations::new();
    for model in Model::ALL {
        equations.observe(&model.warped(photograph)?);
    }
    Ok(equations.per_sample())
}

/// How much closer to the photographs the kernel comes than Hermite, in dB; none if Hermite leaves no error.
fn gain(equations: &Equations, kernel: &Kernel) -> Option<f64> {
    let hermite = equations.error(&Interpolant::Hermite.into());
    let own = equations.error(kernel).max(f64::MIN_POSITIVE);
    (hermite > EXACT).then(|| 10.0 * (hermite / own).log10())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// At node 0 every interpolant gives G2 alone.
    #[test]
    fn a_gain_over_no_error_is_no_figure() {
        let taps = [90.0, 80.0, 20.0, 60.0, 10.0, 50.0, 40.0];
        let mut equations = Equations::new();
        equations.sample(0, 0.0, taps, 20.0);
        assert_eq!(gain(&equations, &Interpolant::Keys.into()), None);
        equations.sample(0, 0.0, taps, 21.0);
        assert_eq!(gain(&equations, &Interpolant::Keys.into()), Some(0.0));
    }
}
