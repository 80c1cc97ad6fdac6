//! Frames that must come back right.

use std::collections::VecDeque;
use std::ops::ControlFlow;
use std::sync::Arc;

use halfrow_model::{BitDepth, Frame, row_signature};

use super::small::Small;
use crate::board::{NumberedFrame, ReturnedRow, RowTraffic};
use crate::reference::correct;
use crate::result::RowPart;
use crate::run::at_speed::MadeRows;
use crate::run::frames::pauses::pauses;
use crate::tables::Generation;

/// How a frame must come back.
struct Right {
    number: u16,
    /// What goes in, and the generation that corrects it; none for a frame that no tables give.
    of: Option<(Arc<Frame>, Generation)>,
    generation: u8,
    frame: Frame,
    latency: u16,
    pauses: Vec<u16>,
    /// The CRC-32 of each row as it enters; none if the board does not sign it.
    entered: Vec<Option<u32>>,
}

/// Frames that must come back right.
#[derive(Default)]
pub(super) struct Compared {
    /// The seed of their gaps.
    gap_seed: u32,
    frames: VecDeque<NumberedFrame>,
    right: Vec<Right>,
    /// The first row that came back wrong.
    pub(super) wrong: Option<WrongRow>,
}

/// A row that came back wrong.
pub(super) struct WrongRow {
    /// Its number in its frame.
    pub(super) row: usize,
    /// Its frame.
    pub(super) frame: u16,
    /// What is wrong with it.
    pub(super) differs: Vec<RowPart>,
    /// What the frame up to it shows, if only its samples are wrong.
    pub(super) seen: Option<MadeRows>,
}

impl Compared {
    /// No frames yet, with gaps drawn from `gap_seed`.
    pub(super) fn with_gaps(gap_seed: u32) -> Self {
        Self { gap_seed, ..Self::default() }
    }

    /// The same with frames of these numbers added, which `made` corrects.
    pub(super) fn with(
        mut self,
        small: &Small,
        numbers: impl IntoIterator<Item = u16>,
        made: &Generation,
    ) -> Self {
        let Generation { number: generation, tables, kernel } = made;
        for number in numbers {
            let numbered = small.frame(number, tables);
            if let Ok(frame) = correct(tables, kernel, &numbered.frame) {
                let of = Some((Arc::clone(&numbered.frame), made.clone()));
                self.expect(small, &numbered, frame, (*generation, of));
            }
            self.frames.push_back(numbered);
        }
        self
    }

    /// Frame `number` with samples of 12 bits, corrected with `made` by a board that is set to `depth`, and the number of
    /// its samples above that depth.
    pub(super) fn of_twelve_bits(
        small: &Small,
        number: u16,
        made: &Generation,
        depth: BitDepth,
    ) -> Option<(Self, u32)> {
        let centre2 = made.tables.geometry().centre2();
        let tables = made.tables.with_settings(BitDepth::Twelve, centre2).ok()?;
        let numbered = small.frame(number, &tables);
        let over = numbered.frame.samples().iter().filter(|&&sample| sample > depth.max()).count();
        // The depth only sets where outputs are clamped. It changes nothing before that.
        let whole = correct(&tables, &made.kernel, &numbered.frame).ok()?;
        let samples = whole.samples().iter().map(|&sample| sample.min(depth.max())).collect();
        let frame = Frame::new(whole.width(), whole.depth(), whole.phase(), samples).ok()?;
        let mut compared = Self::default();
        compared.expect(small, &numbered, frame, (made.number, None));
        compared.frames.push_back(numbered);
        Some((compared, over as u32))
    }

    /// Adds that `sent` must come back as `frame`, made with a generation.
    fn expect(
        &mut self,
        small: &Small,
        sent: &NumberedFrame,
        frame: Frame,
        (generation, of): (u8, Option<(Arc<Frame>, Generation)>),
    ) {
        let geometry = (frame.width(), frame.height());
        let entered = sent.frame.rows().map(|row| small.names_entered.then(|| row_signature(row))).collect();
        self.right.push(Right {
            number: sent.number,
            of,
            generation,
            latency: small.latency_of(geometry.0),
            pauses: pauses(self.gap_seed, geometry.0, geometry.1),
            frame,
            entered,
        });
    }

