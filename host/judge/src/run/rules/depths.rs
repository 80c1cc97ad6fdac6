//! Samples above the depth of a board's frames: they are counted, and go in as they are.

use halfrow_model::{BitDepth, Geometry};

use super::compared::Compared;
use super::rows::{FRAME, GENERATION};
use super::{Rules, miscounted};
use crate::board::RowTiming;
use crate::result::{Counter, Rule};
use crate::run::findings::End;
use crate::run::plan::variations::Build;

/// The rows of a frame. The first one is not stretched.
const ROWS: usize = 2;

impl Rules<'_, '_> {
    /// Samples of 12 bits at every lower depth.
    pub(super) fn depths(&mut self) -> Result<(), End> {
        for depth in Build::of(&self.capabilities).depths {
            if depth < BitDepth::Twelve {
                self.samples_over(depth)?;
            }
        }
        self.configure(self.small.rows())
    }

    fn samples_over(&mut self, depth: BitDepth) -> Result<(), End> {
        let (own, rows) = (self.small.geometry, ROWS.min(self.small.rows()));
        let Ok(geometry) = Geometry::new(own.width(), rows, depth, own.centre2()) else { return Ok(()) };
        self.set(&geometry, RowTiming::default())?;
        let made = self.small.made(0, rows, GENERATION);
        let Some((compared, over)) = Compared::of_twelve_bits(&self.small, FRAME, &made, depth) else {
            return Ok(());
        };
        let before = self.status()?;
        self.frames(Rule::Samples, compared)?;
        let status = self.status()?;
        let counted = status.samples_over.wrapping_sub(before.samples_over);
        // A late copy of an old request may have cleared the counter.
        if counted == over || !self.run.board.had_each_packet_once(&status) {
            return Ok(());
        }
        Err(miscounted(Some(Rule::Samples), Counter::SamplesOver, counted, over))
    }
}
