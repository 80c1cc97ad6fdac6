//! Frames corrected by the reference model, row by row, as many at a time as there are processors.

use halfrow_model::{Corrector, Frame};

use super::places::Places;
use super::{Failure, Job, Look};
use halfrow::frames::{self, FrameShape, WriteError, parallel};
use halfrow::progress::Progress;
use halfrow::reference;

impl Job<'_> {
    /// Corrects all frames. The first failure ends the rest; frames written by then stay.
    pub(super) fn by_model(&self, places: &Places, progress: &dyn Progress) -> Result<(), Failure> {
        places.make_folders().map_err(Failure::error)?;
        let corrector = || reference::corrector(&self.chosen.kernel);
        parallel::try_each(self.inputs.len(), corrector, |corrector, index| {
            self.correct_one(places, index, corrector)?;
            progress.rows(self.scene.geometry.height() as u64);
            Ok(())
        })
    }

    fn correct_one(&self, places: &Places, index: usize, corrector: &mut Corrector) -> Result<(), Failure> {
        let geometry = self.chosen.tables.geometry();
        let input = &self.inputs[index];
        let mut rows = input.rows(&self.how, &self.scene).map_err(Failure::call)?;
        self.note_unchecked(index, rows.fitting());
        let look = Look { camera: rows.camera().clone(), is_coded: rows.is_coded() };
        let mut entering = vec![0; geometry.width()];
        let mut numbers = 0..;
        let mut kept = Vec::new();
        let shape = FrameShape {
            width: geometry.width(),
            height: geometry.height(),
            depth: geometry.depth(),
            phase: self.how.phase,
            camera: look.camera.clone(),
        };
        let correct_next = |leaving: &mut [u16]| -> anyhow::Result<()> {
            rows.next_row(&mut entering)?;
            if let Some(row) = numbers.next() {
                corrector.correct_row_of(&self.chosen.tables, row, &entering, leaving);
            }
            if !places.previews.is_empty() {
                kept.extend_from_slice(leaving);
            }
            Ok(())
        };
        let written =
            frames::write_rows(&places.frames[index], &shape, self.arguments.overwrite, correct_next);
        written.map_err(unwritten)?;
        self.note_written(&places.frames[index]);
        if !kept.is_empty() {
            let corrected =
                Frame::new(shape.width, shape.depth, shape.phase, kept).map_err(Failure::error)?;
            self.write_preview(places, index, &look, &corrected).map_err(Failure::error)?;
        }
        Ok(())
    }
}

/// A wrong input is the call's fault, unlike an output that cannot be written.
fn unwritten(error: anyhow::Error) -> Failure {
    if error.is::<WriteError>() { Failure::error(error) } else { Failure::call(error) }
}
