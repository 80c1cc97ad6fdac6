//! A frame that was wrong at speed, made again and again until the board traps a row of it.

use std::iter;
use std::slice;

use halfrow_model::{Content, row_signature};
use halfrow_protocol::message::BurstMode;

use super::burst::BurstPlan;
use super::predicted::signer;
use super::tables_late::tables_late;
use super::watched::{EndsEarly, Watched};
use super::{FEW, USUAL};
use crate::board::{NumberedFrame, Trapped, Unjudged};
use crate::compare::Comparison;
use crate::diagnosis::{self, Case, Uploaded};
use crate::frames::{Builtin, Scene};
use crate::reference::correct;
use crate::result::{
    Account, CheckName, Defect, Evidence, Finding, FrameReport, FrameTiming, Problem, Repetition, Suspect,
};
use crate::run::findings::{During, End};
use crate::run::kept::as_found;
use crate::run::plan::Generation;
use crate::run::steps::Run;
use crate::verdict::Cause;

/// Differing samples below which a row is too little to tell one defect from another.
const TELLING: usize = 4;

/// What making a frame again has shown.
struct Again {
    repetition: Repetition,
    suspects: Vec<Suspect>,
}

impl From<Repetition> for Again {
    fn from(repetition: Repetition) -> Self {
        Self { repetition, suspects: Vec::new() }
    }
}

