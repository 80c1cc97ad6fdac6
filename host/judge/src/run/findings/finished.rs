//! The final verdict of a run, which also depends on whether what was asked for could be written.

use std::path::Path;

use crate::link::Lost;
use crate::report::{ReportError, ReportFolder};
use crate::result::{Evidence, Problem, Report};
use crate::verdict::{Cause, Verdict};

/// The recording that was asked for could not be written, or not as a whole.
pub const RECORDING_LOST: &str = "recording-lost";
/// The report that was asked for could not be written.
pub const REPORT_LOST: &str = "report-lost";

/// A run that is over.
#[derive(Debug)]
pub struct Finished {
    /// What it found.
    pub report: Report,
    /// Frames for pictures.
    pub evidence: Vec<Evidence>,
}

impl Finished {
    /// Writes the report into its folder. A PASS whose report cannot be written becomes an ERROR.
    ///
    /// # Errors
    /// [`Lack`] when it cannot be written.
    pub fn commit(&mut self, folder: ReportFolder) -> Result<(), Lack> {
        let earlier = folder.earlier().map(Path::to_path_buf);
        let Err(error) = folder.commit(&self.report, &self.evidence) else { return Ok(()) };
        let why = Problem::of(&error);
        let remedy = match error {
            ReportError::Exists { .. } => {
                "Name another place for the report, or allow it to be overwritten, then run again."
            }
            ReportError::Prepare { .. } | ReportError::Write { .. } | ReportError::Place { .. } => {
                "See that its folder is there and has space, or choose another place for the report, then run again."
            }
            _ => why.remedy.as_deref().unwrap_or("Run again."),
        }
        .to_owned();
        let left = earlier.map_or_else(String::new, |path| {
            format!(", and {} still holds that of an earlier run", path.display())
        });
        let what = Problem::new(REPORT_LOST, format!("the report could not be written{left}"));
        Err(self.lose(Problem { causes: why.chain(), ..what }, remedy))
    }

    /// What is missing if the run's recording could not be finished, as `lost` says; a PASS then becomes an ERROR.
    pub fn note_recording(&mut self, lost: &Lost) -> Option<Lack> {
        let why = lost.get()?;
        let what = Problem::new(RECORDING_LOST, "the recording could not be written");
        // Its sentence already says what its own causes say.
        let causes = vec![Problem { causes: Vec::new(), ..Problem::of(why) }];
        let remedy = "See that its folder is there and has space, or choose another place for the recording, then run again.";
        Some(self.lose(Problem { causes, ..what }, remedy.to_owned()))
    }

    /// Notes that something that was asked for is missing. A PASS without it becomes an ERROR. Any other verdict stands,
    /// so that it is not lost too.
    fn lose(&mut self, what: Problem, remedy: String) -> Lack {
        let report = &mut self.report;
        let what = Box::new(Problem { remedy: Some(remedy), ..what });
        if report.verdict() != Verdict::Pass {
            report.lacks.push(Problem::clone(&what));
            return Lack { what, is_told: false };
        }
        report.finding = Problem::clone(&what).into();
        report.cause = Cause::Station;
        (report.not_exercised, report.coverage) = (Vec::new(), None);
        Lack { what, is_told: true }
    }
}

/// What a run lacks that was asked for.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{what}")]
pub struct Lack {
    /// What, and why.
    pub what: Box<Problem>,
    /// Whether the report says it, as its finding. Otherwise the verdict stands, and the caller must say what is missing.
    pub is_told: bool,
}
