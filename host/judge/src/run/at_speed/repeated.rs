//! Has a frame that was wrong at speed made again and again until the board traps a row of it.

use std::{iter, slice};

use halfrow_model::{Content, Frame, Phase, row_signature};
use halfrow_protocol::message::BurstMode;

use super::burst::BurstPlan;
use super::content_wrong::content_wrong;
use super::predicted::signer;
use super::records_late::records_late;
use super::tables_late::tables_late;
use super::watched::{BurstSeen, EndsEarly};
use super::{FEW_AT_SPEED, USUAL};
use crate::board::{NumberedFrame, Trapped, Unjudged};
use crate::compare::{Comparison, bits_in};
use crate::diagnosis::{self, Case};
use crate::frames::{Builtin, Scene};
use crate::reference::correct;
use crate::result::{
    CheckName, Defect, Evidence, Finding, FrameReport, KeptRow, Lead, MissingRows, Repetition, Streamed,
    Suspect,
};
use crate::run::findings::{During, End};
use crate::run::frames::kept::as_found;
use crate::run::sessions::second_look::unasked;
use crate::run::steps::Run;
use crate::tables::Generation;

/// The least differing samples with which a row can tell one defect from another.
const TELLING: usize = 4;

/// What making a frame again showed.
struct MadeAgain {
    repetition: Repetition,
    suspects: Vec<Suspect>,
}

/// What a row shows that the trap kept.
enum RowVerdict {
    /// Its samples differ.
    Differs(Box<MadeRows>),
    /// Its samples are right, and their CRC is not the signature that the board says.
    SignedWrong,
    /// It is no row of the frame.
    NoRow,
}

/// Rows, and the generation that made them.
pub(in crate::run) struct MadeRows {
    pub(in crate::run) made_by: Generation,
    pub(in crate::run) evidence: Evidence,
}

impl MadeRows {
    /// Rows that `made_by` makes of `input` and that were found as `expected`.
    pub(in crate::run) fn right(made_by: Generation, input: Frame, expected: Frame) -> Self {
        let found = expected.clone();
        Self {
            made_by,
            evidence: Evidence { index: 0, input, found, expected, missing: MissingRows::default() },
        }
    }

    /// The same with `samples` as the last row; none if they are not a row.
    pub(in crate::run) fn ending_in(mut self, samples: &[u16]) -> Option<Self> {
        let expected = &self.evidence.expected;
        let mut found = expected.samples().to_vec();
        let last = found.len().checked_sub(samples.len()).filter(|_| samples.len() == expected.width())?;
        found[last..].copy_from_slice(samples);
        self.evidence.found = as_found(expected, found)?;
        Some(self)
    }
}

impl From<Repetition> for MadeAgain {
    fn from(repetition: Repetition) -> Self {
        Self { repetition, suspects: Vec::new() }
    }
}

