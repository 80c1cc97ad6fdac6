//! The judge is judged first: values from a program outside this project, through the very path that judges boards.

use halfrow_model::{BitDepth, Equidistant, Frame, Geometry, Interpolant, Kernel, Phase, TableSet};

use crate::compare::Comparison;
use crate::reference::correct;

/// A corrected row that another program computed: W = 64, H = 1, B = 12, C = 63.
struct GoldenRow {
    interpolant: Interpolant,
    corrected: [u16; 64],
}

/// Its row factor.
const STEP: u32 = 14_648_488;

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

/// The sample at `place`, counted row after row, of the frame that the other program corrected.
fn sample(place: usize) -> u16 {
    ((place as u32).wrapping_mul(2_654_435_761) >> 20) as u16
}

fn frame(width: usize, height: usize) -> Option<Frame> {
    let samples = (0..width * height).map(sample).collect();
    Frame::new(width, BitDepth::Twelve, Phase::Grbg, samples).ok()
}

/// Corrects what the other program corrected and compares as boards are compared. Returns the number of samples judged,
/// or what is wrong with this computer or this build.
///
/// # Errors
/// A sentence that says which golden value was missed.
pub(crate) fn judge_the_judge() -> Result<usize, String> {
    let mut samples = 0;
    for golden in &ROWS {
        samples += judge_row(golden)?;
    }
    let tables = Equidistant::from_radius(RADIUS)
        .ok()
        .and_then(|lens| TableSet::from_lens(Geometry::default(), &lens, None).ok());
    let (frame, tables) = frame(1920, 1080).zip(tables).ok_or("the golden frame cannot be made")?;
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
) -> Result<usize, String> {
    let corrected = correct(tables, &Kernel::from(interpolant), frame).map_err(|error| error.to_string())?;
    let bytes: Vec<u8> = corrected.samples().iter().flat_map(|sample| sample.to_le_bytes()).collect();
    match crc32fast::hash(&bytes) {
        crc if crc == expected => Ok(corrected.samples().len()),
        crc => Err(format!(
            "the golden frame's CRC-32 with {interpolant} is {expected:08x}, and this computer finds {crc:08x}"
        )),
    }
}

fn judge_row(golden: &GoldenRow) -> Result<usize, String> {
    let name = golden.interpolant.name();
    let found = Geometry::new(64, 1, BitDepth::Twelve, 63)
        .ok()
        .and_then(|geometry| TableSet::new(geometry, vec![STEP]).ok())
        .zip(frame(64, 1))
        .and_then(|(tables, frame)| correct(&tables, &Kernel::from(golden.interpolant), &frame).ok())
        .ok_or("the golden row cannot be made")?;
    let mut comparison = Comparison::new(64, 1);
    comparison.row(0, &golden.corrected, found.samples());
    if let Some(first) = comparison.first {
        return Err(format!(
            "the golden {name} row has {} at column {}, and this computer finds {}",
            first.expected, first.column, first.found
        ));
    }
    let mut spoilt = golden.corrected;
    spoilt[40] ^= 1;
    let mut comparison = Comparison::new(64, 1);
    comparison.row(0, &spoilt, found.samples());
    match comparison.differences {
        1 => Ok(golden.corrected.len()),
        _ => Err(format!("a single wrong bit in the golden {name} row went unseen")),
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
        let error = judge_row(&GoldenRow { interpolant: Interpolant::Hermite, corrected }).unwrap_err();
        assert!(error.contains("has 2601 at column 5") && error.contains("finds 2600"), "{error}");
    }
}