impl Run<'_> {
    /// What ends a run whose frames are wrong at speed, and the likeliest part.
    pub(super) fn wrong_at_speed(
        &mut self,
        plan: &BurstPlan,
        tables: &[Generation],
        watched: &Watched,
    ) -> End {
        let Watched { frames, wrong, .. } = *watched;
        let first = watched.wrong_frames.first().map_or(0, |frame| frame.n);
        let again = match tables_late(plan, tables, watched) {
            _ if plan.mode == BurstMode::Trapped => self.told_of_trap(plan, tables, watched),
            Some(suspect) => Ok(Again { repetition: Repetition::NotNeeded {}, suspects: vec![suspect] }),
            // The signatures came under the board's own CRC, so the verdict stands whatever becomes of this.
            None => self.make_again(plan, tables, first),
        };
        let again = again.unwrap_or_else(|end| {
            tracing::warn!("the frame was not made again: {}", end.check().2.sentence());
            Repetition::Impossible {}.into()
        });
        let Again { repetition, mut suspects } = again;
        if suspects.is_empty() {
            suspects.push(only_at_speed(None));
        }
        let suspect = suspects.first().map(|suspect| Box::new(suspect.defect.clone()));
        let finding = Finding::DiffersAtSpeed { wrong, frames, first, repetition, suspect };
        End::Failed { check: CheckName::AtSpeed, finding, suspects }
    }

    fn make_again(&mut self, plan: &BurstPlan, tables: &[Generation], n: u32) -> Result<Again, End> {
        let bank = usize::from(plan.is_of_shadow(n));
        let Some(generation) = tables.get(bank).filter(|_| plan.has_trap()) else {
            return Ok(Repetition::NoTrap {}.into());
        };
        if bank > 0 {
            self.activate(generation)?;
        }
        // Twice as far as the first time, since a board may have to become warm, and no longer than a usual burst.
        let most = plan.frames_in(2 * USUAL).max(2 * FEW);
        let plan = plan.trapping(n, n.saturating_add(1).saturating_mul(2).clamp(2 * FEW, most));
        self.expect(&plan, generation)?;
        let ends_early = EndsEarly { when_wrong: true, at: None };
        let (watched, ended) = self.watch(&plan, slice::from_ref(generation), ends_early, &mut |_, _| {});
        ended?;
        self.told_of_trap(&plan, slice::from_ref(generation), &watched)
    }

    /// Has the board know the signatures of the frame that `plan` repeats with `generation`.
    pub(super) fn expect(&mut self, plan: &BurstPlan, generation: &Generation) -> Result<(), End> {
        let mut signatures = Vec::new();
        signer(generation).sign(&generation.tables, plan.content(0), &mut signatures);
        self.board.expect(&signatures).during(CheckName::AtSpeed)
    }

    /// What was kept of a burst in which one frame was repeated.
    fn told_of_trap(
        &mut self,
        plan: &BurstPlan,
        tables: &[Generation],
        watched: &Watched,
    ) -> Result<Again, End> {
        let (Some(first), Some(generation)) = (watched.wrong_frames.first(), tables.first()) else {
            return Ok(Repetition::AllRight { frames: watched.frames }.into());
        };
        // Records come by the handful, so that others may be there behind it.
        let frames = first.n + 1;
        let trapped = self.board.trap().during(CheckName::AtSpeed)?;
        let row = trapped.as_ref().map(|trapped| trapped.row);
        let told = trapped.and_then(|trapped| self.suspects_of(generation, plan.content(0), &trapped));
        let (Some(row), Some(suspects)) = (row, told) else {
            return Ok(Repetition::NothingTrapped { frames }.into());
        };
        Ok(Again { repetition: Repetition::Trapped { frames, row }, suspects })
    }

    /// Makes the tables of the other bank the active ones, which takes a frame.
    pub(super) fn activate(&mut self, generation: &Generation) -> Result<(), End> {
        let Generation { number, tables, kernel } = generation;
        let scene = Scene { geometry: *tables.geometry(), ..self.plan.scene(u16::MAX.into()) };
        let frame = Builtin::Noise
            .render(&scene)
            .map_err(|error| End::error(CheckName::AtSpeed, Cause::Station, Problem::of(&error)))?;
        self.board.commit(tables, kernel, u16::MAX, *number).during(CheckName::AtSpeed)?;
        let frame = NumberedFrame { number: u16::MAX, frame: frame.into() };
        self.board.stream(&mut Unjudged(iter::once(frame))).during(CheckName::AtSpeed)
    }

    /// The suspects by a trapped row of a frame that `generation` made of `content`; none if the row is as it should be.
    ///
    /// It is the first of its burst that differs, so those above it in the frame were right: the frame up to it bears witness.
    fn suspects_of(
        &self,
        generation: &Generation,
        content: Content,
        trapped: &Trapped,
    ) -> Option<Vec<Suspect>> {
        let Trapped { row, signature, samples } = trapped;
        let own = generation.tables.geometry();
        let is_row = *row < own.height() && samples.len() == own.width();
        if !is_row || row_signature(samples) != *signature {
            return None;
        }
        let generation = generation.upper(row + 1)?;
        let input = content.frame(generation.tables.geometry(), self.plan.phase);
        let expected = correct(&generation.tables, &generation.kernel, &input).ok()?;
        let mut found = expected.samples().to_vec();
        found[row * own.width()..].copy_from_slice(samples);
        let found = as_found(&expected, found)?;
        let comparison = Comparison::of_frames(&expected, &found);
        let differing = comparison.differences;
        if differing == 0 {
            return None;
        }
        let only = only_at_speed(Some((*row, expected.row(*row), samples)));
        let evidence = Evidence { index: 0, input, found, expected };
        let mut suspects = self.diagnose_row(&generation, content, comparison, &evidence);
        let is_told = differing >= TELLING && suspects.first().is_some_and(|first| first.explained >= 1.0);
        suspects.insert(if is_told { 1 } else { 0 }, only);
        Some(suspects)
    }

    fn diagnose_row(
        &self,
        generation: &Generation,
        content: Content,
        comparison: Comparison,
        evidence: &Evidence,
    ) -> Vec<Suspect> {
        let Generation { number, tables, kernel } = generation;
        let frame = FrameReport {
            name: "at speed".to_owned(),
            number: content.frame,
            sha256: String::new(),
            phase: self.plan.phase,
            generation: *number,
            timing: FrameTiming::LeastBlanking { clocks: self.board.capabilities.least_blanking },
            variation: None,
            first_rows: None,
            rows: tables.geometry().height(),
            comparison,
            seconds: 0.0,
        };
        diagnosis::diagnose(&Case {
            uploaded: &[Uploaded { generation: *number, tables, kernel }],
            ring: self.board.capabilities.ring.into(),
            frames: slice::from_ref(&frame),
            evidence: slice::from_ref(evidence),
        })
    }
}

/// What fails at the full pixel clock alone, seen in `row` if one was trapped: its number, what it should be, what it is.
pub(super) fn only_at_speed(row: Option<(usize, &[u16], &[u16])>) -> Suspect {
    let defect = match row {
        None => Defect::OnlyAtSpeed { row: None, samples: 0, bits: Vec::new() },
        Some((row, expected, found)) => {
            let changed = expected.iter().zip(found).map(|(expected, found)| expected ^ found);
            let samples = changed.clone().filter(|&bits| bits != 0).count();
            let all = changed.fold(0, |all, bits| all | bits);
            let bits = (0..u16::BITS).filter(|bit| all >> bit & 1 == 1).collect();
            Defect::OnlyAtSpeed { row: Some(row), samples, bits }
        }
    };
    Suspect { defect, account: Account::Nothing, explained: 0.0 }
}
