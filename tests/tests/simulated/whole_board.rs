//! Cases played through a whole board, by its packets: upload, commit, rows, credit, acknowledgement.

use std::ops::ControlFlow;
use std::sync::Arc;

use halfrow::board::{Board, Datapath, NumberedFrame, OpenOptions, ReturnedRow, RowTiming, RowTraffic};
use halfrow::link::Link;
use halfrow_model::{Frame, Kernel, TableSet};

use halfrow_tests::cases::{Build, Case, GridNeeds, Played};

/// An open session in which cases are played one after another.
pub(crate) struct WholeBoard {
    board: Board,
    next_frame: u16,
    /// Never 0, which is no generation, and never that of the tables before.
    next_generation: u8,
}

impl WholeBoard {
    /// Opens a session over `link`.
    ///
    /// # Panics
    /// When no board answers.
    #[must_use]
    pub(crate) fn open(link: Box<dyn Link>) -> Self {
        let board = Board::open(link, &OpenOptions::default()).unwrap();
        Self { board, next_frame: 0, next_generation: 1 }
    }

    /// The build of this board, for which cases are drawn.
    #[must_use]
    pub(crate) fn build(&self) -> Build {
        let capabilities = self.board.capabilities();
        Build {
            latency: capabilities.latency,
            ring: capabilities.ring,
            least_blanking: capabilities.least_blanking,
            outer_taps: capabilities.taps == 7,
            grids: capabilities.grids.map(|grids| GridNeeds {
                entries: grids.entries.into(),
                blanking: grids.grid_blanking.into(),
                width: grids.grid_width.into(),
            }),
        }
    }

    /// Plays the first frame alone. Then the tables of the second are committed in advance, and the first is played once more
    /// with the second right after it.
    ///
    /// # Panics
    /// When the board refuses anything.
    pub(crate) fn play(&mut self, case: &Case) -> Played {
        let [(tables, kernel, first), (next_tables, next_kernel, second)] = &case.frames[..] else {
            panic!("{} frames instead of two", case.frames.len())
        };
        let settings = &case.settings;
        let timing = RowTiming { blanking: settings.blanking, gap_seed: settings.gap_seed };
        // The settings are drawn for both frames, whatever tables they have.
        self.board.configure(tables.geometry(), timing, Datapath::RowFactors).unwrap();
        let mut played = Played::default();
        self.commit(tables, kernel, 0);
        self.stream(&[first], &mut played);
        self.commit(next_tables, next_kernel, 1);
        self.stream(&[first, second], &mut played);
        played
    }

    /// Commits tables for the frame that comes `ahead` frames after the next one.
    fn commit(&mut self, tables: &TableSet, kernel: &Kernel, ahead: u16) {
        let first_frame = self.next_frame.wrapping_add(ahead);
        self.board.upload(tables, kernel).unwrap();
        self.board.commit(tables, kernel, first_frame, self.next_generation).unwrap();
        self.next_generation = self.next_generation % 255 + 1;
    }

    fn stream(&mut self, frames: &[&Frame], played: &mut Played) {
        let frames: Vec<_> = frames.iter().map(|&frame| Arc::new(frame.clone())).collect();
        let first = self.next_frame;
        self.next_frame = self.next_frame.wrapping_add(frames.len() as u16);
        let frames = frames
            .into_iter()
            .zip(0..)
            .map(|(frame, index)| NumberedFrame { number: first.wrapping_add(index), frame });
        self.board.stream(&mut Collector { frames: frames.collect::<Vec<_>>().into_iter(), played }).unwrap();
    }
}

/// What comes out of [`WholeBoard::play`] according to the model.
#[must_use]
pub(crate) fn expected(case: &Case) -> Played {
    let mut whole = case.clone();
    whole.frames.insert(0, whole.frames[0].clone());
    whole.expected()
}

struct Collector<'a> {
    frames: std::vec::IntoIter<NumberedFrame>,
    played: &'a mut Played,
}

impl RowTraffic for Collector<'_> {
    fn next_frame(&mut self) -> Option<NumberedFrame> {
        self.frames.next()
    }

    fn returned(&mut self, row: &ReturnedRow<'_>) -> ControlFlow<()> {
        self.played.samples.extend(row.samples);
        self.played.latencies.extend([row.first_latency, row.last_latency]);
        ControlFlow::Continue(())
    }
}
