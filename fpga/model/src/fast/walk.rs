//! Where the outputs of a row come from, a block of columns at a time, and the row with its edges drawn out.
#![cfg_attr(not(target_arch = "x86_64"), allow(dead_code, reason = "vectors need more than plain Rust does"))]

use super::BLOCK;
use crate::{Geometry, RowFactor, Source, source};

/// Samples in front of a padded row. Its taps begin three columns left of the row.
pub(super) const LEFT: usize = 4;

/// Samples behind a padded row, of which those up to column W + 3 count.
const RIGHT: usize = WINDOW;

/// Samples that the taps of a block are among, with some to spare for reading eight at a time.
pub(super) const WINDOW: usize = BLOCK + 16;

/// The source coordinates of a row, S + 2^11, which is rounded to 2^-13 column by dropping twelve bits.
#[derive(Clone, Copy)]
pub(super) struct Walk {
    origin: u64,
    /// 2Q, from one output to the next: at most one column, 2^25.
    pub(super) stride: u32,
}

/// Where a block of columns that starts at an even one finds its samples.
///
/// n moves by 0 or 1 a column. So does the last column with the output's colour at or left of it, but for a first move
/// back: from the lesser of the first two outputs' bases on, a block of N columns has its bases within N samples.
#[derive(Clone, Copy)]
pub(super) struct Start {
    /// The padded row's sample of tap G0 for base column `least`, the least base of the block.
    pub(super) first: usize,
    /// S + 2^11 of the first column less 2^26 · `even`, where `even` is the even column at or left of n: 26 bits.
    pub(super) relative: u32,
    /// `even` − `least`, 0 or 1.
    pub(super) lead: bool,
}

/// What is added to ((n + column) & !1), with both counted from even columns, for a − `least`: [`Start::lead`] less the
/// column's parity.
pub(super) const LEADS: [[u16; BLOCK]; 2] = {
    let mut leads = [[0; BLOCK]; 2];
    let mut column = 0;
    while column < BLOCK {
        leads[0][column] = (column as u16 % 2).wrapping_neg();
        leads[1][column] = 1 - column as u16 % 2;
        column += 1;
    }
    leads
};

impl Walk {
    pub(super) fn new(geometry: &Geometry, row_factor: RowFactor) -> Self {
        let start = u64::from(geometry.centre2()) * u64::from(RowFactor::ONE.get() - row_factor.get());
        Self { origin: start + (1 << 11), stride: 2 * row_factor.get() }
    }

    /// S + 2^11 of `column`.
    pub(super) fn coordinate(&self, column: usize) -> u64 {
        self.origin + column as u64 * u64::from(self.stride)
    }

    /// The padded row's sample of tap G0 for base column `base`.
    pub(super) fn first_tap(base: usize) -> usize {
        LEFT + base - 2
    }

    /// The block that starts at `column`, which is even.
    #[inline]
    pub(super) fn start(&self, column: usize) -> Start {
        let coordinate = self.coordinate(column);
        let relative = (coordinate & ((1 << 26) - 1)) as u32;
        let lead = relative + self.stride < 1 << 25;
        let even = (coordinate >> 26) as usize * 2;
        Start { first: Self::first_tap(even) - usize::from(lead), relative, lead }
    }
}

/// The starts of the blocks of `block` columns that cover a row. The last one is moved left to end with the row.
pub(super) fn blocks(width: usize, block: usize) -> impl Iterator<Item = usize> {
    (0..width).step_by(block).map(move |column| column.min(width - block))
}

/// A row's two ends with the nearest samples of the same colour beyond them (DATAPATH.md, "Taps").
#[derive(Default)]
pub(super) struct Ends {
    /// As long as the row with both its margins. What is further than a window from an end is not kept up.
    padded: Vec<u16>,
}

impl Ends {
    /// Takes the ends of `row`.
    pub(super) fn take(&mut self, row: &[u16]) {
        self.padded.resize(LEFT + row.len() + RIGHT, 0);
        let (front, rest) = self.padded.split_at_mut(LEFT);
        let (middle, back) = rest.split_at_mut(row.len());
        let last = row.len() - WINDOW;
        middle[..WINDOW].copy_from_slice(&row[..WINDOW]);
        middle[last..].copy_from_slice(&row[last..]);
        for (ends, pair) in [(front, &row[..2]), (back, &row[row.len() - 2..])] {
            ends.chunks_exact_mut(2).for_each(|end| end.copy_from_slice(pair));
        }
    }
}

/// A row whose taps may lie beyond its ends.
#[derive(Clone, Copy)]
pub(super) struct Padded<'a> {
    row: &'a [u16],
    ends: &'a Ends,
}

impl<'a> Padded<'a> {
    /// `row`, which `ends` has taken.
    pub(super) fn new(row: &'a [u16], ends: &'a Ends) -> Self {
        Self { row, ends }
    }

    /// [`WINDOW`] samples from the padded row's sample `first` on.
    #[inline]
    pub(super) fn window(&self, first: usize) -> &'a [u16] {
        let inside = first.wrapping_sub(LEFT);
        if inside <= self.row.len() - WINDOW {
            &self.row[inside..inside + WINDOW]
        } else {
            &self.ends.padded[first..first + WINDOW]
        }
    }
}

/// The sources of a block as a path found them.
pub(super) struct Located {
    /// As in [`Start`].
    pub(super) first: usize,
    /// a of each column, from the block's least one.
    pub(super) base: [u16; BLOCK],
    /// x of each column, the lower 14 bits.
    pub(super) x: [u16; BLOCK],
}

impl Located {
    /// The oracle's, with the least base two columns left of the row.
    pub(super) fn by_oracle(geometry: &Geometry, row_factor: RowFactor, column: usize) -> Self {
        let sources: [Source; BLOCK] =
            std::array::from_fn(|index| source(geometry, row_factor, column + index));
        Self {
            first: LEFT - 4,
            base: sources.map(|source| (source.base + 2) as u16),
            x: sources.map(|source| (source.node << 8) as u16 | source.fraction as u16),
        }
    }

    /// a of each column, −1 to W − 1, and x.
    pub(super) fn write(&self, bases: &mut [i16], distances: &mut [u16]) {
        let least = self.first as i16 + 2 - LEFT as i16;
        bases.iter_mut().zip(self.base).for_each(|(place, base)| *place = least + base as i16);
        distances.iter_mut().zip(self.x).for_each(|(place, x)| *place = x & 0x3fff);
    }
}
