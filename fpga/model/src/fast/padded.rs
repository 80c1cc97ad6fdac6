//! A row with its edges drawn out, so that no tap is a special case, and its outputs, so that no block is.

use super::BLOCK;

/// Samples in front of a padded row. Its taps begin three columns left of the row.
pub(super) const LEFT: usize = 4;

/// Samples behind a padded row, of which those up to column W + 3 count.
const RIGHT: usize = WINDOW;

/// Samples that the taps of a block are among, with some to spare for reading eight at a time.
pub(super) const WINDOW: usize = BLOCK + 16;

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

    /// [`WINDOW`] samples from the padded row's sample `first` on; a grid that is not legal may ask for ones that are not
    /// there, and gets others.
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

/// A row's outputs, of which a path takes a block at a time. The last block may go on behind the row.
pub(super) struct Outputs<'a> {
    row: &'a mut [u16],
    /// The last block, where the row does not hold all of it.
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

    /// Puts what the row holds of its last block in its place.
    pub(super) fn finish(self) {
        let whole = self.row.len() / BLOCK * BLOCK;
        let rest = &mut self.row[whole..];
        rest.copy_from_slice(&self.last[..rest.len()]);
    }
}
