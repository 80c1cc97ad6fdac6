//! How much closer to the truth a kernel comes than Hermite.

use halfrow_model::{Frame, Interpolant, Kernel, TableSet};
use rand_core::Rng;
use rand_pcg::Pcg32;

use super::model::even;
use super::{Model, TrainingError, Warp};
use crate::paper::psnr;
use halfrow::frames::parallel;
use halfrow::frames::preview::{RgbImage, demosaic_coded};
use halfrow::progress::Progress;
use halfrow::reference;

/// R as a multiple of half the picture's height, as in Table 1.
const RADIUS: f64 = 1.5;

/// Standard deviations of the added noise, in levels of 255.
const NOISES: [u8; 3] = [2, 5, 10];

/// Seed of the noise; any number will do.
const SEED: u64 = 5;

/// A distorted photograph, and what its correction should give.
#[derive(Clone, Debug)]
pub(crate) struct Warped {
    /// The row factors that remove the distortion.
    pub tables: TableSet,
    /// What a sensor would see without distortion.
    pub reference: Frame,
    /// What it sees with distortion.
    pub distorted: Frame,
}

/// Mean, least and most of several gains.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Spread {
    /// The mean.
    pub mean: f64,
    /// The least.
    pub least: f64,
    /// The most.
    pub most: f64,
}

/// The gains under one condition.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Gains {
    /// The condition, in words.
    pub condition: String,
    /// PSNR by Hermite in dB: the mean over the photographs that do not come back exactly; none if all do.
    pub hermite: Option<f64>,
    /// By how many dB the kernel is better on these photographs.
    pub gain: Option<Spread>,
    /// The number of photographs that either kernel brings back exactly. For these no figure in dB exists.
    pub exact: usize,
}

impl Spread {
    /// The spread of `gains`, if there are any.
    #[must_use]
    pub fn of(gains: &[f64]) -> Option<Self> {
        (!gains.is_empty()).then(|| Self {
            mean: gains.iter().sum::<f64>() / gains.len() as f64,
            least: gains.iter().copied().fold(f64::INFINITY, f64::min),
            most: gains.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        })
    }
}

#[derive(Clone, Copy)]
enum Condition {
    Warped(Warp),
    Noisy(u8),
    Demosaicked,
}

impl Condition {
    const ALL: [Self; 6] = [
        Self::Warped(Warp::Linear),
        Self::Warped(Warp::BandLimited),
        Self::Noisy(NOISES[0]),
        Self::Noisy(NOISES[1]),
        Self::Noisy(NOISES[2]),
        Self::Demosaicked,
    ];

    fn name(self) -> String {
        match self {
            Self::Warped(Warp::Linear) => "linear warp, as in Table 1".to_owned(),
            Self::Warped(Warp::BandLimited) => "band-limited warp".to_owned(),
            Self::Noisy(deviation) => format!("band-limited warp, noise of {deviation} levels"),
            Self::Demosaicked => "band-limited warp, demosaicked (CPSNR)".to_owned(),
        }
    }
}

/// The gains of `kernel` in the integer datapath, with R as in Table 1, over whole frames.
///
/// # Errors
/// [`TrainingError`] when no frame can have the size of a photograph.
pub fn measure(
    photographs: &[RgbImage],
    kernel: &Kernel,
    progress: &dyn Progress,
) -> Result<Vec<Gains>, TrainingError> {
    let kernels = [Kernel::from(Interpolant::Hermite), kernel.clone()];
    let scores = parallel::map(photographs, |index, photograph| {
        progress.frame(&format!("photograph {}", index + 1));
        let scores = scores(photograph, &kernels);
        progress.rows(photograph.height as u64);
        scores
    });
    let scores = scores.into_iter().collect::<Result<Vec<_>, _>>()?;
    let gains = Condition::ALL.into_iter().enumerate().map(|(place, condition)| {
        let inexact = scores.iter().map(|scores| scores[place]);
        let inexact = inexact.filter(|both| both.iter().all(|score| score.is_finite()));
        let (hermite, gains): (Vec<f64>, Vec<f64>) =
            inexact.map(|[hermite, own]| (hermite, own - hermite)).unzip();
        Gains {
            condition: condition.name(),
            hermite: Spread::of(&hermite).map(|spread| spread.mean),
            gain: Spread::of(&gains),
            exact: scores.len() - gains.len(),
        }
    });
    Ok(gains.collect())
}

/// PSNR in dB by either kernel, under each of [`Condition::ALL`].
fn scores(photograph: &RgbImage, kernels: &[Kernel; 2]) -> Result<Vec<[f64; 2]>, TrainingError> {
    let [linear, band_limited] = Warp::ALL.map(|warp| Model { radius: RADIUS, warp }.warped(photograph));
    let (linear, band_limited) = (linear?, band_limited?);
    let scores = Condition::ALL.map(|condition| {
        let is_linear = matches!(condition, Condition::Warped(Warp::Linear));
        let warped = if is_linear { &linear } else { &band_limited };
        let seen = match condition {
            Condition::Noisy(deviation) => &noisy(&warped.distorted, deviation)?,
            _ => &warped.distorted,
        };
        let score = |kernel| -> Result<f64, TrainingError> {
            let corrected = reference::correct(&warped.tables, kernel, seen)?;
            Ok(score(condition, photograph, &warped.reference, &corrected))
        };
        let [hermite, own] = kernels;
        Ok([score(hermite)?, score(own)?])
    });
    scores.into_iter().collect()
}

/// PSNR in dB.
fn score(condition: Condition, photograph: &RgbImage, reference: &Frame, corrected: &Frame) -> f64 {
    if !matches!(condition, Condition::Demosaicked) {
        return psnr(reference.samples(), corrected.samples());
    }
    let [wanted, found] = [photograph, &demosaic_coded(corrected)].map(colours);
    psnr(&wanted, &found)
}

/// Red, green and blue of every pixel; an odd last column is left out.
fn colours(image: &RgbImage) -> Vec<u16> {
    even(image).data.into_iter().map(u16::from).collect()
}

/// `frame` with noise of the standard deviation `deviation`, the same noise in every call.
fn noisy(frame: &Frame, deviation: u8) -> Result<Frame, TrainingError> {
    let mut random = Pcg32::new(SEED, SEED);
    let max = f64::from(frame.depth().max());
    let samples = frame.samples().iter().map(|&sample| {
        // Twelve uniformly distributed numbers together have a variance of 1, and their sum is nearly normal.
        let normal = (0..12).map(|_| f64::from(random.next_u32()) / 4_294_967_296.0).sum::<f64>() - 6.0;
        (f64::from(sample) + normal * f64::from(deviation) + 0.5).floor().clamp(0.0, max) as u16
    });
    Ok(Frame::new(frame.width(), frame.depth(), frame.phase(), samples.collect())?)
}
