//! What the judge has seen of all frames so far.

use super::entry::WrongEntry;
use super::kept::KeptFrames;
use crate::board::ReturnedRow;
use crate::result::{Finding, FrameReport, FrameTotals, LateRows, LatencyReport};
use crate::run::findings::End;
use crate::run::findings::levels::ShownBits;

/// What the judge has seen of all frames so far.
#[derive(Default)]
pub(crate) struct Observations {
    pub(crate) frames: Vec<FrameReport>,
    pub(crate) evidence: KeptFrames,
    pub(crate) shown: ShownBits,
    pub(crate) latency: Option<LatencyReport>,
    /// The first row that names the wrong generation.
    pub(crate) wrong_generation: Option<Finding>,
    /// The first row with a wrong latency.
    pub(crate) wrong_latency: Option<WrongLatency>,
    /// The first row that entered the core with other samples than were sent, and how many did.
    pub(crate) wrong_entry: Option<WrongEntry>,
    /// How many rows had their CRC of what entered compared.
    pub(crate) rows_with_entry: usize,
    /// The first row whose gaps are not those of the seed.
    pub(crate) wrong_pauses: Option<Finding>,
    /// The end of a run whose tables had changed when they were read back.
    pub(crate) changed_tables: Option<End>,
}

/// A row whose latency is not the one that the board claims, in pixel clocks.
pub(crate) struct WrongLatency {
    row: usize,
    frame: u16,
    first: u32,
    last: u32,
    claimed: u32,
    /// Whether all such rows are the same row of their frames.
    is_one_row: bool,
}

impl WrongLatency {
    /// The finding of which it is the first row: `rows` late rows of `of_rows`.
    pub(crate) fn finding(&self, rows: usize, of_rows: usize) -> Finding {
        let &Self { row, frame, first, last, claimed, is_one_row } = self;
        Finding::LatencyWrong(LateRows { rows, of_rows, is_one_row, row, frame, first, last, claimed })
    }
}

impl Observations {
    /// Whether nothing that was seen is wrong, judged or not.
    pub(crate) fn is_right(&self) -> bool {
        self.rows_are_right() && self.wrong_pauses.is_none() && self.changed_tables.is_none()
    }

    /// Whether no row is wrong, whatever is counted of it.
    pub(crate) fn rows_are_right(&self) -> bool {
        let told = self.wrong_generation.is_none() && self.wrong_latency.is_none();
        told && self.wrong_entry.is_none() && self.differences() == 0
    }

    /// What was wrong with rows whose samples are right; none if nothing was.
    pub(crate) fn wrong_beside_samples(&self) -> Option<Finding> {
        let generation = self.wrong_generation.clone();
        let entry = || self.wrong_entry.map(WrongEntry::finding);
        let late = || {
            let (rows, of_rows) = self.latency.map_or((0, 0), |latency| (latency.wrong_rows, latency.rows));
            self.wrong_latency.as_ref().map(|first| first.finding(rows, of_rows))
        };
        generation.or_else(entry).or_else(late)
    }

    pub(crate) fn totals(&self) -> FrameTotals {
        FrameTotals::of(&self.frames)
    }

    pub(crate) fn differences(&self) -> usize {
        self.totals().differences
    }

    pub(crate) fn differing_frames(&self) -> usize {
        self.totals().differing_frames
    }

    pub(crate) fn samples(&self) -> usize {
        self.totals().samples
    }

    /// The finding that every row took the same latency, longer than the one that the board claims, if so. The last row of
    /// a frame then does not come out where the player stops after as many clocks as the claimed latency needs.
    pub(crate) fn all_late(&self) -> Option<Finding> {
        let latency = self.latency.filter(|seen| seen.wrong_rows == seen.rows && seen.least == seen.most)?;
        let wrong = self.wrong_latency.as_ref().filter(|_| latency.most > latency.claimed)?;
        Some(wrong.finding(latency.wrong_rows, latency.rows))
    }

    /// Notes the latency of a row that came back. The board claims `claimed` pixel clocks, and `limit` are allowed.
    pub(crate) fn note_latency(&mut self, row: &ReturnedRow<'_>, claimed: u32, limit: u32) {
        let (first, last) = (u32::from(row.first_latency), u32::from(row.last_latency));
        let seen = self.latency.get_or_insert(LatencyReport {
            claimed,
            limit,
            least: first,
            most: first,
            rows: 0,
            wrong_rows: 0,
        });
        seen.least = seen.least.min(first).min(last);
        seen.most = seen.most.max(first).max(last);
        seen.rows += 1;
        if (first, last) != (claimed, claimed) {
            seen.wrong_rows += 1;
            let (row, frame) = (row.row, row.frame);
            let new = WrongLatency { row, frame, first, last, claimed, is_one_row: true };
            let wrong = self.wrong_latency.get_or_insert(new);
            wrong.is_one_row &= wrong.row == row;
        }
    }
}
