//! Judges the judge first: values from a program outside this project go through the same path as those of boards.

use halfrow_model::{
    BitDepth, CorrectError, Equidistant, Frame, Geometry, Interpolant, Kernel, Phase, TableSet,
};

use crate::compare::{Comparison, Difference};
use crate::reference::correct;
use crate::result::little_endian;

/// A corrected row computed by another program: W = 64, H = 1, B = 12, C = 63.
struct GoldenRow {
    interpolant: Interpolant,
    corrected: [u16; 64],
}

/// Its row factor.
const ROW_FACTOR: u32 = 14_648_488;

const ROWS: [GoldenRow; 2] = [
    GoldenRow {
        interpolant: Interpolant::Hermite,
        corrected: [
            1938, 356, 2717, 1150, 3620, 2600, 1707, 2388, 1715, 2078, 1454, 432, 2901, 1378, 3607, 1945,
            497, 2939, 1338, 3808, 2772, 1621, 2637, 1949, 1971, 1662, 619, 3089, 1621, 3657, 1989, 686,
            3147, 1845, 176, 2213, 744, 3215, 2171, 1863, 1884, 807, 3277, 1870, 3667, 2065, 894, 3337, 1888,
            226, 2456, 932, 3402, 2379, 1756, 2118, 995, 3465, 2123, 3644, 2171, 1116, 3478, 1895,
        ],
    },
    GoldenRow {
        interpolant: Interpolant::Keys,
        corrected: [
            1931, 464, 2776, 1089, 3910, 1995, 1820, 3119, 952, 2005, 2057, 131, 2989, 1276, 3450, 2119, 530,
            2964, 1302, 4074, 2182, 1772, 3322, 1166, 1947, 2245, 317, 3208, 1464, 3470, 2325, 621, 3212,
            1509, 363, 2370, 625, 3517, 1588, 1887, 2432, 512, 3429, 1652, 3470, 2532, 731, 3304, 1710, 382,
            2558, 844, 3703, 1776, 1829, 2620, 715, 3650, 1839, 3453, 2745, 857, 3370, 1902,
        ],
    },
];

/// Radius of the image circle of the golden frame, in pixels.
const RADIUS: f64 = 1106.697;

/// CRC-32 of the corrected 1920 x 1080 frame, 16 bits little endian, with a five-tap and a seven-tap kernel.
const FRAME_CRCS: [(Interpolant, u32); 2] =
    [(Interpolant::Hermite, 0x3ecf_6d03), (Interpolant::Keys, 0xd55e_261f)];

/// This computer does not calculate correctly, and so cannot judge a board.
#[derive(Debug, thiserror::Error)]
#[error("this computer cannot judge; rebuild halfrow, and if that does not help, test the computer's memory")]
pub(crate) struct CannotJudge(#[from] pub GoldenError);

/// A golden value that was missed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub(crate) enum GoldenError {
    /// The frame or row that is compared with the reference values could not be made.
    #[error("the golden {what} cannot be made")]
    Unmade {
        /// What.
        what: &'static str,
    },
    /// The reference refuses the golden frame.
    #[error(transparent)]
    Correct(#[from] CorrectError),
    /// This computer computes a whole frame otherwise than it should.
    #[error(
        "the golden frame's CRC-32 with {interpolant} is {expected:08x}, and this computer finds {found:08x}"
    )]
    Frame {
        /// The kernel.
        interpolant: Interpolant,
        /// The golden CRC.
        expected: u32,
        /// This computer's.
        found: u32,
    },
    /// This computer computes a row otherwise than it should.
    #[error(
        "the golden {} row has {expected} at column {column}, and this computer finds {found}", interpolant.name()
    )]
    Row {
        /// The kernel.
        interpolant: Interpolant,
        /// The first column that differs.
        column: usize,
        /// The golden sample.
        expected: u16,
        /// This computer's.
        found: u16,
    },
    /// This program takes a wrong sample for a right one.
    #[error("a single wrong bit in the golden {} row went unseen", interpolant.name())]
    Unseen {
        /// The kernel.
        interpolant: Interpolant,
    },
}

