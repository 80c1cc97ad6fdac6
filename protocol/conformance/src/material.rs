//! The input of the tests, made from the paper's formulas and the specification's sample formula.

use halfrow_protocol::message::{NODE_WEIGHTS, NODES, Shape};

/// The table entry of a row that is not stretched, 1.0.
pub const UNSTRETCHED: u32 = 1 << 24;

/// The table entry that the golden rows were made with.
pub const GOLDEN_FACTOR: u32 = 14_648_488;

/// A kernel's nodes: the weights g0, r1, g4, r5 and g6 of each, in units of 2^-14.
pub type Nodes = [[i16; NODE_WEIGHTS]; NODES];

/// Hermite's five stored weights (Eq. 18).
#[must_use]
pub fn hermite() -> Nodes {
    sampled(|x| {
        let (x2, x3) = (x * x, x * x * x);
        [0.0, -x3 / 8.0 + x2 / 2.0 - x / 2.0, -x3 / 4.0 + 3.0 * x2 / 4.0, x3 / 8.0 - x2 / 4.0, 0.0]
    })
}

/// Keys' five stored weights (Eq. 12).
#[must_use]
pub fn keys() -> Nodes {
    sampled(|x| {
        let (x2, x3) = (x * x, x * x * x);
        let own_right = -3.0 * x3 / 16.0 + x2 / 2.0 + x / 4.0;
        [-x3 / 16.0 + x2 / 4.0 - x / 4.0, 0.0, own_right, 0.0, x3 / 16.0 - x2 / 8.0]
    })
}

fn sampled(weights: impl Fn(f64) -> [f64; NODE_WEIGHTS]) -> Nodes {
    std::array::from_fn(|node| {
        weights(node as f64 / 32.0).map(|weight| (weight * 16384.0 + 0.5).floor() as i16)
    })
}

/// The specification's samples for one row of a frame `width` columns wide.
#[must_use]
pub fn noise_row(row: u32, width: u16) -> Vec<u16> {
    let width = u32::from(width);
    (0..width).map(|column| ((row * width + column).wrapping_mul(2_654_435_761) >> 20) as u16).collect()
}

/// Table entries of a frame whose circle has the radius `radius` (Eq. 9), with the centre row in the middle.
#[must_use]
pub fn factors(height: u16, radius: f64) -> Vec<u32> {
    let middle = f64::from(height - 1) / 2.0;
    let entry = |row| {
        let y = f64::from(row) - middle;
        (f64::from(UNSTRETCHED) * (radius * radius - y * y).sqrt() / radius + 0.5).floor() as u32
    };
    (0..height).map(entry).collect()
}

/// N and Z: segments of a row, and grid rows of a frame.
#[must_use]
pub(crate) fn grid_size(shape: Shape, width: u16, height: u16) -> (usize, usize) {
    let (columns, rows) = (1 << shape.k, 1 << shape.v);
    (usize::from(width).div_ceil(columns), (usize::from(height) - 1) / rows + 3)
}

/// A legal grid that bends every row, drawn from a seed: offsets of 1.0, and factors from 0.875 to 0.9375.
#[must_use]
pub fn drawn_grid(shape: Shape, width: u16, height: u16, seed: u32) -> Vec<u32> {
    let (segments, grid_rows) = grid_size(shape, width, height);
    let factors = grid_rows as u32..((segments + 2) * grid_rows) as u32;
    let factor = |entry: u32| 14_680_064 + ((entry + seed).wrapping_mul(2_654_435_761) >> 12);
    std::iter::repeat_n(UNSTRETCHED, grid_rows).chain(factors.map(factor)).collect()
}

/// CRC-32 of samples as 16-bit little-endian words.
#[must_use]
pub fn crc_of_words(words: impl IntoIterator<Item = u16>) -> u32 {
    let bytes: Vec<u8> = words.into_iter().flat_map(u16::to_le_bytes).collect();
    crc32fast::hash(&bytes)
}
