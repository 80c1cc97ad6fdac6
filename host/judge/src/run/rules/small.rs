//! Tables and frames of the least width, for any board.

use std::sync::Arc;

use halfrow_model::{Content, Geometry, MIN_WIDTH, Phase, TableSet};
use rand_pcg::Pcg64Mcg;

use crate::board::{Capabilities, NumberedFrame};
use crate::run::drawn::{Weights, drawn_factors, drawn_kernel};
use crate::run::plan::variations::Build;
use crate::tables::Generation;

/// Rows of a small frame, if the board takes that many.
pub(super) const ROWS: usize = 4;
/// Rows of the tables, for tall frames, in which a row must be found.
pub(super) const TALL: usize = 20;

/// The frames and tables with which the rules are tried.
pub(super) struct Small {
    /// Width, rows, depth and centre of a small frame.
    pub(super) geometry: Geometry,
    /// The seed from which frames are drawn.
    pub(super) seed: u32,
    pub(super) phase: Phase,
    /// L, in pixel clocks.
    latency: u16,
    /// Whether the board signs what entered of each row.
    pub(super) names_entered: bool,
    /// Two different generations, for tall frames.
    pub(super) tables: [Generation; 2],
}

impl Small {
    /// For a board with these capabilities, drawn from `seed`; none if such tables cannot be made for it.
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
            Some(Generation {
                number: 0,
                tables,
                kernel: drawn_kernel(build.taps, Weights::Calm, &mut draws)?,
            })
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

    /// The tables at `place` for frames of `rows` rows, as generation `number`.
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

    /// Frame `number`, with the size of `tables`.
    pub(super) fn frame(&self, number: u16, tables: &TableSet) -> NumberedFrame {
        let content = Content { seed: self.seed, frame: number };
        NumberedFrame { number, frame: Arc::new(content.frame(tables.geometry(), self.phase)) }
    }
}
