//! Tables and frames of the least width, made for any board.

use std::sync::Arc;

use halfrow_model::{Content, Geometry, Kernel, MIN_WIDTH, Phase, TableSet};
use rand_pcg::Pcg64Mcg;

use super::compared::Made;
use crate::board::{Capabilities, NumberedFrame};
use crate::run::at_speed::{CALM, drawn_factors, drawn_kernel};
use crate::run::variations::Build;

/// Rows of a small frame, if a board can have so many.
const ROWS: usize = 4;
/// Rows that the tables have, for frames in which a row must be found.
const TALL: usize = 20;

/// Tables with their kernel.
pub(super) struct Tables {
    rows: TableSet,
    pub(super) kernel: Kernel,
}

impl Tables {
    /// For frames of so many rows, at most those that the tables have.
    pub(super) fn of(&self, rows: usize) -> TableSet {
        let own = self.rows.geometry();
        let factors = self.rows.row_factors().iter().take(rows).copied().collect();
        let geometry = Geometry::new(own.width(), rows, own.depth(), own.centre2()).unwrap_or(*own);
        TableSet::new(geometry, factors).unwrap_or_else(|_| self.rows.clone())
    }
}

/// What the rules are tried with.
pub(super) struct Small {
    /// Width, rows, depth and centre.
    pub(super) geometry: Geometry,
    /// Rows that the tables have.
    pub(super) tall: usize,
    /// What frames are drawn from.
    pub(super) seed: u32,
    pub(super) phase: Phase,
    /// L, in pixel clocks.
    latency: u16,
    /// Two that are not alike.
    pub(super) tables: [Tables; 2],
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
            let rows = drawn_factors(tall, build.ring, &mut draws)?;
            Some(Tables { rows, kernel: drawn_kernel(build.taps, CALM, &mut draws)? })
        };
        let tables = [drawn()?, drawn()?];
        Some(Self {
            geometry,
            tall: tall.height(),
            seed: seed as u32,
            phase,
            latency: capabilities.latency.into(),
            tables,
        })
    }

    /// Their geometry with another number of rows.
    pub(super) fn of_height(&self, rows: usize) -> Geometry {
        let own = &self.geometry;
        Geometry::new(own.width(), rows, own.depth(), own.centre2()).unwrap_or(*own)
    }

    /// D of a frame, in pixel clocks.
    pub(super) fn latency(&self, geometry: &Geometry) -> u16 {
        geometry.width() as u16 / 2 + self.latency
    }

    /// What the tables at `place` make of a frame of so many rows, as `generation`.
    pub(super) fn made(&self, place: usize, rows: usize, generation: u8) -> Made {
        let tables = &self.tables[place];
        Made { generation, tables: tables.of(rows), kernel: tables.kernel.clone(), gap_seed: 0 }
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
