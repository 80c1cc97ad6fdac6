//! What the steps of a plan do with a board.

use std::error::Error;
use std::path::Path;
use std::time::{Duration, Instant};

use halfrow::board::{Board, OpenOptions, Stop};
use halfrow::link::{self, Candidate, OpenError};
use halfrow::link_test::{self, Figures, LinkTestError};
use halfrow::result::{BoardReport, Finding, FrameTotals, Identity, Outcome, Problem, Suspect};
use halfrow::run::Provenance;
use halfrow::target::{BoardKind, Target};
use halfrow::verdict::{Cause, StoppedBy, Verdict};
use halfrow::words::plain;
use halfrow::{Finished, Progress, Report, RunOptions};
use serde_json::{Value, json};

use super::Ruling;
use super::kept_frame::keep;
use super::kept_report;
use crate::exit::Exit;
use crate::plan::limits::{Limit, Maker, SAMPLES_DIFFERING};
use crate::plan::{DeviceRule, Judging, Plan};
use crate::record::{BoardSeen, Measured, RunCause, StepOutcome, SuspectRecord, judged};
use crate::said::{DIFFERED, Said, Saying};

/// What a try of a step came to.
#[derive(Debug)]
pub(super) struct Try {
    pub(super) outcome: StepOutcome,
    pub(super) cause: RunCause,
    pub(super) exit: Exit,
    pub(super) finding: Said,
    pub(super) remedy: Option<String>,
    pub(super) measurements: Vec<Measured>,
    pub(super) suspects: Vec<SuspectRecord>,
    pub(super) board: Option<BoardSeen>,
    pub(super) evidence: Option<Value>,
    /// Whether the board did something that may be its own fault, whatever the try came to.
    pub(super) is_incriminating: bool,
}

impl Try {
    fn of(cause: Cause, finding: impl Into<Said>) -> Self {
        let finding = finding.into().at_the_station();
        let outcome = match cause.verdict() {
            Verdict::Pass => StepOutcome::Passed,
            Verdict::Fail => StepOutcome::Failed,
            Verdict::Error => StepOutcome::Error,
        };
        Self {
            outcome,
            cause: RunCause::of(cause, &finding.code),
            exit: cause.into(),
            finding,
            remedy: None,
            measurements: Vec::new(),
            suspects: Vec::new(),
            board: None,
            evidence: None,
            is_incriminating: cause == Cause::Different,
        }
    }

    fn error(cause: Cause, error: &(dyn Error + 'static)) -> Self {
        let problem = Problem::of(error);
        let remedy = problem.remedy.clone();
        let made = Self::of(cause, problem);
        Self { remedy: made.finding.scan_again().or(remedy), ..made }
    }

    fn refused(why: impl Into<Said>) -> Self {
        let why = why.into();
        Self { remedy: why.remedy().map(str::to_owned), ..Self::of(Cause::Refused, why) }
    }

    /// Somebody mixed boards up.
    fn mixed_up(why: Said) -> Self {
        Self { cause: RunCause::Operator, ..Self::refused(why) }
    }

    /// Adds these measurements: a PASS that misses a limit becomes what the limit says, and a FAIL that misses one
    /// which blames the station becomes ERROR.
    fn measured(mut self, measurements: Vec<Measured>) -> Self {
        self.is_incriminating |= measurements.iter().any(|one| one.fault() == Some(RunCause::Board));
        let worst = Measured::worst(&measurements).map(|(one, cause)| (one.said(), cause));
        self.measurements = measurements;
        let is_worse = |cause: RunCause| match self.outcome {
            StepOutcome::Passed => true,
            StepOutcome::Failed => cause != RunCause::Board,
            StepOutcome::Error | StepOutcome::Skipped => false,
        };
        let Some((said, cause)) = worst.filter(|(_, cause)| is_worse(*cause)) else { return self };
        self.outcome = if cause == RunCause::Board { StepOutcome::Failed } else { StepOutcome::Error };
        self.exit = cause.exit();
        // What a step says to do about its own finding is no advice about another.
        let remedy = said.remedy().filter(|_| cause != RunCause::Board).map(str::to_owned);
        (self.cause, self.finding, self.remedy) = (cause, said, remedy);
        self
    }
}

/// What all steps of a run share.
pub(super) struct RunContext<'a> {
    pub(super) plan: &'a Plan,
    pub(super) target: &'a Target,
    /// Whether this is the mock in the place of a unit that is known to be bad; the plan's demands on boards do not
    /// apply to it.
    pub(super) is_mock: bool,
    pub(super) seed: u64,
    pub(super) stop: &'a Stop,
    /// Asks the station whether the board may be judged under the serial number; `Err` says who wants the run to end
    /// instead.
    pub(super) rule: &'a dyn Fn(&BoardSeen) -> Result<Ruling, StoppedBy>,
    pub(super) limits: &'a [Limit],
    /// Where wrong frames are kept.
    pub(super) spool: &'a Path,
    /// The board that the run began with.
    pub(super) first: Option<BoardSeen>,
}

