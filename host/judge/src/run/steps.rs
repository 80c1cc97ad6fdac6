//! The order of a run's steps, with those too short for a module: the judge, identity, link.

use std::sync::mpsc::Receiver;
use std::thread;

use super::findings::{During, End, Findings};
use super::frames::observations::Observations;
use super::frames::prepared::{self, PrepareError, Prepared};
use super::golden::{self, CannotJudge};
use super::options::RunOptions;
use super::plan::misfit::check_fit;
use super::plan::patterns::patterns;
use super::plan::variations::Build;
use super::plan::{Plan, Segment};
use super::sessions::Sessions;
use crate::board::{Board, BoardError, UnknownDatapath, possible};
use crate::link::Link;
use crate::progress::{Progress, Step};
use crate::reference;
use crate::result::{CheckName, Finding, NotExercised};
use crate::tables::{DATAPATH, Generation, datapath_of};
use crate::target::BoardKind;
use crate::verdict::Cause;

/// Samples of the plan were not judged although nothing was found, which only a fault of this program can cause.
#[derive(Debug, thiserror::Error)]
#[error(
    "{judged} of the plan's {planned} samples were judged, and nothing says why; report this fault of halfrow to its developers"
)]
pub(crate) struct NotAllJudged {
    /// Samples of the frames that were to be streamed.
    pub planned: usize,
    /// Samples that were compared.
    pub judged: usize,
}

/// A run with an open board.
pub(super) struct Run<'a> {
    pub(super) plan: &'a Plan,
    pub(super) board: &'a mut Board,
    pub(super) sessions: &'a mut Sessions,
    pub(super) generations: Vec<Generation>,
    pub(super) options: &'a RunOptions,
    pub(super) progress: &'a dyn Progress,
    pub(super) findings: &'a mut Findings,
    /// How many bursts were begun. The count is a name that no other burst of the run has.
    pub(super) bursts: u32,
    /// Whether the run was made again because counters were wrong that a link can also change.
    pub(super) counters_doubted: bool,
}

/// Carries out the steps of `plan` with the board behind `link`, up to the first that ends the run. Returns what a board that is
/// right was not exercised in.
pub(super) fn carry_out(
    plan: &Plan,
    link: Box<dyn Link>,
    options: &RunOptions,
    sessions: &mut Sessions,
    progress: &dyn Progress,
    findings: &mut Findings,
    seen: &mut Observations,
) -> Result<Vec<NotExercised>, End> {
    progress.step(Step::JudgeTheJudge);
    judge_the_judge(findings)?;
    progress.step(Step::OpenTheBoard);
    let mut board = sessions.open(link)?;
    tracing::info!("session {} with {}", board.welcome.session, board.capabilities.name);
    let run = Run {
        plan,
        generations: plan.generations(&Build::of(&board.capabilities)),
        board: &mut board,
        sessions,
        options,
        progress,
        findings,
        bursts: 0,
        counters_doubted: false,
    };
    let end = run.all_steps(seen);
    sessions.note_end(&board);
    // Whatever happened, the next run must find the board free. A board that is gone need not be asked.
    let reachable = !matches!(&end, Err(end) if end.is_unreachable());
    if reachable {
        board.close();
    }
    end
}

fn judge_the_judge(findings: &mut Findings) -> Result<(), End> {
    match golden::judge_the_judge() {
        Ok(samples) => {
            let path = reference::path().to_string();
            findings.checks.passed(CheckName::Judge, Finding::GoldenSamplesFound { samples, path });
            Ok(())
        }
        Err(what) => Err(End::station(CheckName::Judge, &CannotJudge(what))),
    }
}

/// Nothing of `schedule` was left out if `judged` samples were compared.
fn all_judged(schedule: &[Segment], judged: usize) -> Result<(), End> {
    let planned = schedule.iter().map(|segment| segment.rows() * segment.geometry.width()).sum();
    if judged == planned {
        return Ok(());
    }
    Err(End::station(CheckName::Frames, &NotAllJudged { planned, judged }))
}

