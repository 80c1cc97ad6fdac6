//! A row with its edges extended, so that no tap is a special case, and its outputs, so that no block is.

use super::BLOCK;

/// Samples to the left of a padded row. The leftmost tap can be three columns left of the row.
pub(super) const LEFT: usize = 4;

/// Samples to the right of a padded row; only those up to column W + 3 count.
const RIGHT: usize = WINDOW;

/// Samples among which the taps of a block lie, with some to spare for reading eight at a time.
pub(super) const WINDOW: usize = BLOCK + 16;

/// A row's two ends and, beyond them, the nearest samples of the same colour (DATAPATH.md, "Taps").
#[derive(Default)]
pub(super) struct Ends {
    /// As long as the row with both its margins. Only what lies within a window of either end is kept up to date.
    padded: Vec<u16>,
}

impl Ends {
    /// Copies the ends of `row`.
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

    /// [`WINDOW`] samples, starting with sample `first` of the padded row. A grid that is not legal may ask for samples that do
    /// not exist, and gets others.
    #[inline]
    pub(super) fn window(&self, first: isize) -> &'a [u16] {
        let inside = first.wrapping_sub_unsigned(LEFT).cast_unsigned();
        if inside <= self.row.len() - WINDOW {
            &self.row[inside..inside + WINDOW]
        } else {
            let first = first.max(0).cast_unsigned().min(self.ends.padded.len() - WINDOW);
            &self.ends.padded[first..first + WINDOW]
        }
    }
}

/// A row's outputs, which a path takes block by block. The last block may extend beyond the row.
pub(super) struct Outputs<'a> {
    row: &'a mut [u16],
    /// The last block, if the row holds only part of it.
    last: [u16; BLOCK],
}

impl<'a> Outputs<'a> {
    pub(super) fn new(row: &'a mut [u16]) -> Self {
        Self { row, last: [0; BLOCK] }
    }

    /// The block that starts at `column`.
    #[inline]
    pub(super) fn block(&mut self, column: usize) -> &mut [u16; BLOCK] {
        let rest = self.row.get_mut(column..).unwrap_or_default();
        rest.first_chunk_mut().unwrap_or(&mut self.last)
    }

    /// Copies the row's part of an incomplete last block into the row.
    pub(super) fn finish(self) {
        let whole = self.row.len() / BLOCK * BLOCK;
        let rest = &mut self.row[whole..];
        rest.copy_from_slice(&self.last[..rest.len()]);
    }
}
