//! The content of a frame's rows, without a generator step for each sample.
//!
//! A step is linear over GF(2), and the states from which a frame's rows start differ only in the bits of the row's number. So,
//! column by column, the draws of one row are those of another XOR the draws from a state that holds the differing bits alone.
//! Those are the same for every seed and frame. One row of a frame is drawn step by step; the others follow from it.

use crate::BitDepth;
use crate::content::{Content, Kind, full, xorshift32};

/// Bits of a row's number.
const ROW_BITS: usize = 12;

/// Columns after which every toggle pattern repeats.
const PERIOD: usize = 16;

/// What turns the draws of one row into those of another.
#[derive(Default)]
pub(super) struct Changes {
    /// The draws from the states 2^1 − 1, 2^2 − 1, …: neighbouring rows differ in such bits, rows 3 and 4 in the lowest three.
    draws: [Vec<u16>; ROW_BITS],
}

impl Changes {
    /// These draws, for rows of up to `width` columns.
    pub(super) fn reaching(&mut self, width: usize) -> &Self {
        if self.draws[0].len() < width {
            self.draws = std::array::from_fn(|bit| drawn((2 << bit) - 1, width));
        }
        self
    }
}

/// Makes the rows of a frame in any order; fastest for rows that follow each other, up or down.
#[derive(Clone)]
pub(super) struct Maker<'a> {
    content: Content,
    depth: BitDepth,
    changes: &'a Changes,
    /// The row that was drawn last; rows of the kind *toggle* need no draws.
    row: usize,
    /// Its draws.
    draws: Vec<u16>,
}

impl<'a> Maker<'a> {
    /// For a frame of `width` columns, a width that `changes` reaches.
    pub(super) fn new(content: Content, depth: BitDepth, width: usize, changes: &'a Changes) -> Self {
        Self { content, depth, changes, row: 0, draws: drawn(content.state(0), width) }
    }

    /// The samples of row `row`, below 4096; `hold` is [`hold`] or an equivalent.
    pub(super) fn make(&mut self, row: usize, samples: &mut [u16], hold: impl Fn(&[u16], u16, &mut [u16])) {
        let (depth, max) = (self.depth, self.depth.max());
        let kind = self.content.start(row).kind;
        if !matches!(kind, Kind::Toggle { .. }) {
            self.go_to(row);
        }
        let drawn = samples.iter_mut().zip(&self.draws);
        match kind {
            Kind::Noise => drawn.for_each(|(sample, &draw)| *sample = level(draw, max)),
            Kind::Swing => drawn.for_each(|(sample, &draw)| *sample = full(draw >= 1 << 15, depth)),
            Kind::Toggle { p, high } => toggle(p, high, depth, samples),
            Kind::Steps => {
                samples[0] = level(self.draws[0], max);
                hold(&self.draws, max, samples);
            }
        }
    }

    /// Turns the draws into those of `row`.
    fn go_to(&mut self, row: usize) {
        let differing = row ^ self.row;
        // Bit k is (2^(k+1) − 1) XOR (2^k − 1). What occurs twice in the sum over all bits cancels.
        let mut changes = differing ^ differing >> 1;
        while changes != 0 {
            let change = &self.changes.draws[changes.trailing_zeros() as usize];
            self.draws.iter_mut().zip(change).for_each(|(draw, change)| *draw ^= change);
            changes &= changes - 1;
        }
        self.row = row;
    }
}

/// What counts of each of the `width` draws after d of a row that starts from `x`: the upper 12 bits, from which levels are
/// made, and below them the lowest 4, which tell where steps are.
fn drawn(x: u32, width: usize) -> Vec<u16> {
    let draws = std::iter::successors(Some(xorshift32(xorshift32(x))), |&x| Some(xorshift32(x)));
    draws.map(|x| ((x >> 20) * 16 + x % 16) as u16).take(width).collect()
}

/// The level of a draw.
fn level(draw: u16, max: u16) -> u16 {
    draw >> 4 & max
}

/// *Steps* after the first sample, which is already set: the level of a draw that has a step, else the sample to the left.
pub(super) fn hold(draws: &[u16], max: u16, samples: &mut [u16]) {
    let mut held = samples[0];
    for (sample, &draw) in samples.iter_mut().zip(draws).skip(1) {
        held = if draw.is_multiple_of(16) { level(draw, max) } else { held };
        *sample = held;
    }
}

fn toggle(p: u32, high: bool, depth: BitDepth, samples: &mut [u16]) {
    let period: [u16; PERIOD] =
        std::array::from_fn(|column| full((column >> p) % 2 != usize::from(high), depth));
    let (periods, rest) = samples.as_chunks_mut();
    periods.fill(period);
    rest.copy_from_slice(&period[..rest.len()]);
}
