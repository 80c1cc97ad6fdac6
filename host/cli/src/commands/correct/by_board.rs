//! Frames corrected by a board, not judged.

use std::cell::RefCell;
use std::collections::VecDeque;
use std::ops::ControlFlow;
use std::sync::Arc;

use anyhow::Context as _;
use halfrow_model::Frame;

use super::places::Places;
use super::{Context, Failure, Job, Look};
use halfrow::board::Board;
use halfrow::correction::Correction;
use halfrow::frames::{self, Decoded};
use halfrow::progress::Progress;
use halfrow::run::{self, JUDGED};
use halfrow::target::BoardKind;

impl Job<'_> {
    /// Corrects all frames, and returns the kind of board that did. The first failure ends the rest; frames written by then
    /// stay.
    pub(super) fn by_board(
        &self,
        places: &Places,
        context: &Context,
        progress: &dyn Progress,
    ) -> Result<BoardKind, Failure> {
        let candidate = self.arguments.board.candidate(&context.settings)?;
        let options = self.arguments.board.open_options(&context.settings)?;
        Board::with(candidate.link, &options, |board| {
            run::check_fit(&self.chosen.tables, &self.chosen.kernel, board.capabilities())?;
            self.stream(board, places, progress)?;
            Ok(candidate.kind.confirmed_by(board.capabilities().nature))
        })?
    }

    fn stream(&self, board: &mut Board, places: &Places, progress: &dyn Progress) -> Result<(), Failure> {
        places.make_folders().map_err(Failure::error)?;
        let correction = Correction {
            tables: &self.chosen.tables,
            kernel: &self.chosen.kernel,
            generation: JUDGED,
            first_frame: 0,
        };
        let (mut unread, mut unwritten) = (None, None);
        // Of the frames on their way through the board.
        let looks = RefCell::new(VecDeque::new());
        let inputs = self.inputs.iter().map_while(|input| match input.frame(&self.how, &self.scene) {
            Ok(Decoded { frame, fitting, orientation, is_coded }) => {
                self.tell_unchecked(input, fitting);
                looks.borrow_mut().push_back(Look { orientation, is_coded });
                Some(Arc::new(frame))
            }
            Err(error) => {
                unread = Some(error);
                None
            }
        });
        let mut indices = 0..;
        let take = |samples| {
            let look = looks.borrow_mut().pop_front().unwrap_or_default();
            let written = self.write(places, indices.next().unwrap_or_default(), look, samples);
            unwritten = written.err();
            if unwritten.is_none() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        };
        let streamed = correction.run(board, inputs, take, progress);
        match (unwritten, unread) {
            (Some(error), _) => Err(error),
            (None, Some(error)) => Err(Failure::call(error)),
            (None, None) => Ok(streamed.map(drop)?),
        }
    }

    fn write(&self, places: &Places, index: usize, look: Look, samples: Vec<u16>) -> Result<(), Failure> {
        let width = self.scene.geometry.width();
        let frame = Frame::new(width, self.how.depth, self.how.phase, samples)
            .context("the board's samples are no frame; judge it with `halfrow verify`")
            .map_err(Failure::error)?;
        frames::write_oriented(&places.frames[index], &frame, look.orientation, self.arguments.overwrite)
            .map_err(Failure::error)?;
        self.write_preview(places, index, look, &frame).map_err(Failure::error)
    }
}
