//! The last word on a run: its verdict, once what was asked for is written.

use super::findings::chain;
use crate::report::{Evidence, Report, ReportError, ReportFolder};
use crate::verdict::{Cause, Verdict};

/// A run that is over.
#[derive(Debug)]
pub struct Finished {
    /// What it found.
    pub report: Report,
    /// Frames for pictures.
    pub evidence: Vec<Evidence>,
}

impl Finished {
    /// Writes the report into its folder. If that fails, it is lost as by [`Self::lose`].
    ///
    /// # Errors
    /// [`ReportError`], for whoever wants to say more of it. The verdict in [`Self::report`] is the last word either way.
    pub fn commit(&mut self, folder: ReportFolder) -> Result<(), ReportError> {
        let written = folder.commit(&self.report, &self.evidence);
        written.inspect_err(|error| {
            let remedy = match error {
                ReportError::Exists { .. } => {
                    "Name another place for the report, or allow it to be overwritten, then run again."
                }
                _ => "Free some space or choose another place for the report, then run again.",
            };
            self.lose(&format!("the report could not be written: {}", chain(error)), remedy);
        })
    }

    /// Takes note that the recording of the run could not be finished, as by [`Self::lose`].
    pub fn lose_recording(&mut self, why: &dyn std::error::Error) -> bool {
        self.lose(
            &format!("the recording could not be written: {}", chain(why)),
            "Free some space or choose another place for the recording, then run again.",
        )
    }

    /// Takes note that something which was asked for is not there, and returns whether that changes the verdict: a PASS that
    /// lacks it is ERROR. Any other verdict stands, for it must not be lost as well.
    pub fn lose(&mut self, what: &str, remedy: &str) -> bool {
        let report = &mut self.report;
        if report.verdict != Verdict::Pass {
            return false;
        }
        report.headline = what.to_owned();
        report.verdict = Verdict::Error;
        report.cause = Cause::Station;
        report.remedy = Some(remedy.to_owned());
        true
    }
}
