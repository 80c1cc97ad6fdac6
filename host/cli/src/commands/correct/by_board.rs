//! Frames corrected by a board, not judged.

use std::cell::RefCell;
use std::collections::VecDeque;
use std::num::NonZeroU8;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::Duration;
use std::{panic, thread};

use anyhow::Context as _;
use halfrow_model::Frame;

use super::places::Places;
use super::{Context, Failure, FrameName, Job, Look};
use halfrow::board::{Board, Stop};
use halfrow::correction::Correction;
use halfrow::frames::{self, Decoded};
use halfrow::progress::Progress;
use halfrow::run;

/// How often to look whether to stop while an input is awaited.
const LOOK: Duration = Duration::from_millis(10);

impl Job<'_> {
    /// Corrects all frames. The first failure ends the rest; frames written by then stay.
    pub(super) fn by_board(
        &self,
        places: &Places,
        context: &Context,
        progress: &dyn Progress,
    ) -> Result<(), Failure> {
        let candidate = self.arguments.board.candidate(&context.settings)?;
        let options = self.arguments.board.open_options(&context.settings)?;
        Board::with(candidate.link, &options, |board| {
            // `Correction::run` asks this as well, but only once the folders are made.
            run::check_fit(&self.chosen.tables, &self.chosen.kernel, board.capabilities())?;
            self.kind.get_or_init(|| candidate.kind.confirmed_by(board.capabilities().nature));
            self.stream(board, places, &options.stop, progress)
        })?
    }

    fn stream(
        &self,
        board: &mut Board,
        places: &Places,
        stop: &Stop,
        progress: &dyn Progress,
    ) -> Result<(), Failure> {
        places.make_folders().map_err(Failure::error)?;
        let correction = Correction {
            tables: &self.chosen.tables,
            kernel: &self.chosen.kernel,
            generation: NonZeroU8::MIN,
            first_frame: 0,
        };
        let (mut unread, mut unwritten) = (None, None);
        // Of the frames on their way through the board.
        let looks = RefCell::new(VecDeque::new());
        let inputs =
            self.inputs.iter().enumerate().map_while(|(index, input)| match self.read(input, stop) {
                Ok(Decoded { frame, fitting, camera, is_coded }) => {
                    self.note_unchecked(index, fitting);
                    looks.borrow_mut().push_back(Look { camera, is_coded });
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
            let written = self.write(places, indices.next().unwrap_or_default(), &look, samples);
            unwritten = written.err();
            if unwritten.is_none() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        };
        let streamed = correction.run(board, inputs, take, progress);
        match (unwritten, unread) {
            (Some(error), _) => Err(error),
            (None, Some(error)) => Err(error),
            (None, None) => Ok(streamed.map(drop)?),
        }
    }

    /// The frame of `input`. Opening or reading a pipe may take for ever, while the board is held: `stop` ends that too.
    fn read(&self, input: &FrameName, stop: &Stop) -> Result<Decoded, Failure> {
        if input.file().is_none() || input.can_be_read_twice() {
            return input.frame(&self.how, &self.scene).map_err(Failure::call);
        }
        let (awaited, how, scene) = (input.clone(), self.how, self.scene);
        let reader = thread::Builder::new().name("input".to_owned());
        let reader = reader.spawn(move || awaited.frame(&how, &scene));
        let reader =
            reader.context("no thread can be started; end other programs").map_err(Failure::error)?;
        while !reader.is_finished() {
            stop.check_wall()?;
            thread::sleep(LOOK);
        }
        reader.join().unwrap_or_else(|panicked| panic::resume_unwind(panicked)).map_err(Failure::call)
    }

    fn write(&self, places: &Places, index: usize, look: &Look, samples: Vec<u16>) -> Result<(), Failure> {
        let width = self.scene.geometry.width();
        let frame = Frame::new(width, self.how.depth, self.how.phase, samples)
            .context("the board's samples are no frame; judge it with `halfrow verify`")
            .map_err(Failure::error)?;
        frames::write_taken(&places.frames[index], &frame, &look.camera, self.arguments.overwrite)
            .map_err(Failure::error)?;
        self.note_written(&places.frames[index]);
        self.write_preview(places, index, look, &frame).map_err(Failure::error)
    }
}