    /// Whether a row came back right, no matter how often it was sent before.
    pub(super) fn is_right(&self, row: &ReturnedRow<'_>) -> bool {
        let right = self.right.iter().find(|right| right.number == row.frame);
        right.is_some_and(|right| right.is_told_of(row) && right.frame.row(row.row) == row.samples)
    }

    /// What is wrong with a row, of everything that came with it.
    pub(super) fn differing(&self, row: &ReturnedRow<'_>) -> Vec<RowPart> {
        let right = self.right.iter().find(|right| right.number == row.frame);
        right.map(|right| right.differing(row)).unwrap_or_default()
    }

    /// What is wrong with a row that was sent again and whose count of repeats must be `repeats`.
    pub(super) fn differing_again(&self, row: &ReturnedRow<'_>, repeats: u16) -> Vec<RowPart> {
        let (found, right) = (row.repeats, repeats);
        let counted = (found != right).then_some(RowPart::Repeats { found, right });
        self.differing(row).into_iter().chain(counted).collect()
    }

    /// What is wrong with a row that is not right. Its samples are diagnosed only if they are those of no right row.
    fn wrong(&self, row: &ReturnedRow<'_>) -> WrongRow {
        let mut others = self.right.iter().flat_map(|right| right.frame.rows());
        let is_other = others.any(|other| other == row.samples);
        let right = self.right.iter().find(|right| right.number == row.frame);
        let differs = self.differing(row);
        let right = right.filter(|right| right.is_told_of(row) && !is_other);
        WrongRow { row: row.row, frame: row.frame, differs, seen: right.and_then(|right| right.seen(row)) }
    }
}

impl Right {
    /// Whether everything that comes with a row's samples is right.
    fn is_told_of(&self, row: &ReturnedRow<'_>) -> bool {
        [row.first_latency, row.last_latency] == [self.latency; 2]
            && self.generation == row.generation
            && self.pauses.get(row.row) == Some(&row.pauses)
            && self.entered[row.row].is_none_or(|entered| row.entered == Some(entered))
    }

    /// What is wrong with a row that is not right.
    fn differing(&self, row: &ReturnedRow<'_>) -> Vec<RowPart> {
        let expected = self.frame.row(row.row);
        let pairs = expected.iter().zip(row.samples).enumerate();
        let mut wrong = pairs.filter(|(_, (right, found))| right != found);
        let differing = wrong.clone().count();
        let samples = wrong.next().map(|(column, (&right, &found))| RowPart::Samples {
            differing,
            column,
            found,
            right,
        });
        let (first, last) = (row.first_latency, row.last_latency);
        let (latency, generation) = (self.latency, self.generation);
        let pauses = self.pauses.get(row.row).filter(|&&right| right != row.pauses);
        let entered = self.entered[row.row].filter(|&right| row.entered != Some(right));
        [
            samples,
            (first != latency).then_some(RowPart::FirstLatency { found: first, right: latency }),
            (last != latency).then_some(RowPart::LastLatency { found: last, right: latency }),
            (row.generation != generation)
                .then_some(RowPart::Generation { found: row.generation, right: generation }),
            pauses.map(|&right| RowPart::Pauses { found: row.pauses, right }),
            entered.map(|right| RowPart::Entered { found: row.entered, right }),
        ]
        .into_iter()
        .flatten()
        .collect()
    }

    /// The frame up to `row`, whose earlier rows were right.
    fn seen(&self, row: &ReturnedRow<'_>) -> Option<MadeRows> {
        let (input, made) = self.of.as_ref()?;
        let made_by = made.upper(row.row + 1)?;
        let (input, expected) = (upper(input, row.row + 1)?, upper(&self.frame, row.row + 1)?);
        MadeRows::right(made_by, input, expected).ending_in(row.samples)
    }
}

/// The first `rows` rows of `frame`.
fn upper(frame: &Frame, rows: usize) -> Option<Frame> {
    let samples = frame.samples().get(..rows * frame.width())?.to_vec();
    Frame::new(frame.width(), frame.depth(), frame.phase(), samples).ok()
}

impl RowTraffic for Compared {
    fn next_frame(&mut self) -> Option<NumberedFrame> {
        self.frames.pop_front()
    }

    fn returned(&mut self, row: &ReturnedRow<'_>) -> ControlFlow<()> {
        if self.wrong.is_none() && !self.is_right(row) {
            self.wrong = Some(self.wrong(row));
        }
        ControlFlow::Continue(())
    }
}
