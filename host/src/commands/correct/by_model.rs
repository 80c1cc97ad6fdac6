//! Frames corrected by the reference model, row by row, as many at a time as there are processors.

use std::iter;
use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread::{self, available_parallelism};

use halfrow_model::{Corrector, Frame};

use super::places::Places;
use super::{Failure, Job};
use crate::frames::{self, FrameShape, WriteError};
use crate::progress::Progress;
use crate::reference;

impl Job<'_> {
    /// Corrects all frames. One that fails ends the rest; those that are written by then stay.
    pub(super) fn by_model(&self, places: &Places, progress: &dyn Progress) -> Result<(), Failure> {
        places.make_folders().map_err(Failure::error)?;
        let (next, failed) = (AtomicUsize::new(0), AtomicBool::new(false));
        let work = || {
            let mut corrector = reference::corrector(&self.chosen.kernel);
            while !failed.load(Ordering::Relaxed) {
                let index = next.fetch_add(1, Ordering::Relaxed);
                if index >= self.inputs.len() {
                    break;
                }
                self.correct_one(places, index, &mut corrector)
                    .inspect_err(|_| failed.store(true, Ordering::Relaxed))?;
                progress.rows(self.scene.geometry.height() as u64);
            }
            Ok(())
        };
        let workers = available_parallelism().map_or(1, usize::from).min(self.inputs.len());
        thread::scope(|scope| {
            let others: Vec<_> = (1..workers).map(|_| scope.spawn(work)).collect();
            let mine = work();
            let joined =
                others.into_iter().map(|other| other.join().unwrap_or_else(|panic| resume_unwind(panic)));
            iter::once(mine).chain(joined).collect()
        })
    }

    fn correct_one(&self, places: &Places, index: usize, corrector: &mut Corrector) -> Result<(), Failure> {
        let geometry = self.chosen.tables.geometry();
        let mut rows = self.inputs[index].rows(&self.how, &self.scene)?;
        let mut entering = vec![0; geometry.width()];
        let mut steps = self.chosen.tables.steps().iter();
        let mut kept = Vec::new();
        let shape = FrameShape {
            width: geometry.width(),
            height: geometry.height(),
            depth: geometry.depth(),
            phase: self.how.phase,
        };
        let correct_next = |leaving: &mut [u16]| -> anyhow::Result<()> {
            rows.next_row(&mut entering)?;
            if let Some(&step) = steps.next() {
                corrector.correct_row(geometry, step, &entering, leaving);
            }
            if !places.previews.is_empty() {
                kept.extend_from_slice(leaving);
            }
            Ok(())
        };
        let written =
            frames::write_rows(&places.frames[index], &shape, self.arguments.overwrite, correct_next);
        written.map_err(unwritten)?;
        if !kept.is_empty() {
            let corrected = Frame::new(shape.width, shape.depth, shape.phase, kept)?;
            self.write_preview(places, index, &corrected).map_err(Failure::error)?;
        }
        Ok(())
    }
}

/// What is wrong with an input is the caller's to mend, unlike an output that cannot be written.
fn unwritten(error: anyhow::Error) -> Failure {
    if error.is::<WriteError>() { Failure::error(error) } else { error.into() }
}
