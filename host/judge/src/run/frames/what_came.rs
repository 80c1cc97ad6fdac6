//! What is judged when the last row has come back. The counters have a module of their own.

use super::counters::{counters, leaves_counters_out};
use super::entry::WrongEntry;
use super::observations::Observations;
use crate::board::Bank;
use crate::diagnosis::{self, Case};
use crate::result::{Account, CheckName, Defect, Finding, Lead, Suspect};
use crate::run::findings::{During, End, Findings};
use crate::run::plan::DECOY;
use crate::run::steps::Run;

impl Run<'_> {
    /// Judges what was seen, the tables and the counters. The first fault ends the run; further faults are only listed
    /// among the checks.
    pub(crate) fn judge_what_came(&mut self, seen: &mut Observations) -> Result<(), End> {
        let after = self.tables_after(seen);
        self.findings.checks.lap(CheckName::TablesAfter);
        let (status, answered) = self.board.status_and_answered().during(CheckName::Counters)?;
        self.sessions.note_damaged(status.damaged());
        self.findings.checks.lap(CheckName::Counters);
        self.unless_misconduct(CheckName::Frames, Ok(()))?;
        let frames = self.frames(seen, after.as_ref().err());
        let Findings { checks, attempt, .. } = &mut *self.findings;
        checks.lap(CheckName::Frames);
        // Counters are only right if all rows came back right: a run that ends early leaves rows inside.
        let are_judged = frames.is_ok() && !attempt.refused;
        let counters = are_judged.then(|| counters(self.board, (&status, answered), seen, attempt));
        attempt.leaves_counters_out = leaves_counters_out(self.board, &status);
        let mut ends = Vec::new();
        let results = [
            (CheckName::Frames, Some(frames)),
            (CheckName::Latency, Some(latency(seen))),
            (CheckName::TablesAfter, Some(after)),
            (CheckName::Counters, counters),
        ];
        for (check, result) in results {
            match result {
                Some(Ok(unused @ Finding::TablesUnused {})) => checks.skipped(check, unused),
                Some(Ok(finding)) => checks.passed(check, finding),
                Some(Err(end)) => ends.push(end),
                None => {}
            }
        }
        let mut ends = ends.into_iter();
        let first = ends.next();
        ends.for_each(|end| checks.ended(&end));
        first.map_or(Ok(()), Err)
    }

    /// The tables of the last frame must still be what was uploaded; a run that ends with its first frame has not used
    /// those to judge with. Tables that once read back wrong stay wrong, even if they read back right later.
    pub(crate) fn tables_after(&mut self, seen: &mut Observations) -> Result<Finding, End> {
        if let Some(changed) = &seen.changed_tables {
            return Err(changed.clone());
        }
        let after = self.read_back_after(seen);
        if let Err(changed @ End::Failed { .. }) = &after {
            seen.changed_tables = Some(changed.clone());
        }
        after
    }

    fn read_back_after(&mut self, seen: &Observations) -> Result<Finding, End> {
        let last = seen.frames.last().map_or(DECOY, |frame| frame.generation);
        let last = self.generation(last);
        let Some(last) = last.filter(|generation| generation.number != DECOY) else {
            return Ok(Finding::TablesUnused {});
        };
        let checked = self.check_read_back(CheckName::TablesAfter, Bank::Active, &last);
        let changed = |end: End| end.failed_as(|found| Finding::TablesChanged { found });
        checked.map(|_| Finding::TablesUnchanged {}).map_err(changed)
    }

    fn frames(&self, seen: &Observations, tables_after: Option<&End>) -> Result<Finding, End> {
        if let Some(finding) = &seen.wrong_generation {
            return Err(End::failed(CheckName::Frames, finding.clone()));
        }
        let differing = seen.differing_frames();
        let (samples, frames) = (seen.samples(), seen.frames.len());
        if let Some(wrong) = seen.wrong_entry {
            let is_every_row = seen.rows_with_entry == wrong.rows;
            return Err(changed_on_entry(wrong, differing > 0, is_every_row));
        }
        if differing == 0 {
            return Ok(Finding::FramesEqual { frames, samples });
        }
        // Tables that changed explain the differences better than their pattern does.
        if let Some(End::Failed { finding, suspects, .. }) = tables_after {
            return Err(End::suspecting(CheckName::Frames, finding.clone(), suspects.clone()));
        }
        let suspects = self.diagnose(seen);
        let Lead { suspect, others, short } = Lead::of(&suspects);
        let finding = Finding::SamplesDiffer {
            differences: seen.differences(),
            samples,
            differing_frames: differing,
            frames,
            tried: None,
            suspect,
            others,
            short,
        };
        Err(End::suspecting(CheckName::Frames, finding, suspects))
    }

    fn diagnose(&self, seen: &Observations) -> Vec<Suspect> {
        diagnosis::diagnose(&Case {
            uploaded: &self.generations,
            ring: usize::from(self.board.capabilities.ring),
            frames: &seen.frames,
            evidence: seen.evidence.all(),
        })
    }
}

/// Samples that changed on their way in explain whatever came out. But where everything that came out is right and the CRC of
/// every row is wrong, no flipped bit is believed: a CRC unit that begins with a wrong bit looks like one in the first
/// two samples.
fn changed_on_entry(wrong: WrongEntry, differs: bool, is_every_row: bool) -> End {
    let WrongEntry { rows, row, frame, flipped } = wrong;
    if !differs && (flipped.is_none() || is_every_row) {
        return End::failed(CheckName::Frames, Finding::EntryMiscounted { rows, row, frame });
    }
    let defect = Defect::RowsChangedOnEntry { rows, first: row, frame, flipped };
    let suspects = vec![Suspect { defect, account: Account::Nothing, explained: 1.0 }];
    End::suspecting(CheckName::Frames, wrong.finding(), suspects)
}

fn latency(seen: &Observations) -> Result<Finding, End> {
    let Some(first) = &seen.wrong_latency else {
        let clocks = seen.latency.map_or(0, |latency| latency.claimed);
        return Ok(Finding::LatencyRight { clocks });
    };
    let (rows, of_rows) = seen.latency.map_or((0, 0), |latency| (latency.wrong_rows, latency.rows));
    Err(End::failed(CheckName::Latency, first.finding(rows, of_rows)))
}
