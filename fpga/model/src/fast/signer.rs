//! Frames of a burst made, corrected and signed, as a board does it.

use std::fmt;
use std::ops::Range;

use super::{Corrector, content};
use crate::content::{Content, frame_signature, row_signature};
use crate::{Frame, Geometry, Phase, TableSet};

/// Rows of a frame's upper half that go from their seed to their signatures together with those that mirror them: so few
/// that they stay in a processor's cache, and enough that there are many of each kind.
const BAND: usize = 32;

/// Predicts the signatures of a burst's frames (AT-SPEED.md) with one kernel by one [`Corrector`].
///
/// It may be used for any number of frames and geometries. Several threads take one each.
pub struct Signer {
    corrector: Corrector,
    /// A band's rows as they enter the core, those of the upper half first.
    inputs: Vec<u16>,
    /// The same rows as they leave it.
    outputs: Vec<u16>,
}

impl fmt::Debug for Signer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Signer").field("corrector", &self.corrector).finish_non_exhaustive()
    }
}

impl Signer {
    /// A signer of what `corrector` gives.
    #[must_use]
    pub fn new(corrector: Corrector) -> Self {
        Self { corrector, inputs: Vec::new(), outputs: Vec::new() }
    }

    /// The signature of every row of the frame of `content` behind `tables`, from the top, into `rows`, and that of the
    /// frame.
    pub fn sign(&mut self, tables: &TableSet, content: Content, rows: &mut Vec<u32>) -> u32 {
        let height = tables.geometry().height();
        rows.clear();
        rows.resize(height, 0);
        let half = height.div_ceil(2);
        for first in (0..half).step_by(BAND) {
            self.band(tables, content, first..half.min(first + BAND), rows);
        }
        frame_signature(rows)
    }

    /// Signs the rows `upper` and those that mirror them.
    fn band(&mut self, tables: &TableSet, content: Content, upper: Range<usize>, rows: &mut [u32]) {
        let (geometry, width) = (tables.geometry(), tables.geometry().width());
        let count = upper.len();
        let mirrored = upper.clone().map(|row| geometry.height() - 1 - row);
        for band in [&mut self.inputs, &mut self.outputs] {
            band.resize(2 * count * width, 0);
        }
        let numbers = upper.clone().chain(mirrored.clone());
        content::make(content, geometry.depth(), numbers.clone().zip(self.inputs.chunks_exact_mut(width)));
        let (above, below) = self.outputs.split_at_mut(count * width);
        let outputs = above.chunks_exact_mut(width).zip(below.chunks_exact_mut(width));
        let inputs = self.inputs.chunks_exact(width);
        let inputs = inputs.clone().zip(inputs.skip(count));
        for ((pair, inputs), outputs) in upper.zip(mirrored).zip(inputs).zip(outputs) {
            self.corrector.correct_pair(tables, pair.into(), inputs.into(), outputs.into());
        }
        for (row, output) in numbers.zip(self.outputs.chunks_exact(width)) {
            rows[row] = row_signature(output);
        }
    }
}

impl Content {
    /// The whole frame, as large as `geometry` says.
    #[must_use]
    pub fn frame(self, geometry: &Geometry, phase: Phase) -> Frame {
        let mut samples = vec![0; geometry.width() * geometry.height()];
        content::make(self, geometry.depth(), samples.chunks_exact_mut(geometry.width()).enumerate());
        Frame::of_geometry(geometry, phase, samples)
    }
}
