//! The frames of a burst: made, corrected and signed as a board does it.

use std::fmt;
use std::sync::Arc;

use super::Corrector;
use super::content::{Changes, Maker, hold};
use crate::content::{Content, frame_signature, row_signature};
use crate::{Frame, Geometry, Phase, TableSet};

/// Predicts the signatures of a burst's frames (AT-SPEED.md), with the kernel of one [`Corrector`].
///
/// It can be used for any number of frames and geometries. Each thread takes its own.
pub struct Signer {
    corrector: Corrector,
    changes: Changes,
    /// Two rows that mirror each other, as they enter the core.
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
    /// A signer of the outputs of `corrector`.
    #[must_use]
    pub fn new(corrector: Corrector) -> Self {
        Self { corrector, changes: Changes::default(), inputs: Vec::new(), outputs: Vec::new() }
    }

    /// Predicts the frame of `content` corrected with `tables`: puts the signature of every row, from the top, into `rows` and
    /// returns the signature of the frame.
    pub fn sign(&mut self, tables: &TableSet, content: Content, rows: &mut Vec<u32>) -> u32 {
        let geometry = tables.geometry();
        let (width, height) = (geometry.width(), geometry.height());
        rows.clear();
        rows.resize(height, 0);
        for pair in [&mut self.inputs, &mut self.outputs] {
            pair.resize(2 * width, 0);
        }
        let inputs = self.inputs.split_at_mut(width);
        let outputs = self.outputs.split_at_mut(width);
        let changes = self.changes.reaching(width);
        let maker = Maker::new(content, geometry.depth(), width, changes);
        let mut makers = [maker.clone(), maker];
        let engine = Arc::clone(&self.corrector.engine);
        let hold = |draws: &[u16], max: u16, samples: &mut [u16]| engine.hold(draws, max, samples);
        // The middle row of an odd height, which mirrors itself, is made and corrected twice.
        for upper in 0..height.div_ceil(2) {
            let pair = [upper, height - 1 - upper];
            makers[0].make(pair[0], inputs.0, hold);
            makers[1].make(pair[1], inputs.1, hold);
            self.corrector.correct_pair(tables, pair, [inputs.0, inputs.1], [outputs.0, outputs.1]);
            rows[pair[0]] = row_signature(outputs.0);
            rows[pair[1]] = row_signature(outputs.1);
        }
        frame_signature(rows)
    }
}

impl Content {
    /// The whole frame, of the size and depth of `geometry`.
    #[must_use]
    pub fn frame(self, geometry: &Geometry, phase: Phase) -> Frame {
        let width = geometry.width();
        let mut changes = Changes::default();
        let mut maker = Maker::new(self, geometry.depth(), width, changes.reaching(width));
        let mut samples = vec![0; width * geometry.height()];
        for (row, samples) in samples.chunks_exact_mut(width).enumerate() {
            maker.make(row, samples, hold);
        }
        Frame::of_geometry(geometry, phase, samples)
    }
}