impl Run<'_> {
    /// All steps that need an open board. Returns what a board that is right was not exercised in.
    fn all_steps(mut self, seen: &mut Observations) -> Result<Vec<NotExercised>, End> {
        self.findings.note_identity(self.board);
        self.identity()?;
        let Some(limit) = self.plan.within else { return self.looking_again(seen) };
        let chosen = self.over_outages(|run| run.choose(limit))?;
        Run { plan: &chosen, ..self }.looking_again(seen)
    }

    /// The generation of that number, if the plan has one.
    pub(super) fn generation(&self, number: u8) -> Option<Generation> {
        self.generations.iter().find(|generation| generation.number == number).cloned()
    }

    /// All steps from the link on, and again if a late packet may have caused what they end with.
    fn looking_again(&mut self, seen: &mut Observations) -> Result<Vec<NotExercised>, End> {
        self.all_but_identity(seen).map_err(|found| match found {
            // A soak has already looked into each burst.
            found if self.findings.soak.is_some() => found,
            found if found.is_failed() || found.is_answer() => self.look_again(found, seen),
            found => found,
        })
    }

    /// All steps from the link on. They do not depend on what the board held before.
    pub(super) fn all_but_identity(&mut self, seen: &mut Observations) -> Result<Vec<NotExercised>, End> {
        let schedule = self.plan.schedule(&Build::of(&self.board.capabilities));
        let (plan, generations) = (self.plan, self.generations.clone());
        let ended = thread::scope(|scope| {
            let frames = prepared::ahead(scope, plan, &schedule, generations);
            let frames = frames.during(CheckName::Frames)?;
            self.progress.step(Step::TestTheLink);
            self.over_outages(Self::link)?;
            let last = self.stream_and_judge(&schedule, &frames, seen)?;
            let bursts = match self.plan.at_speed.soak() {
                Some(length) => self.soak(length, last)?,
                None => self.at_speed(last, seen)?,
            };
            self.rules(last)?;
            Ok(self.not_exercised(seen, bursts))
        });
        ended.map_err(|end| self.told_of_window(end))
    }

    /// Streams the segments, whose frames come from `source`, and judges them. Returns the last segment.
    fn stream_and_judge<'s>(
        &mut self,
        schedule: &'s [Segment],
        source: &Receiver<Result<Prepared, PrepareError>>,
        seen: &mut Observations,
    ) -> Result<Option<&'s Segment>, End> {
        let last = self.stream_all(schedule, source, seen)?;
        self.judge_over_outages(last, seen)?;
        all_judged(schedule, seen.samples())?;
        Ok(last)
    }

    /// Streams the segments and returns the last one streamed. It ends early where tables have changed or, if the plan
    /// says so, with the first segment that differs.
    fn stream_all<'s>(
        &mut self,
        schedule: &'s [Segment],
        source: &Receiver<Result<Prepared, PrepareError>>,
        seen: &mut Observations,
    ) -> Result<Option<&'s Segment>, End> {
        let rows = schedule.iter().map(Segment::rows);
        self.progress.rows_expected(rows.sum::<usize>() as u64);
        let mut last = None;
        for segment in schedule {
            // Changed tables are not replaced by the next ones, so that they are judged at the end.
            let after = if segment.is_varied() { self.tables_after(seen).map(drop) } else { Ok(()) };
            if let Err(End::Failed { .. }) = after {
                return Ok(last);
            }
            if let Err(end) = after.and_then(|()| self.prepare(segment)) {
                self.findings.attempt.seen_wrong |= !seen.is_right();
                if end.is_answer() && !seen.rows_are_right() {
                    // A board whose rows were wrong is not known to be in the state in which it must carry this out.
                    self.findings.attempt.refused = true;
                    self.judge_over_outages(last, seen)?;
                }
                self.return_to(segment, 0, end)?;
            }
            last = Some(segment);
            self.stream(segment, source, seen)?;
            if self.plan.fail_fast && seen.differences() > 0 {
                return Ok(Some(segment));
            }
        }
        Ok(last)
    }

    /// Judges what came back. If the board goes away meanwhile, it is first brought back to where it was after `last`.
    fn judge_over_outages(&mut self, last: Option<&Segment>, seen: &mut Observations) -> Result<(), End> {
        self.persist(last, |run| {
            let judged = run.judge_what_came(seen);
            run.findings.attempt.seen_wrong |= !seen.is_right();
            judged
        })
    }

    fn identity(&mut self) -> Result<(), End> {
        let error = |cause, finding: Finding| Err(End::error(CheckName::Identity, cause, finding));
        if let Err(UnknownDatapath { id: datapath }) = self.board.capabilities.known_datapath() {
            let known = DATAPATH.id();
            return error(Cause::Refused, Finding::DatapathUnknown { datapath, known });
        }
        if let Err(BoardError::Impossible { capability, value, legal }) = possible(&self.board.capabilities) {
            return error(Cause::Refused, Finding::CapabilityImpossible { capability, value, legal });
        }
        if self.options.require_hardware && self.findings.board.kind != BoardKind::Hardware {
            return error(
                Cause::NothingJudged,
                Finding::HardwareRequired { board: self.findings.board.kind },
            );
        }
        check_fit(&self.plan.tables, &self.plan.kernel, &self.board.capabilities)
            .map_err(|misfit| self.findings.refuse(misfit))?;
        let (name, wire) = (self.board.capabilities.name.clone(), self.board.welcome.version);
        let datapath = datapath_of(&self.plan.tables).id();
        self.findings.checks.passed(CheckName::Identity, Finding::BoardIdentified { name, wire, datapath });
        Ok(())
    }

    fn link(&mut self) -> Result<(), End> {
        let (_, round_trip) = self.board.echo(&[]).during(CheckName::Link)?;
        // The times of a recording are those of a host that also computed between two exchanges.
        if self.findings.board.kind != BoardKind::Replay {
            self.sessions.note_round_trip(round_trip);
        }
        let patterns = patterns(self.plan.seed);
        let bytes: usize = patterns.iter().map(Vec::len).sum();
        for pattern in &patterns {
            let (same, _) = self.board.echo(pattern).during(CheckName::Link)?;
            if !same {
                return Err(End::failed(CheckName::Link, Finding::EchoWrong {}));
            }
        }
        self.sessions.start_afresh(self.board).during(CheckName::Link)?;
        self.findings
            .checks
            .passed(CheckName::Link, Finding::EchoesReturned { bytes, echoes: patterns.len() });
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::channel;

    use halfrow_model::{BitDepth, Equidistant, Geometry, Interpolant, TableSet};

    use super::*;
    use crate::frames::Builtin;
    use crate::link::{Candidate, open};
    use crate::progress::Silent;
    use crate::run::{FrameSource, JUDGED, Part, ScheduledFrame, Timing};

    fn segment(width: usize, frames: u16) -> Segment {
        let geometry = Geometry::new(width, 16, BitDepth::Twelve, 63).unwrap();
        let frame = |number| ScheduledFrame {
            number,
            source: FrameSource::Builtin(Builtin::Noise),
            generation: JUDGED,
            part: Part::Gaps,
        };
        Segment { geometry, timing: Timing::Least, commit: None, frames: (0..frames).map(frame).collect() }
    }

    /// 64 x 16 and twice 96 x 16 samples.
    #[test]
    fn a_run_that_judged_less_than_its_plan_has_no_verdict() {
        let schedule = [segment(64, 1), segment(96, 2)];
        assert!(all_judged(&schedule, 4096).is_ok());
        for judged in [0, 1024, 4095, 4097] {
            let end = all_judged(&schedule, judged);
            assert!(matches!(end, Err(End::Error { cause: Cause::Station, .. })), "{judged}");
        }
    }

    /// Nothing of it is wrong: the board was given no frame, and counts none.
    #[test]
    fn a_run_whose_frames_never_came_does_not_pass() {
        let Candidate { target, kind, link, .. } = open(&"mock".parse().unwrap()).unwrap();
        let geometry = Geometry::centred(64, 16, BitDepth::Twelve).unwrap();
        let tables = TableSet::from_lens(geometry, &Equidistant::from_radius(10.0).unwrap(), None).unwrap();
        let plan = Plan::new(tables, Interpolant::Hermite.into());
        let options = RunOptions::default();
        let mut sessions = Sessions::new(&options, target.clone(), None);
        let mut board = sessions.open(link).unwrap();
        let build = Build::of(&board.capabilities);
        let mut run = Run {
            plan: &plan,
            board: &mut board,
            sessions: &mut sessions,
            generations: plan.generations(&build),
            options: &options,
            progress: &Silent,
            findings: &mut Findings::new(target, kind),
            bursts: 0,
            counters_doubted: false,
        };
        let (_, no_frames) = channel();
        let schedule = plan.schedule(&build);
        let last = run.stream_and_judge(&schedule[..1], &no_frames, &mut Observations::default());
        assert_eq!(last.unwrap_err().finding().as_problem().code, "samples-not-judged");
    }
}
