//! The parts of a plan in the order in which they are streamed.

use std::sync::Arc;

use halfrow_model::{Frame, FrameError, Geometry};

use super::parts::{Part, of_height};
use super::variations::Build;
use super::{DECOY, FrameSource, JUDGED, Plan, ScheduledFrame, Segment, Timing};
use crate::frames::{Builtin, Scene};
use crate::result::Variation;

impl Plan {
    /// The run, segment by segment:
    ///
    /// * a frame with the decoy, if there is one;
    /// * another frame with the decoy, directly followed by the frames to judge. A board with one bank of tables cannot
    ///   change them between two such frames: there, and without a decoy, this segment has only the frames to judge;
    /// * noise with the sensor's blanking, and noise with gaps;
    /// * a frame for each other centre or depth.
    ///
    /// If only some parts are selected, frames keep the numbers that they have in the whole run, and with them their content.
    #[must_use]
    pub fn schedule(&self, build: &Build) -> Vec<Segment> {
        let whole = self.whole_schedule(build);
        match &self.selection {
            None => whole,
            Some(selection) => self.streamable(selection).cut(whole),
        }
    }

    /// The run with all its parts.
    pub(crate) fn whole_schedule(&self, build: &Build) -> Vec<Segment> {
        let mut numbers = 0..=u16::MAX;
        let mut frame = |part, source: FrameSource, generation| ScheduledFrame {
            number: numbers.next().unwrap_or_default(),
            source,
            generation,
            part,
        };
        let noise = || FrameSource::Builtin(Builtin::Noise);
        let has_decoy = self.decoy(build).is_some();
        let first = has_decoy.then(|| vec![frame(Part::Decoy, noise(), DECOY)]);
        let swap = (has_decoy && build.table_banks > 1).then(|| frame(Part::Swap, noise(), DECOY));
        let first_judged = u16::from(first.is_some()) + u16::from(swap.is_some());
        let mut judged: Vec<_> = swap.into_iter().collect();
        for _ in 0..self.repeat {
            let sources = self.frames.iter().enumerate();
            judged.extend(sources.map(|(place, source)| frame(Part::Judged(place), source.clone(), JUDGED)));
        }
        let sensor = vec![frame(Part::SensorBlanking, noise(), JUDGED)];
        let gaps = vec![frame(Part::Gaps, noise(), JUDGED)];
        let geometry = *self.tables.geometry();
        let varied: Vec<_> = self
            .varied(build)
            .map(|generation| {
                let geometry = *generation.tables.geometry();
                let frame = frame(self.varied_part(&geometry), noise(), generation.number);
                let commit = Some((frame.generation, frame.number));
                Segment { geometry, timing: Timing::Least, commit, frames: vec![frame] }
            })
            .collect();
        let segment = |timing, commit, frames| Segment { geometry, timing, commit, frames };
        let first = first.map(|frames| segment(Timing::Least, Some((DECOY, 0)), frames));
        let others = [
            segment(Timing::Least, Some((JUDGED, first_judged)), judged),
            segment(Timing::Sensor, None, sensor),
            segment(Timing::Gaps((self.seed as u32) | 1), None, gaps),
        ];
        first.into_iter().chain(others).chain(varied).collect()
    }

    fn varied_part(&self, geometry: &Geometry) -> Part {
        match self.variation(geometry) {
            Some(Variation::Depth { bits }) => Part::Depth(bits),
            _ => Part::Centre,
        }
    }

    /// The samples of a scheduled frame, whose segment has `geometry`: the first rows of a frame as high as the tables.
    /// Noise is different in every frame.
    ///
    /// # Errors
    /// [`FrameError`] when a built-in frame cannot be made.
    pub fn render(&self, scheduled: &ScheduledFrame, geometry: &Geometry) -> Result<Arc<Frame>, FrameError> {
        let whole = match &scheduled.source {
            FrameSource::File { frame, .. } => Arc::clone(frame),
            FrameSource::Builtin(builtin) => {
                let height = self.tables.geometry().height();
                let geometry = of_height(geometry, height);
                Arc::new(builtin.render(&Scene { geometry, ..self.scene(scheduled.number.into()) })?)
            }
        };
        if whole.height() <= geometry.height() {
            return Ok(whole);
        }
        let samples = whole.samples()[..geometry.height() * whole.width()].to_vec();
        Frame::new(whole.width(), whole.depth(), whole.phase(), samples).map(Arc::new)
    }
}
