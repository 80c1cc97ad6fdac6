//! Test patterns: frames that each test one thing in the datapath.

use halfrow_model::{Colour, Frame, FrameError};
use rand_core::Rng;
use rand_pcg::Pcg32;

use super::scene::Scene;

/// Columns from one impulse to the next: one more than the seven taps span, so that no output depends on two.
const IMPULSE_SPACING: usize = 8;

/// The streams of the generator, so that no two patterns share random numbers.
const NOISE_STREAM: u64 = 54;
const EXTREMES_STREAM: u64 = 55;

/// Every sample the same.
pub(super) fn flat(scene: &Scene, level: u16) -> Result<Frame, FrameError> {
    scene.frame(|_, _| level)
}

/// From 0 in the first column to the largest sample in the last.
pub(super) fn ramp_across(scene: &Scene) -> Result<Frame, FrameError> {
    scene.frame(|_, column| ramp(column, scene.geometry.width(), scene.max()))
}

/// From 0 in the first row to the largest sample in the last.
pub(super) fn ramp_down(scene: &Scene) -> Result<Frame, FrameError> {
    scene.frame(|row, _| ramp(row, scene.geometry.height(), scene.max()))
}

/// `max · place / (count − 1)`, rounded half up.
fn ramp(place: usize, count: usize, max: u16) -> u16 {
    let last = (count - 1).max(1);
    u16::try_from((place * usize::from(max) + last / 2) / last).unwrap_or(max)
}

/// White, yellow, cyan, green, magenta, red, blue and black, from left to right.
pub(super) fn bars(scene: &Scene) -> Result<Frame, FrameError> {
    scene.frame(|row, column| {
        let bar = column * 8 / scene.geometry.width();
        let dark = match scene.phase.colour(row, column) {
            Colour::Blue => bar & 1,
            Colour::Red => bar & 2,
            Colour::Green => bar & 4,
        };
        if dark == 0 { scene.max() } else { 0 }
    })
}

/// Neighbours of one colour alternate, across and down: squares of two by two samples. Squares of one sample would make
/// each colour flat.
pub(super) fn checkerboard(scene: &Scene) -> Result<Frame, FrameError> {
    scene.frame(|row, column| if (row / 2 + column / 2) % 2 == 0 { 0 } else { scene.max() })
}

/// Single samples, bright in even rows and dark in odd ones, that move by three columns from one pair of rows to the
/// next: in 16 rows every column has had both.
pub(super) fn impulses(scene: &Scene) -> Result<Frame, FrameError> {
    scene.frame(|row, column| {
        let hit = column % IMPULSE_SPACING == row / 2 * 3 % IMPULSE_SPACING;
        if hit == (row % 2 == 0) { scene.max() } else { 0 }
    })
}

/// Uniform over the full range.
pub(super) fn noise(scene: &Scene) -> Result<Frame, FrameError> {
    let mut random = Pcg32::new(scene.seed, NOISE_STREAM);
    let shift = u32::BITS - scene.geometry.depth().bits();
    scene.frame(|_, _| u16::try_from(random.next_u32() >> shift).unwrap_or(u16::MAX))
}

/// 0 and the largest sample only, in eight kinds of rows that repeat: one colour at an extreme while the other alternates, which
/// drives a Hermite sum beyond either end of the range; pairs of one colour, which do the same to a cubic sum; and random rows.
pub(super) fn extremes(scene: &Scene) -> Result<Frame, FrameError> {
    let mut random = Pcg32::new(scene.seed, EXTREMES_STREAM);
    scene.frame(|row, column| {
        let resting =
            |parity: usize, high: bool| if column % 2 == parity { high } else { column / 2 % 2 == 0 };
        let high = match row % 8 {
            0 => resting(0, true),
            1 => resting(0, false),
            2 => resting(1, true),
            3 => resting(1, false),
            4 => column / 4 % 2 == 0,
            5 => (column + 2) / 4 % 2 == 0,
            _ => random.next_u32() & 1 == 1,
        };
        if high { scene.max() } else { 0 }
    })
}

/// Rings around the optical centre's column in the frame's middle row, ever finer: half a frame to the side they reach a quarter
/// of a cycle per column, the finest that one colour can show.
pub(super) fn zone_plate(scene: &Scene) -> Result<Frame, FrameError> {
    let (width, height) = (scene.geometry.width() as u64, scene.geometry.height() as u64);
    let centre2 = u64::from(scene.geometry.centre2());
    scene.frame(|row, column| {
        let x2 = (2 * column as u64).abs_diff(centre2);
        let y2 = (2 * row as u64).abs_diff(height - 1);
        // r² / 4W turns, r² = (x2² + y2²) / 4, in units of 2^-32 turn; whole turns drop out.
        let turn = ((x2 * x2 + y2 * y2) << 28) / width;
        let bright = 0.5 + 0.5 * cosine(turn as u32);
        (bright * f64::from(scene.max()) + 0.5) as u16
    })
}

/// cos(2π · turn / 2^32) to about 10 digits, from basic arithmetic alone, so that it is the same on every machine.
fn cosine(turn: u32) -> f64 {
    const QUARTER: u32 = 1 << 30;
    let angle = turn.min(turn.wrapping_neg());
    let (angle, sign) = if angle > QUARTER { (2 * QUARTER - angle, -1.0) } else { (angle, 1.0) };
    let x = f64::from(angle) * (std::f64::consts::TAU / 4_294_967_296.0);
    let terms = [1.0, -2.0, -12.0, -30.0, -56.0, -90.0, -132.0, -182.0];
    let (series, _) = terms.iter().fold((0.0, 1.0), |(sum, power), divisor| {
        let term = power / divisor;
        (sum + term, term * x * x)
    });
    sign * series
}
