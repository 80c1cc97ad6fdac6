//! What is judged when the last row has come back.

use super::findings::End;
use super::judge::Seen;
use super::plan::{Generation, JUDGED};
use super::steps::Run;
use crate::board::{Bank, Status};
use crate::diagnosis::{self, Case, Uploaded};
use crate::result::{CheckName, Finding, LatencyReport, Suspect};

impl Run<'_> {
    /// Judges what was seen, the tables and the counters. The first that is wrong ends the run; what else is wrong
    /// stands among the checks.
    pub(super) fn judge(&mut self) -> Result<(), End> {
        let after = self.tables_after();
        self.findings.lap(CheckName::TablesAfter);
        let status = self.board.status(false).map_err(|error| End::board(CheckName::Counters, &error))?;
        self.findings.note_status(&status);
        self.findings.lap(CheckName::Counters);
        let frames = self.frames(after.as_ref().err());
        self.findings.lap(CheckName::Frames);
        // Counters are of rows that came back as they should; a run that ends early leaves rows inside.
        let counters =
            frames.is_ok().then(|| counters(&status, self.findings.rows_counted, &self.findings.seen));
        let latency = latency(&self.findings.seen);
        let mut ends = Vec::new();
        let results = [
            (CheckName::Frames, Some(frames)),
            (CheckName::Latency, Some(latency)),
            (CheckName::TablesAfter, Some(after)),
            (CheckName::Counters, counters),
        ];
        for (check, result) in results {
            match result {
                Some(Ok(finding)) => self.findings.passed(check, finding),
                Some(Err(end)) => ends.push(end),
                None => {}
            }
        }
        let mut ends = ends.into_iter();
        let first = ends.next();
        self.findings.also_wrong(ends);
        first.map_or(Ok(()), Err)
    }

    /// The tables must still be what was uploaded.
    fn tables_after(&mut self) -> Result<Finding, End> {
        let judged = self.generations.iter().find(|generation| generation.number == JUDGED).cloned();
        let Some(judged) = judged.filter(|_| self.streamed_judged()) else {
            return Ok(Finding::TablesUnused {});
        };
        let checked = self.check_read_back(CheckName::TablesAfter, Bank::Active, &judged);
        checked.map(|_| Finding::TablesUnchanged {}).map_err(|end| match end {
            End::Failed { check, finding, suspects } => {
                let finding = Finding::TablesChanged { found: Box::new(finding) };
                End::Failed { check, finding, suspects }
            }
            end => end,
        })
    }

    /// Whether the judged tables were ever used; a run that ends with its first frame does not come to that.
    fn streamed_judged(&self) -> bool {
        self.findings.seen.frames.iter().any(|frame| frame.generation == JUDGED)
    }

    fn frames(&self, tables_after: Option<&End>) -> Result<Finding, End> {
        let seen = &self.findings.seen;
        if let Some(finding) = &seen.wrong_generation {
            return Err(End::failed(CheckName::Frames, finding.clone()));
        }
        let differing = seen.frames.iter().filter(|frame| frame.comparison.differences > 0).count();
        let (samples, frames) = (seen.samples(), seen.frames.len());
        if differing == 0 {
            return Ok(Finding::FramesEqual { frames, samples });
        }
        // Tables that changed explain the differences better than their pattern does.
        if let Some(End::Failed { finding, suspects, .. }) = tables_after {
            let (finding, suspects) = (finding.clone(), suspects.clone());
            return Err(End::Failed { check: CheckName::Frames, finding, suspects });
        }
        let suspects = self.diagnose();
        let finding = Finding::SamplesDiffer {
            differences: seen.differences(),
            samples,
            differing_frames: differing,
            frames,
            suspect: suspects.first().map(|suspect| Box::new(suspect.defect.clone())),
        };
        Err(End::Failed { check: CheckName::Frames, finding, suspects })
    }

    fn diagnose(&self) -> Vec<Suspect> {
        let uploaded: Vec<_> = self
            .generations
            .iter()
            .map(|Generation { number, tables, kernel }| Uploaded { generation: *number, tables, kernel })
            .collect();
        diagnosis::diagnose(&Case {
            uploaded: &uploaded,
            ring: usize::from(self.board.capabilities.ring),
            frames: &self.findings.seen.frames,
            evidence: &self.findings.seen.evidence,
        })
    }
}

fn latency(seen: &Seen) -> Result<Finding, End> {
    let Some(first) = &seen.wrong_latency else {
        let clocks = seen.latency.map_or(0, |latency| latency.claimed);
        return Ok(Finding::LatencyRight { clocks });
    };
    let rows = seen.latency.map_or(0, |latency| latency.wrong_rows);
    Err(End::failed(CheckName::Latency, first.finding(rows)))
}

fn counters(status: &Status, rows: usize, seen: &Seen) -> Result<Finding, End> {
    let expected = u32::try_from(rows).unwrap_or(u32::MAX);
    let failed = |finding| Err(End::failed(CheckName::Counters, finding));
    let Status { rows_in, rows_out, samples_over, .. } = *status;
    if (rows_in, rows_out) != (expected, expected) {
        return failed(Finding::RowsMiscounted { rows: expected, rows_in, rows_out });
    }
    if samples_over > 0 {
        return failed(Finding::SamplesMiscounted { samples_over });
    }
    let (counted_least, counted_most) = (status.least_latency, status.most_latency);
    if let Some(latency) = seen.latency
        && (counted_least, counted_most) != (latency.least, latency.most)
    {
        let LatencyReport { least, most, .. } = latency;
        return failed(Finding::LatencyMiscounted { least, most, counted_least, counted_most });
    }
    Ok(Finding::CountersRight { rows })
}