impl Run<'_> {
    /// The end of a run whose frames are wrong at speed, with the suspects.
    pub(super) fn wrong_at_speed(
        &mut self,
        plan: &BurstPlan,
        tables: &[Generation],
        watched: &BurstSeen,
    ) -> End {
        let BurstSeen { frames, wrong, .. } = *watched;
        let first = watched.wrong_frames.first().map_or(0, |frame| frame.n);
        let again = if plan.mode == BurstMode::Trapped {
            self.told_of_trap(plan, tables, watched, true)
        } else if let Some(suspect) =
            tables_late(plan, tables, watched).or_else(|| records_late(plan, tables, watched))
        {
            Ok(MadeAgain { repetition: Repetition::NotNeeded {}, suspects: vec![suspect] })
        } else {
            // The signatures came under the board's own CRC, so the verdict stands, whatever making the frame again shows.
            self.make_again(plan, tables, first)
        };
        let again = again.unwrap_or_else(|end| {
            tracing::warn!("the frame was not made again: {}", unasked(&end).sentence());
            Repetition::Impossible {}.into()
        });
        let MadeAgain { repetition, mut suspects } = again;
        if suspects.is_empty() {
            suspects.extend(at_speed(repetition.streamed(), None));
        }
        let Lead { suspect, others, short } = Lead::of(&suspects);
        let ([wrong, frames, first], short) = ([wrong, frames, first].map(u64::from), short.map(Box::new));
        let finding = Finding::DiffersAtSpeed { wrong, frames, first, repetition, suspect, others, short };
        End::suspecting(CheckName::AtSpeed, finding, suspects)
    }

    fn make_again(&mut self, plan: &BurstPlan, tables: &[Generation], n: u32) -> Result<MadeAgain, End> {
        let bank = usize::from(plan.is_of_shadow(n));
        let Some(generation) = tables.get(bank).filter(|_| plan.has_trap()) else {
            return Ok(Repetition::NoTrap {}.into());
        };
        if bank > 0 {
            self.activate(generation)?;
        }
        // Twice as far as the first time, since a board may have to become warm, but no longer than two usual bursts.
        let most = plan.frames_in(2 * USUAL).max(2 * FEW_AT_SPEED);
        let plan = plan.trapping(n, n.saturating_add(1).saturating_mul(2).clamp(2 * FEW_AT_SPEED, most));
        self.expect(&plan, generation)?;
        let ends_early = EndsEarly { when_wrong: true, at: None };
        let (watched, ended) = self.watch(&plan, slice::from_ref(generation), ends_early, &mut |_, _| {});
        ended?;
        self.told_of_trap(&plan, slice::from_ref(generation), &watched, false)
    }

    /// Gives the board the signatures of the frame that `plan` repeats with `generation`.
    pub(super) fn expect(&mut self, plan: &BurstPlan, generation: &Generation) -> Result<(), End> {
        let mut signatures = Vec::new();
        signer(generation).sign(&generation.tables, plan.content(0), &mut signatures);
        self.board.expect(&signatures).during(CheckName::AtSpeed)
    }

    /// What the trap kept of a burst in which one frame was repeated; it was wrong `only_there` if that burst was not made because
    /// of it.
    fn told_of_trap(
        &mut self,
        plan: &BurstPlan,
        tables: &[Generation],
        watched: &BurstSeen,
        only_there: bool,
    ) -> Result<MadeAgain, End> {
        let (Some(first), Some(generation)) = (watched.wrong_frames.first(), tables.first()) else {
            return Ok(Repetition::AllRight { frames: watched.frames }.into());
        };
        // Several records come at once, so `watched` may have frames after the first wrong one.
        let frames = first.n + 1;
        let content = plan.content(0);
        let trapped = self.board.trap().during(CheckName::AtSpeed)?;
        let told = trapped.and_then(|trapped| Some((trapped.row, self.kept(generation, content, &trapped)?)));
        let (row, seen) = match told {
            None => return Ok(Repetition::NothingTrapped { frames, only_there }.into()),
            Some((_, RowVerdict::NoRow)) => return Ok(Repetition::NoSuchRow { frames, only_there }.into()),
            Some((row, RowVerdict::SignedWrong)) => return Ok(signed_wrong(frames, row, only_there)),
            Some((row, RowVerdict::Differs(seen))) => (row, seen),
        };
        let kept = kept_row(&seen);
        // A soak goes on, and spends no time on rows that a link must carry.
        let is_soak = self.plan.at_speed.soak().is_some();
        let right = seen.evidence.expected.samples();
        let back = if is_soak {
            Err(Streamed::NotTried)
        } else {
            self.first_rows_streamed(generation, content, right)
        };
        let streamed = match &back {
            Err(streamed) => *streamed,
            Ok(back) if back.starts_with(right) => Streamed::Right,
            Ok(_) => Streamed::Wrong,
        };
        let wrong = back.ok().filter(|_| streamed == Streamed::Wrong);
        let suspects = match wrong.and_then(|back| self.rows_streamed(generation, content, back)) {
            Some(seen) => self.diagnose_rows(&seen, "at speed", content.frame),
            None => self.suspects_of(&seen, content, streamed),
        };
        Ok(MadeAgain {
            repetition: Repetition::Trapped { frames, row, only_there, streamed, kept },
            suspects,
        })
    }

    /// Makes the tables of the other bank active, which takes a frame.
    pub(super) fn activate(&mut self, generation: &Generation) -> Result<(), End> {
        let Generation { number, tables, kernel } = generation;
        let scene = Scene { geometry: *tables.geometry(), ..self.plan.scene(u16::MAX.into()) };
        let frame =
            Builtin::Noise.render(&scene).map_err(|error| End::station(CheckName::AtSpeed, &error))?;
        self.board.commit(tables, kernel, u16::MAX, *number).during(CheckName::AtSpeed)?;
        let frame = NumberedFrame { number: u16::MAX, frame: frame.into() };
        let streamed = self.board.stream(&mut Unjudged(iter::once(frame))).during(CheckName::AtSpeed);
        self.unless_misconduct(CheckName::AtSpeed, streamed)
    }

    /// What a trapped row shows of a frame that `generation` made of `content`; none if the row is as it
    /// should be, or if neither its samples nor its signature are right.
    ///
    /// It is the first row of its burst that differs, so the rows above it were right: the diagnosis gets the frame up to
    /// this row.
    fn kept(&self, generation: &Generation, content: Content, trapped: &Trapped) -> Option<RowVerdict> {
        let Trapped { row, signature, samples } = trapped;
        let own = generation.tables.geometry();
        let is_row = *row < own.height() && samples.len() == own.width();
        if !is_row {
            return Some(RowVerdict::NoRow);
        }
        let above = correct_up_to(generation, content, row + 1, self.plan.phase)?.ending_in(samples)?;
        let is_right = above.evidence.found == above.evidence.expected;
        match (is_right, row_signature(samples) == *signature) {
            (false, true) => Some(RowVerdict::Differs(Box::new(above))),
            (true, false) => Some(RowVerdict::SignedWrong),
            (true, true) | (false, false) => None,
        }
    }

    /// What the first rows of the frame of `content` show, which was streamed through `generation` and came `back`.
    fn rows_streamed(&self, generation: &Generation, content: Content, back: Vec<u16>) -> Option<MadeRows> {
        let rows = back.len() / generation.tables.geometry().width();
        let mut seen = correct_up_to(generation, content, rows, self.plan.phase)?;
        seen.evidence.found = as_found(&seen.evidence.expected, back)?;
        Some(seen)
    }

    /// The suspects by what was `seen`, whose last row is the one that the trap kept.
    fn suspects_of(&self, seen: &MadeRows, content: Content, streamed: Streamed) -> Vec<Suspect> {
        let Evidence { expected, found, .. } = &seen.evidence;
        let row = expected.height() - 1;
        let kept = (row, expected.row(row), found.row(row));
        let mut suspects = self.diagnose_rows(seen, "at speed", content.frame);
        let explains_all = |first: &Suspect| first.is_known() && first.explained >= 1.0;
        if !suspects.first().is_some_and(explains_all)
            && let Some(made) = content_wrong(seen, content, self.plan.phase)
        {
            return vec![made];
        }
        // The same frame came back right when streamed, so none of what it went through is wrong at any clock.
        if streamed == Streamed::Right {
            return at_speed(streamed, Some(kept)).into_iter().collect();
        }
        let (differing, _) = changed(kept);
        let is_told = differing >= TELLING && suspects.first().is_some_and(|first| first.explained >= 1.0);
        let place = usize::from(is_told);
        suspects.splice(place..place, at_speed(streamed, Some(kept)));
        // Where something explains it, an unknown defect is not worth listing.
        if suspects.first().is_some_and(Suspect::is_known) {
            suspects.retain(Suspect::is_known);
        }
        suspects
    }

    /// The suspects by rows of the frame `frame` that are not among the streamed frames to judge.
    pub(in crate::run) fn diagnose_rows(&self, seen: &MadeRows, name: &str, frame: u16) -> Vec<Suspect> {
        let MadeRows { made_by, evidence } = seen;
        let tables = &made_by.tables;
        let frame = FrameReport {
            name: name.to_owned(),
            number: frame,
            sha256: String::new(),
            phase: self.plan.phase,
            generation: made_by.number,
            timing: self.least_blanking(tables),
            variation: None,
            first_rows: None,
            rows: tables.geometry().height(),
            missing: evidence.missing.clone(),
            comparison: Comparison::of_frames(&evidence.expected, &evidence.found),
            seconds: 0.0,
        };
        let mut suspects = diagnosis::diagnose(&Case {
            uploaded: slice::from_ref(made_by),
            ring: self.board.capabilities.ring.into(),
            frames: slice::from_ref(&frame),
            evidence: slice::from_ref(evidence),
        });
        for suspect in &mut suspects {
            if let Defect::NoneKnown { unstreamed, .. } = &mut suspect.defect {
                *unstreamed = true;
            }
        }
        suspects
    }
}