impl RunContext<'_> {
    /// Asks the board who it is, and whether the plan may judge it. Nothing is uploaded.
    pub(super) fn identity(&self, within: Duration) -> Try {
        let (kind, seen) = match self.with_board(within, |_, kind, seen| (kind, seen)) {
            Ok(greeted) => greeted,
            Err(result) => return *result,
        };
        let result = self.not_allowed(kind, &seen).unwrap_or_else(|| self.ruled(&seen));
        Try { board: Some(seen), ..result }
    }

    /// Why the plan does not take such a board, if it does not.
    fn not_allowed(&self, kind: BoardKind, seen: &BoardSeen) -> Option<Try> {
        if self.is_mock {
            return None;
        }
        let Plan { production, builds, device, .. } = self.plan;
        if production.require_hardware && kind != BoardKind::Hardware {
            let refused = Try::refused(Saying::HardwareAlone { kind: kind.to_string() });
            // `halfrow verify` ends like this where hardware was required and the board is none.
            Some(Try { exit: Exit::NothingJudged, ..refused })
        } else if !builds.contains(&seen.build) {
            let (build, builds) = (seen.build.clone(), builds.join(", "));
            Some(Try::refused(Saying::BuildNotOfPlan { build, builds }))
        } else if *device == DeviceRule::Required && seen.device.is_none() {
            Some(Try::refused(Saying::DeviceAskedFor))
        } else {
            None
        }
    }

    /// Whether the station lets the device be judged under the serial number.
    fn ruled(&self, seen: &BoardSeen) -> Try {
        let [name, kind, build] = [&seen.name, &seen.kind, &seen.build].map(String::clone);
        let of = |saying| Try::of(Cause::Equal, saying);
        let Some(device) = seen.device.as_ref().filter(|_| self.plan.device != DeviceRule::NotChecked) else {
            return of(Saying::IdentityUnchecked { name, kind, build });
        };
        let device = device.clone();
        match (self.rule)(seen) {
            Ok(Ruling::Known) => of(Saying::DeviceKnown { name, kind, build, device }),
            Ok(Ruling::New) => of(Saying::DeviceNew { name, kind, build, device }),
            Ok(Ruling::Refused { why }) => Try::mixed_up(why),
            Ok(Ruling::Untold { why }) => Try::of(Cause::Station, why),
            Err(by) => Try::of(Cause::Stopped(by), Saying::StoppedBefore),
        }
    }

    /// Tests the link.
    pub(super) fn link(&self, each: Duration, within: Duration) -> Try {
        let tested = self.with_board(within, |board, _, seen| match self.exchanged(&seen) {
            Some(exchanged) => Err(exchanged),
            None => Ok((link_test::run(board, each, self.seed), seen)),
        });
        let (tested, seen) = match tested {
            Ok(Ok(tested)) => tested,
            Ok(Err(exchanged)) => return exchanged,
            Err(result) => return *result,
        };
        let figures = match tested {
            Ok(figures) => figures,
            Err(error) => {
                let (cause, by): (_, &(dyn Error + 'static)) = match &error {
                    LinkTestError::Board(source) | LinkTestError::BrokeOff { source, .. } => {
                        (source.cause(), source)
                    }
                    LinkTestError::PoorLink { source, .. } => (Cause::Station, &**source),
                    LinkTestError::NoFrame(_) => (Cause::Station, &error),
                };
                // A try that met a board which answers wrong is not repeated without a person.
                let is_incriminating = matches!(error, LinkTestError::BrokeOff { .. });
                let found = Try::error(cause, &error);
                let cause = RunCause::of(cause, &Problem::of(by).code);
                return Try { board: Some(seen), cause, is_incriminating, ..found };
            }
        };
        let result = match figures.errors.wrong {
            0 => Try::of(Cause::Equal, Saying::LinkTested { link: figures.link.clone() }),
            wrong => Try::of(Cause::Different, Saying::LinkAnswersWrong { wrong }),
        };
        let evidence = serde_json::to_value(&figures).ok();
        let measured = judged(Maker::Link, &of_link(&figures), self.limits);
        Try { board: Some(seen), evidence, ..result }.measured(measured)
    }

    /// Judges the board.
    /// Wrong frames are kept under the step's number and the try.
    pub(super) fn verify(
        &self,
        judging: &Judging,
        (within, place): (Duration, (u32, u32)),
        progress: &dyn Progress,
    ) -> Try {
        let begun = Instant::now();
        let candidate = match self.candidate() {
            Ok(candidate) => candidate,
            Err(result) => return *result,
        };
        let plan = judging.plan(self.seed);
        let Finished { report, evidence } =
            match halfrow::verify(&plan, candidate, &self.run_options(within), progress) {
                Ok(finished) => finished,
                // The plan does not fit the board, so the board was not judged.
                Err(misfit) => return Try::error(Cause::Refused, &misfit),
            };
        let frames =
            report.frames.iter().map(|frame| (frame.name.as_str(), frame.comparison.differences > 0));
        keep(self.spool, place, &frames.collect::<Vec<_>>(), &evidence);
        let seen = report.board.identity.as_ref().map(|identity| seen(report.board.kind, identity));
        if let Some(exchanged) = seen.as_ref().and_then(|seen| self.exchanged(seen)) {
            return exchanged;
        }
        let measured = judged(Maker::Verify, &of_verify(&report, begun.elapsed()), self.limits);
        let result = Try {
            is_incriminating: is_incriminating(&report),
            remedy: at_the_bench(&report),
            suspects: report.suspects.iter().map(suspect).collect(),
            board: seen,
            evidence: kept_report::kept(self.spool, place, &report),
            ..Try::of(report.cause, found(&report))
        };
        result.measured(measured)
    }

    fn run_options(&self, within: Duration) -> RunOptions {
        let provenance = Provenance {
            arguments: std::env::args_os().map(|one| one.to_string_lossy().into_owned()).collect(),
            files: self.plan.files.clone(),
            // The record has the operator.
            ..Provenance::default()
        };
        RunOptions {
            timeout: Some(within),
            stop: self.stop.clone().wall_limit(Some(within)),
            require_hardware: self.plan.production.require_hardware && !self.is_mock,
            provenance,
            ..RunOptions::default()
        }
    }

    /// The refusal of a board that is not the one with which the run began.
    fn exchanged(&self, seen: &BoardSeen) -> Option<Try> {
        let first = self.first.as_ref().filter(|first| *first != seen)?;
        let name = |board: &BoardSeen| {
            format!("{} of build {}", board.device.as_deref().unwrap_or("unnumbered"), board.build)
        };
        let swapped = Saying::BoardSwapped { first: name(first), now: name(seen) };
        let refused = Try::refused(swapped);
        Some(Try { board: Some(seen.clone()), ..refused })
    }

    fn candidate(&self) -> Result<Candidate, Box<Try>> {
        link::open(self.target).map_err(|error: OpenError| Box::new(Try::error(error.class().into(), &error)))
    }

    /// Does `act` in a session with the board, given what the board says about itself.
    fn with_board<T>(
        &self,
        within: Duration,
        act: impl FnOnce(&mut Board, BoardKind, BoardSeen) -> T,
    ) -> Result<T, Box<Try>> {
        let candidate = self.candidate()?;
        let stop = self.stop.clone().link_limit(Some(within)).wall_limit(Some(within));
        let options = OpenOptions { stop, ..OpenOptions::default() };
        let done = Board::with(candidate.link, &options, |board| {
            let kind = candidate.kind.confirmed_by(board.capabilities().nature);
            let seen = seen(kind, &Identity::of(board.welcome(), board.capabilities()));
            act(board, kind, seen)
        });
        done.map_err(|failed| Box::new(Try::error(failed.error.cause(), &failed.error)))
    }
}

