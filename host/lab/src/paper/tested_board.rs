//! A board on which the paper's claims are tried.

use std::num::NonZeroU8;
use std::ops::{ControlFlow, RangeInclusive};
use std::sync::Arc;

use halfrow_model::{Frame, Kernel, TableSet};

use super::PaperError;
use halfrow::board::Board;
use halfrow::correction::Correction;
use halfrow::progress::Progress;
use halfrow::run::check_fit;
use halfrow::target::BoardKind;

/// An open session, with counts of what it has streamed.
#[derive(Debug)]
pub struct TestedBoard {
    board: Board,
    kind: BoardKind,
    frames: u16,
    generation: u8,
}

/// The frames that came back.
#[derive(Clone, Debug)]
pub(crate) struct Corrected {
    /// The samples of each frame, row after row, in the order of the inputs. Those of a broken board can exceed the depth.
    pub(crate) samples: Vec<Vec<u16>>,
    /// The least and the most pixel clocks that a row's first and last samples took.
    pub(crate) latency: RangeInclusive<u16>,
}

impl TestedBoard {
    /// Takes over an open session. The target of its link promises a board of this kind.
    #[must_use]
    pub fn new(board: Board, kind: BoardKind) -> Self {
        let kind = kind.confirmed_by(board.capabilities().nature);
        Self { board, kind, frames: 0, generation: 0 }
    }

    /// The board's name, for people.
    #[must_use]
    pub fn name(&self) -> String {
        match self.kind {
            BoardKind::Hardware => "board (hardware)".to_owned(),
            kind => format!("{kind} board (no hardware was tested)"),
        }
    }

    /// L: the pixel clocks that the board says it adds to half a row.
    #[must_use]
    pub(crate) fn advertised_latency(&self) -> u16 {
        self.board.capabilities().latency.into()
    }

    /// Checks that the board takes frames of this size and this kernel.
    ///
    /// # Errors
    /// [`PaperError::Misfit`] when it does not.
    pub(crate) fn fits(&self, tables: &TableSet, kernel: &Kernel) -> Result<(), PaperError> {
        Ok(check_fit(tables, kernel, self.board.capabilities())?)
    }

    /// Corrects `inputs` with these tables and this kernel, under another generation than the last.
    ///
    /// # Errors
    /// [`PaperError::Misfit`] when the board cannot take them, [`PaperError::Correct`] for an input that they are not for,
    /// [`PaperError::Board`] when it refuses or does not answer.
    pub(crate) fn correct(
        &mut self,
        tables: &TableSet,
        kernel: &Kernel,
        inputs: &[Arc<Frame>],
        progress: &dyn Progress,
    ) -> Result<Corrected, PaperError> {
        let generation = next(self.generation);
        self.generation = generation.get();
        let correction = Correction { tables, kernel, generation, first_frame: self.frames };
        let mut samples = Vec::with_capacity(inputs.len());
        let take = |frame| {
            samples.push(frame);
            ControlFlow::Continue(())
        };
        let latency = correction.run(&mut self.board, inputs.iter().cloned(), take, progress)?;
        self.frames = self.frames.wrapping_add(inputs.len() as u16);
        Ok(Corrected { samples, latency })
    }

    /// Ends the session, so that the next host finds the board free.
    pub fn close(&mut self) {
        self.board.close();
    }
}

/// The generation after `last`, which is 0 if there was none.
fn next(last: u8) -> NonZeroU8 {
    NonZeroU8::new(last.wrapping_add(1)).unwrap_or(NonZeroU8::MIN)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tables that stayed behind are told from new ones by their generation.
    #[test]
    fn no_generation_follows_itself() {
        assert_eq!([0, 1, 254, 255].map(|last| next(last).get()), [1, 2, 255, 1]);
    }
}
