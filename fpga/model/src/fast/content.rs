//! The content of many rows at once.
//!
//! A draw follows from the one in front of it, so a row cannot be made faster than that; but rows are independent. Those
//! of one kind are made side by side, the state of each in a lane of its own, which compilers make vectors of.

use crate::BitDepth;
use crate::content::{Content, Kind, full, xorshift32};

/// Rows that are made side by side.
const LANES: usize = 16;

/// Columns that are made before they are brought to their rows; even.
const TILE: usize = 32;

/// Two columns of all lanes, the left one in the lower half.
type Pair = [u32; LANES];

/// A row that is waiting for others of its kind.
struct Lane<'a> {
    x: u32,
    samples: &'a mut [u16],
}

/// Makes the rows of these numbers, each into the samples beside it.
pub(super) fn make<'a>(
    content: Content,
    depth: BitDepth,
    rows: impl Iterator<Item = (usize, &'a mut [u16])>,
) {
    let mut waiting: [Vec<Lane<'a>>; 3] = Default::default();
    for (row, samples) in rows {
        let start = content.start(row);
        let kind = match start.kind {
            Kind::Toggle { p, high } => {
                toggle(p, high, depth, samples);
                continue;
            }
            Kind::Noise => 0,
            Kind::Swing => 1,
            Kind::Steps => 2,
        };
        waiting[kind].push(Lane { x: start.x, samples });
    }
    let max = u32::from(depth.max());
    let [noise, swing, steps] = &mut waiting;
    for lanes in noise.chunks_mut(LANES) {
        fill(lanes, |x, _| x >> 20 & max);
    }
    for lanes in swing.chunks_mut(LANES) {
        fill(lanes, |x, _| if x >= 1 << 31 { max } else { 0 });
    }
    for lanes in steps.chunks_mut(LANES) {
        fill(lanes, |x, held| if x % 16 == 0 || held == NONE { x >> 20 & max } else { held });
    }
}

/// No sample, as in front of a row.
const NONE: u32 = u32::MAX;

fn toggle(p: u32, high: bool, depth: BitDepth, samples: &mut [u16]) {
    let group = 1 << p;
    for (index, columns) in samples.chunks_mut(group).enumerate() {
        columns.fill(full((index % 2 == 1) != high, depth));
    }
}

/// Makes at most [`LANES`] rows of one width by `sample`, which takes a draw and the sample to its left.
fn fill(lanes: &mut [Lane<'_>], sample: impl Fn(u32, u32) -> u32 + Copy) {
    let width = lanes.iter().map(|lane| lane.samples.len()).max().unwrap_or(0);
    let mut x: Pair = std::array::from_fn(|lane| lanes.get(lane).map_or(1, |lane| lane.x));
    let mut held = [NONE; LANES];
    for first in (0..width).step_by(TILE) {
        let mut tile = [[0; LANES]; TILE / 2];
        for pair in &mut tile {
            *pair = draw_pair(&mut x, &mut held, sample);
        }
        for (index, lane) in lanes.iter_mut().enumerate() {
            let end = width.min(first + TILE);
            let (pairs, _) = lane.samples[first..end].as_chunks_mut();
            for (samples, pair) in pairs.iter_mut().zip(&tile) {
                *samples = [pair[index] as u16, (pair[index] >> 16) as u16];
            }
        }
    }
}

/// The next two columns.
fn draw_pair(x: &mut Pair, held: &mut Pair, sample: impl Fn(u32, u32) -> u32) -> Pair {
    let mut pair = [0; LANES];
    for shift in [0, 16] {
        for lane in 0..LANES {
            x[lane] = xorshift32(x[lane]);
            held[lane] = sample(x[lane], held[lane]);
            pair[lane] |= held[lane] << shift;
        }
    }
    pair
}