fn seen(kind: BoardKind, identity: &Identity) -> BoardSeen {
    let has_number = identity.serial.bytes().any(|digit| digit != b'0');
    BoardSeen {
        kind: kind.to_string(),
        // A board fills the field of its name up with zeros.
        name: plain(identity.name.trim_end_matches('\0')).into_owned(),
        device: has_number.then(|| identity.serial.clone()),
        build: identity.build.clone(),
    }
}

/// What the judge found. If it broke off, its sentence begins with the samples that differed until then, and other
/// languages build that from the figures.
fn found(report: &Report) -> Said {
    let mut said = Said::from(&report.finding);
    let broke_off = report.verdict() == Verdict::Error && matches!(report.finding, Finding::Problem(_));
    let FrameTotals { frames, differing_frames, samples, differences } = FrameTotals::of(&report.frames);
    if broke_off && differing_frames > 0 {
        let differed = json!({
            "differences": differences,
            "samples": samples,
            "differing_frames": differing_frames,
            "frames": frames,
        });
        said.parameters.insert(DIFFERED.to_owned(), differed);
    }
    said
}

/// Whether the report holds anything against the board, also if it broke off before that was looked into.
fn is_incriminating(report: &Report) -> bool {
    report.cause == Cause::Different
        || FrameTotals::of(&report.frames).differences > 0
        || !report.suspects.is_empty()
        || report.checks.iter().any(|check| check.outcome == Outcome::Failed)
}

