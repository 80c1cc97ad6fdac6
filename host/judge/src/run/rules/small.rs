//! Tables and frames of the least width, made for any board.

use std::sync::Arc;

use halfrow_model::{Content, Geometry, MIN_WIDTH, Phase, TableSet};
use rand_pcg::Pcg64Mcg;

use crate::board::{Capabilities, NumberedFrame};
use crate::run::Generation;
use crate::run::at_speed::{CALM, drawn_factors, drawn_kernel};
use crate::run::variations::Build;

/// Rows of a small frame, if a board can have so many.
const ROWS: usize = 4;
/// Rows that the tables have, for frames in which a row must be found.
const TALL: usize = 20;

/// What the rules are tried with.
pub(super) struct Small {
    /// Width, rows, depth and centre.
    pub(super) geometry: Geometry,
    /// What frames are drawn from.
    pub(super) seed: u32,
    pub(super) phase: Phase,
    /// L, in pixel clocks.
    latency: u16,
    /// Whether the board tells of each row what entered.
    pub(super) names_entered: bool,
    /// Two that are not alike, for tall frames.
    pub(super) tables: [Generation; 2],
}

impl Small {
    /// For a board of these capabilities, drawn by `seed`; none if the board can have no rows at all.
    pub(super) fn new(capabilities: &Capabilities, seed: u64, phase: Phase) -> Option<Self> {
        let build = Build::of(capabilities);
        let most = usize::from(capabilities.max_height);
        let of_rows = |rows: usize| {
            Geometry::new(MIN_WIDTH, rows.min(most), *build.depths.last()?, MIN_WIDTH as u32 - 1).ok()
        };
        let (geometry, tall) = (of_rows(ROWS)?, of_rows(TALL)?);
        let mut draws = Pcg64Mcg::new(u128::from(seed) | 1 << 65);
        let mut drawn = || {
            let tables = drawn_factors(tall, build.ring, &mut draws)?;
            Some(Generation { number: 0, tables, kernel: drawn_kernel(build.taps, CALM, &mut draws)? })
        };
        let tables = [drawn()?, drawn()?];
        let Capabilities { latency, entered: names_entered, .. } = *capabilities;
        Some(Self { geometry, seed: seed as u32, phase, latency: latency.into(), names_entered, tables })
    }

    /// D of a frame, in pixel clocks.
    pub(super) fn latency(&self, geometry: &Geometry) -> u16 {
        self.latency_of(geometry.width())
    }

    /// D of rows of `width` samples, in pixel clocks.
    pub(super) fn latency_of(&self, width: usize) -> u16 {
        width as u16 / 2 + self.latency
    }

    /// The tables at `place` for frames of so many rows, as generation `number`.
    pub(super) fn made(&self, place: usize, rows: usize, number: u8) -> Generation {
        let own = &self.tables[place];
        Generation { number, ..own.upper(rows).unwrap_or_else(|| own.clone()) }
    }

    /// The rows of a tall frame.
    pub(super) fn tall(&self) -> usize {
        self.tables[0].tables.geometry().height()
    }

    /// The rows of a small frame.
    pub(super) fn rows(&self) -> usize {
        self.geometry.height()
    }

    /// Frame `number`, of as many rows as `tables` have.
    pub(super) fn frame(&self, number: u16, tables: &TableSet) -> NumberedFrame {
        let content = Content { seed: self.seed, frame: number };
        NumberedFrame { number, frame: Arc::new(content.frame(tables.geometry(), self.phase)) }
    }
}
