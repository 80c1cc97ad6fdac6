//! A frame, two rows at a time.

use super::engine::Engine;
use super::walk::Ends;
use crate::{Frame, TableSet};

/// Some rows of a frame's upper half, and those of its lower half that mirror them.
///
/// Where the lens's axis is in the middle of the frame, a row and its mirror image have the same step.
pub(super) struct Strip<'a> {
    pub(super) engine: &'a Engine,
    pub(super) tables: &'a TableSet,
    pub(super) frame: &'a Frame,
    /// The first row.
    first: usize,
    /// The outputs of the upper rows, downwards from the first.
    upper: &'a mut [u16],
    /// The outputs of the lower rows, upwards from the first one's mirror image. The middle row of an odd number has none.
    lower: &'a mut [u16],
}

impl<'a> Strip<'a> {
    /// The whole frame, to be corrected into `samples`, which must be of the frame's size.
    pub(super) fn new(
        engine: &'a Engine,
        tables: &'a TableSet,
        frame: &'a Frame,
        samples: &'a mut [u16],
    ) -> Self {
        let (upper, lower) = samples.split_at_mut(frame.height().div_ceil(2) * frame.width());
        Self { engine, tables, frame, first: 0, upper, lower }
    }

    /// The first `pairs` pairs of rows, or all that there are, and the rest.
    pub(super) fn split(self, pairs: usize) -> (Self, Self) {
        let samples = pairs * self.frame.width();
        let (upper, upper_rest) = self.upper.split_at_mut(samples.min(self.upper.len()));
        let (lower_rest, lower) = self.lower.split_at_mut(self.lower.len().saturating_sub(samples));
        let Self { engine, tables, frame, first, .. } = self;
        let rest = Self { engine, tables, frame, first: first + pairs, upper: upper_rest, lower: lower_rest };
        (Self { engine, tables, frame, first, upper, lower }, rest)
    }

    /// Corrects all its rows.
    pub(super) fn correct(self, ends: &mut [Ends; 2]) {
        let (geometry, width) = (self.tables.geometry(), self.frame.width());
        let mut lower = self.lower.rchunks_exact_mut(width);
        for (row, output) in (self.first..).zip(self.upper.chunks_exact_mut(width)) {
            let mirrored = geometry.height() - 1 - row;
            let [step, mirrored_step] = [row, mirrored].map(|row| self.tables.steps()[row]);
            let inputs = [row, mirrored].map(|row| self.frame.row(row));
            match lower.next() {
                None => self.engine.correct_rows(ends, geometry, step, [inputs[0]], [output]),
                Some(below) if step == mirrored_step => {
                    self.engine.correct_rows(ends, geometry, step, inputs, [output, below]);
                }
                Some(below) => {
                    self.engine.correct_rows(ends, geometry, step, [inputs[0]], [output]);
                    self.engine.correct_rows(ends, geometry, mirrored_step, [inputs[1]], [below]);
                }
            }
        }
    }
}
