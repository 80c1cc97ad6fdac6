//! Frames corrected by the reference model, row by row, as many at a time as there are processors.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread::{self, available_parallelism};

use halfrow_model::{Frame, correct_row};

use super::places::Places;
use super::{Failure, Job};
use crate::frames::{self, FrameShape, WriteError};
use crate::progress::Progress;

impl Job<'_> {
    /// Corrects all frames. One that fails ends the rest; those that are written by then stay.
    pub(super) fn by_model(&self, places: &Places, progress: &dyn Progress) -> Result<(), Failure> {
        places.make_folders().map_err(Failure::error)?;
        let (next, failed) = (AtomicUsize::new(0), AtomicBool::new(false));
        let work = || {
            while !failed.load(Ordering::Relaxed) {
                let index = next.fetch_add(1, Ordering::Relaxed);
                if index >= self.inputs.len() {
                    break;
                }
                self.correct_one(places, index).inspect_err(|_| failed.store(true, Ordering::Relaxed))?;
                progress.rows(self.scene.geometry.height() as u64);
            }
            Ok(())
        };
        let workers = available_parallelism().map_or(1, usize::from).min(self.inputs.len());
        thread::scope(|scope| {
            let others: Vec<_> = (1..workers).map(|_| scope.spawn(work)).collect();
            let mine = work();
            let all = others.into_iter().map(|other| other.join().unwrap_or(Ok(())));
            std::iter::once(mine).chain(all).collect()
        })
    }

    fn correct_one(&self, places: &Places, index: usize) -> Result<(), Failure> {
        let (geometry, kernel) = (self.chosen.tables.geometry(), &self.chosen.kernel);
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
                correct_row(geometry, step, kernel, &entering, leaving);
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