/// What the operator does: for a wrong board what a technician would do, otherwise what the finding asks for.
fn at_the_bench(report: &Report) -> Option<String> {
    let held = Said::from(&report.finding).at_the_station().scan_again();
    held.or_else(|| report.technician()).or_else(|| report.remedy())
}

fn suspect(suspect: &Suspect) -> SuspectRecord {
    SuspectRecord {
        part: suspect.part().to_owned(),
        place: suspect.place(),
        explained: suspect.explained,
        technician: suspect.technician(),
    }
}

fn of_link(figures: &Figures) -> [(&'static str, Option<f64>); 5] {
    let together = &figures.together;
    let slower = together.out.bytes_per_second.zip(together.back.bytes_per_second);
    // A wire on a virtual clock has no round trip.
    let trip = Some(figures.round_trips.median_us).filter(|_| figures.round_trips.most_us > 0.0);
    [
        ("link.round_trip", trip),
        ("link.to_board", figures.to_board.out.bytes_per_second),
        ("link.to_host", figures.to_host.back.bytes_per_second),
        ("link.together", slower.map(|(out, back)| out.min(back))),
        ("link.retries", Some(figures.errors.retries as f64)),
    ]
}

fn of_verify(report: &Report, took: Duration) -> [(&'static str, Option<f64>); 5] {
    let clocks = report.latency.map(|latency| f64::from(latency.most));
    let BoardReport { identity, .. } = &report.board;
    let hertz = identity.as_ref().map(|identity| f64::from(identity.clock_hz)).filter(|hertz| *hertz > 0.0);
    [
        ("latency.clocks", clocks),
        ("latency.microseconds", clocks.zip(hertz).map(|(clocks, hertz)| 1e6 * clocks / hertz)),
        ("verify.retries", Some(report.link.retries as f64)),
        ("verify.seconds", Some(took.as_secs_f64())),
        (SAMPLES_DIFFERING, Some(FrameTotals::of(&report.frames).differences as f64)),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_kept_of_a_name_can_be_shown_and_stored() {
        let named = |name: &str| {
            let says = serde_json::json!({
                "name": name, "serial": "0", "build": "0", "protocol": 1, "datapath": 1, "max_width": 1, "max_height": 1,
                "depths": [8], "taps": 7, "latency": 1, "ring": 1, "least_blanking": 1, "table_banks": 1, "row_banks_in": 1,
                "row_banks_out": 1, "clock_hz": 0
            });
            seen(BoardKind::Mock, &serde_json::from_value::<Identity>(says).unwrap()).name
        };
        assert_eq!(named("shelf board\0\0\0"), "shelf board");
        assert_eq!(named("a\0b\u{7}"), "a\\u{0}b\\u{7}");
    }
}
