//! Frames that are prepared while the board is busy, with what must come back.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, sync_channel};
use std::thread::Scope;

use halfrow_model::{CorrectError, Frame, FrameError, Geometry};

use crate::board::NumberedFrame;
use crate::frames::Builtin;
use crate::reference::correct;
use crate::result::{little_endian, sha256};
use crate::run::findings::levels::Levels;
use crate::run::plan::{FrameSource, Plan, ScheduledFrame, Segment};
use crate::run::threads::{self, NoThread};
use crate::tables::Generation;

/// A frame that is ready to be sent, with the frame that must come back.
pub(crate) struct Prepared {
    pub(crate) name: String,
    /// Whether it is the built-in street, whose façades the report measures.
    pub(crate) is_street: bool,
    pub(crate) number: u16,
    pub(crate) generation: u8,
    /// SHA-256 of the input's samples, 16 bits little endian, in hexadecimal.
    pub(crate) sha256: String,
    pub(crate) input: Arc<Frame>,
    pub(crate) expected: Arc<Frame>,
    /// What `expected` shows of the optical centre, beyond what earlier frames do.
    pub(crate) centre: Levels,
}

/// A frame that could not be made ready.
#[derive(Debug, thiserror::Error)]
pub(crate) enum PrepareError {
    /// The frame cannot be made in the size and depth of the plan.
    #[error("the frame {name} cannot be made; leave it out")]
    Render { name: String, source: FrameError },
    /// The reference cannot correct the frame with the plan's tables.
    #[error("the reference cannot correct the frame {name}; use a frame of the tables' size and depth")]
    Correct { name: String, source: CorrectError },
}

/// The frames of `schedule` in order, prepared on a thread of `scope` while earlier ones are under way. The thread ends
/// when the receiver is dropped.
///
/// # Errors
/// [`NoThread`] when the system gives none.
pub(crate) fn ahead<'scope, 'run: 'scope>(
    scope: &'scope Scope<'scope, '_>,
    plan: &'run Plan,
    schedule: &'run [Segment],
    generations: Vec<Generation>,
) -> Result<Receiver<Result<Prepared, PrepareError>>, NoThread> {
    let (sender, receiver) = sync_channel(1);
    let span = tracing::Span::current();
    threads::spawn(scope, move || {
        let _entered = span.entered();
        let of_segment = |segment: &'run Segment| segment.frames.iter().map(move |frame| (frame, segment));
        let mut frames = schedule.iter().flat_map(of_segment);
        let mut shown = Levels::default();
        // After a frame that cannot be made no other is sent.
        let _ = frames.try_for_each(|(frame, segment)| {
            let prepared = Prepared::new(plan, frame, &segment.geometry, &generations, shown);
            shown = prepared.as_ref().map_or(shown, |prepared| shown.and(prepared.centre));
            let is_last = prepared.is_err();
            sender.send(prepared).ok().filter(|()| !is_last)
        });
    })?;
    Ok(receiver)
}

impl Prepared {
    fn new(
        plan: &Plan,
        frame: &ScheduledFrame,
        geometry: &Geometry,
        generations: &[Generation],
        shown: Levels,
    ) -> Result<Self, PrepareError> {
        let name = frame.source.name();
        let own = generations.iter().find(|generation| generation.number == frame.generation);
        let own = own.and_then(|generation| generation.upper(geometry.height()));
        let (tables, kernel) =
            own.as_ref().map_or((&plan.tables, &plan.kernel), |found| (&found.tables, &found.kernel));
        let input = plan
            .render(frame, geometry)
            .map_err(|source| PrepareError::Render { name: name.clone(), source })?;
        let expected = correct(tables, kernel, &input)
            .map_err(|source| PrepareError::Correct { name: name.clone(), source })?;
        Ok(Self {
            name,
            is_street: matches!(frame.source, FrameSource::Builtin(Builtin::Street)),
            number: frame.number,
            generation: frame.generation,
            sha256: sha256(input.rows().map(little_endian)),
            centre: Levels::of_centre(tables, kernel, &input, &expected, shown),
            input,
            expected: expected.into(),
        })
    }

    pub(crate) fn numbered(&self) -> NumberedFrame {
        NumberedFrame { number: self.number, frame: Arc::clone(&self.input) }
    }
}