/// A frame that was wrong at try `frames`, of which the trap kept `row` with right samples and another signature.
fn signed_wrong(frames: u32, row: usize, only_there: bool) -> MadeAgain {
    let suspect = Suspect::explaining_nothing(Defect::SignatureWrong { row });
    MadeAgain { repetition: Repetition::SignedWrong { frames, row, only_there }, suspects: vec![suspect] }
}

/// What differs in the last row of `seen`, which is the one that the trap kept.
fn kept_row(seen: &MadeRows) -> Option<Box<KeptRow>> {
    let Evidence { expected, found, .. } = &seen.evidence;
    let row = expected.height().checked_sub(1)?;
    Some(Box::new(KeptRow::new(seen.made_by.number, row, expected.row(row), found.row(row))))
}

/// The first `rows` rows of the frame that `generation` makes of `content`, as if found right.
fn correct_up_to(generation: &Generation, content: Content, rows: usize, phase: Phase) -> Option<MadeRows> {
    let made_by = generation.upper(rows)?;
    let input = content.frame(made_by.tables.geometry(), phase);
    let expected = correct(&made_by.tables, &made_by.kernel, &input).ok()?;
    Some(MadeRows::right(made_by, input, expected))
}

/// A row with differing samples: its number, what it should be, and what it is.
pub(super) type TrappedRow<'a> = (usize, &'a [u16], &'a [u16]);

/// The suspect that something is wrong at the full pixel clock, with the row that was kept, if any. It depends on what
/// came back when the same frame was `streamed`: none if that was wrong too.
fn at_speed(streamed: Streamed, kept: Option<TrappedRow<'_>>) -> Option<Suspect> {
    let (row, (samples, bits)) = (kept.map(|(row, ..)| row), kept.map(changed).unwrap_or_default());
    let defect = match streamed {
        Streamed::NotTried => Defect::SeenAtSpeed { row, samples, bits, lost: None },
        Streamed::RowLost { row: lost } => {
            Defect::SeenAtSpeed { row, samples, bits, lost: Some(lost.into()) }
        }
        Streamed::Right => Defect::OnlyAtSpeed { row, samples, bits },
        Streamed::Wrong => return None,
    };
    Some(Suspect::explaining_nothing(defect))
}

/// How many samples differ, and in which bits.
fn changed((_, expected, found): TrappedRow<'_>) -> (usize, Vec<u32>) {
    let mut row = Comparison::new(expected.len(), 1);
    row.row(0, expected, found);
    (row.differences, bits_in(row.bits.into()))
}