/// The sample at `place`, counted row by row, of the frame that the other program corrected.
fn sample(place: usize) -> u16 {
    ((place as u32).wrapping_mul(2_654_435_761) >> 20) as u16
}

fn frame(width: usize, height: usize) -> Option<Frame> {
    let samples = (0..width * height).map(sample).collect();
    Frame::new(width, BitDepth::Twelve, Phase::Grbg, samples).ok()
}

/// Corrects what the other program corrected and compares the results in the same way as those of boards. Returns the number of
/// samples judged.
///
/// # Errors
/// [`GoldenError`], which says what golden value this computer or this build missed.
pub(crate) fn judge_the_judge() -> Result<usize, GoldenError> {
    let mut samples = 0;
    for golden in &ROWS {
        samples += judge_row(golden)?;
    }
    let tables = Equidistant::from_radius(RADIUS)
        .ok()
        .and_then(|lens| TableSet::from_lens(Geometry::default(), &lens, None).ok());
    let (frame, tables) = frame(1920, 1080).zip(tables).ok_or(GoldenError::Unmade { what: "frame" })?;
    for (interpolant, crc) in FRAME_CRCS {
        samples += judge_frame(&tables, &frame, interpolant, crc)?;
    }
    Ok(samples)
}

fn judge_frame(
    tables: &TableSet,
    frame: &Frame,
    interpolant: Interpolant,
    expected: u32,
) -> Result<usize, GoldenError> {
    let corrected = correct(tables, &Kernel::from(interpolant), frame)?;
    match crc32fast::hash(&little_endian(corrected.samples())) {
        crc if crc == expected => Ok(corrected.samples().len()),
        found => Err(GoldenError::Frame { interpolant, expected, found }),
    }
}

fn judge_row(golden: &GoldenRow) -> Result<usize, GoldenError> {
    let interpolant = golden.interpolant;
    let found = Geometry::new(64, 1, BitDepth::Twelve, 63)
        .ok()
        .and_then(|geometry| TableSet::from_units(geometry, &[ROW_FACTOR]).ok())
        .zip(frame(64, 1))
        .and_then(|(tables, frame)| correct(&tables, &Kernel::from(golden.interpolant), &frame).ok())
        .ok_or(GoldenError::Unmade { what: "row" })?;
    let mut comparison = Comparison::new(64, 1);
    comparison.row(0, &golden.corrected, found.samples());
    if let Some(Difference { column, expected, found, .. }) = comparison.first {
        return Err(GoldenError::Row { interpolant, column, expected, found });
    }
    let mut spoilt = golden.corrected;
    spoilt[40] ^= 1;
    let mut comparison = Comparison::new(64, 1);
    comparison.row(0, &spoilt, found.samples());
    match comparison.differences {
        1 => Ok(golden.corrected.len()),
        _ => Err(GoldenError::Unseen { interpolant }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn this_computer_can_judge() {
        assert_eq!(judge_the_judge(), Ok(2 * 64 + 2 * 1920 * 1080));
    }

    #[test]
    fn a_computer_that_computes_otherwise_cannot() {
        let mut corrected = ROWS[0].corrected;
        corrected[5] += 1;
        let error =
            judge_row(&GoldenRow { interpolant: Interpolant::Hermite, corrected }).unwrap_err().to_string();
        assert!(error.contains("has 2601 at column 5") && error.contains("finds 2600"), "{error}");
    }

    /// The golden row as a frame, whose CRC is that of what the other program computed.
    #[test]
    fn a_frame_that_comes_out_otherwise_is_told_with_both_crcs() {
        let geometry = Geometry::new(64, 1, BitDepth::Twelve, 63).unwrap();
        let tables = TableSet::from_units(geometry, &[ROW_FACTOR]).unwrap();
        let crc = crc32fast::hash(&little_endian(&ROWS[0].corrected));
        let judged = |crc| judge_frame(&tables, &frame(64, 1).unwrap(), Interpolant::Hermite, crc);
        assert_eq!(judged(crc), Ok(64));
        let (interpolant, expected) = (Interpolant::Hermite, crc ^ 1);
        assert_eq!(judged(expected), Err(GoldenError::Frame { interpolant, expected, found: crc }));
    }
}
