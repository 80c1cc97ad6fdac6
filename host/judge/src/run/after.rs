//! What is judged when the last row has come back.

use super::findings::End;
use super::judge::Seen;
use super::plan::{Generation, JUDGED};
use super::steps::Run;
use crate::board::{Bank, Status};
use crate::diagnosis::{self, Case, Uploaded};
use crate::report::Suspect;

impl Run<'_> {
    /// Judges what was seen, the tables and the counters. The first that is wrong ends the run; what else is wrong
    /// stands among the checks.
    pub(super) fn judge(&mut self) -> Result<(), End> {
        let after = self.tables_after();
        let status = self.board.status(false).map_err(|error| End::board("counters", &error))?;
        self.findings.note_status(&status);
        let frames = self.frames(after.as_ref().err());
        // Counters are of rows that came back as they should; a run that ends early leaves rows inside.
        let counters =
            frames.is_ok().then(|| counters(&status, self.findings.rows_counted, &self.findings.seen));
        let latency = latency(&self.findings.seen);
        let mut ends = Vec::new();
        let results = [("frames", Some(frames)), ("latency", Some(latency)), ("tables after", Some(after))];
        for (check, result) in results.into_iter().chain([("counters", counters)]) {
            match result {
                Some(Ok(detail)) => self.findings.passed(check, detail),
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
    fn tables_after(&mut self) -> Result<String, End> {
        let judged = self.generations.iter().find(|generation| generation.number == JUDGED).cloned();
        let Some(judged) = judged.filter(|_| self.streamed_judged()) else {
            return Ok("no frame came to use them".to_owned());
        };
        let checked = self.check_read_back("tables after", Bank::Active, &judged);
        checked.map(|_| "the tables are still what was uploaded".to_owned()).map_err(|end| match end {
            End::Failed { check, headline, remedy, suspects } => {
                let headline = format!("the tables changed during the run: {headline}");
                End::Failed { check, headline, remedy, suspects }
            }
            end => end,
        })
    }

    /// Whether the judged tables were ever used; a run that ends with its first frame does not come to that.
    fn streamed_judged(&self) -> bool {
        self.findings.seen.frames.iter().any(|frame| frame.generation == JUDGED)
    }

    fn frames(&self, tables_after: Option<&End>) -> Result<String, End> {
        let seen = &self.findings.seen;
        if let Some(sentence) = &seen.wrong_generation {
            let remedy = "The board uses stale tables: check when its bank switch takes effect.";
            return Err(End::failed("frames", sentence.clone(), remedy));
        }
        let differing = seen.frames.iter().filter(|frame| frame.comparison.differences > 0).count();
        let (samples, frames) = (seen.samples(), seen.frames.len());
        if differing == 0 {
            return Ok(format!("{frames} frames, {samples} samples, all equal"));
        }
        // Tables that changed explain the differences better than their pattern does.
        if let Some(End::Failed { headline, remedy, suspects, .. }) = tables_after {
            let (headline, remedy, suspects) = (headline.clone(), remedy.clone(), suspects.clone());
            return Err(End::Failed { check: "frames", headline, remedy, suspects });
        }
        let suspects = self.diagnose();
        let wrong = seen.differences();
        let found = format!("{wrong} of {samples} samples differ, in {differing} of {frames} frames");
        let (suspicion, remedy) = match suspects.first() {
            Some(suspect) => (format!("the suspect is {}", suspect.place), suspect.next_step.clone()),
            None => (
                "no single defect that is known explains them".to_owned(),
                "Make a report and look at the difference maps.".to_owned(),
            ),
        };
        let headline = format!("{found}; {suspicion}");
        Err(End::Failed { check: "frames", headline, remedy, suspects })
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

fn latency(seen: &Seen) -> Result<String, End> {
    let Some(sentence) = &seen.wrong_latency else {
        let clocks = seen.latency.map_or(0, |latency| latency.claimed);
        return Ok(format!("every row takes {clocks} pixel clocks, first and last sample"));
    };
    let wrong = seen.latency.map_or(0, |latency| latency.wrong_rows);
    Err(End::failed(
        "latency",
        format!("{wrong} rows have another latency than the board claims: {sentence}"),
        "Check the depth of the pipeline behind the line memory, and the L that the capabilities advertise.",
    ))
}

fn counters(status: &Status, rows: usize, seen: &Seen) -> Result<String, End> {
    let expected = u32::try_from(rows).unwrap_or(u32::MAX);
    let failed = |what: String| {
        Err(End::failed(
            "counters",
            what,
            "Check the board's counters and its row player; the samples themselves were right.",
        ))
    };
    if (status.rows_in, status.rows_out) != (expected, expected) {
        return failed(format!(
            "{expected} rows went through the board, and it counts {} in and {} out",
            status.rows_in, status.rows_out
        ));
    }
    if status.samples_over > 0 {
        return failed(format!(
            "the board counts {} samples above the depth, and none was sent",
            status.samples_over
        ));
    }
    if let Some(latency) = seen.latency
        && (status.least_latency, status.most_latency) != (latency.least, latency.most)
    {
        return failed(format!(
            "the rows name latencies of {} to {} pixel clocks, and the board's counters {} to {}",
            latency.least, latency.most, status.least_latency, status.most_latency
        ));
    }
    Ok(format!("{rows} rows in, {rows} rows out"))
}
