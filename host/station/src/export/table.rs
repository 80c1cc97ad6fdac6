//! Runs as CSV (RFC 4180): a line for each measurement, with its step and its run.

use std::borrow::Cow;
use std::io::Write;

use super::ExportError;
use crate::record::{Measured, Record, StepRecord};

/// The columns: those of the run, of the step and of the measurement. A value that does not exist is empty.
pub const COLUMNS: [&str; 37] = [
    "run",
    "product",
    "serial",
    "variant",
    "plan",
    "version",
    "plan_sha256",
    "station",
    "lane",
    "operator",
    "target",
    "board_kind",
    "device",
    "build",
    "started_ms",
    "ended_ms",
    "seconds",
    "verdict",
    "cause",
    "exit_code",
    "headline",
    "production",
    "marginal",
    "seq",
    "attempt",
    "step",
    "step_outcome",
    "step_started_ms",
    "step_ended_ms",
    "detail",
    "measurement",
    "value",
    "unit",
    "low",
    "high",
    "blames",
    "outcome",
];

/// A table that is being written.
#[derive(Debug)]
pub struct Table<W: Write>(W);

impl<W: Write> Table<W> {
    /// A table with its header.
    ///
    /// # Errors
    /// [`ExportError::Write`]
    pub fn begin(to: W) -> Result<Self, ExportError> {
        let mut table = Self(to);
        table.line(COLUMNS)?;
        Ok(table)
    }

    /// The continuation of a table whose header was written already.
    pub fn further(to: W) -> Self {
        Self(to)
    }

    /// Writes the lines of a run.
    ///
    /// # Errors
    /// [`ExportError::Write`]
    pub fn add(&mut self, record: &Record) -> Result<(), ExportError> {
        let run = run(record);
        for step in &record.steps {
            let step_columns = step_columns(step);
            self.lines(&run, &step_columns, &step.measurements)?;
        }
        // Those of the run as a whole have the step 0, as in the store.
        let whole = ["0", "1", "run", "", "", "", ""].map(str::to_owned);
        if record.measurements.is_empty() && !record.steps.is_empty() {
            return Ok(());
        }
        self.lines(&run, &whole, &record.measurements)
    }

    /// Returns what it was written to.
    pub fn end(self) -> W {
        self.0
    }

    fn lines(&mut self, run: &[String], step: &[String], measured: &[Measured]) -> Result<(), ExportError> {
        let none = [const { String::new() }; 7];
        let mut line = |measurement: &[String]| {
            let cells = run.iter().chain(step).chain(measurement);
            self.line(cells.map(String::as_str))
        };
        if measured.is_empty() {
            return line(&none);
        }
        measured.iter().try_for_each(|one| line(&measurement(one)))
    }

    fn line<'a>(&mut self, cells: impl IntoIterator<Item = &'a str>) -> Result<(), ExportError> {
        let cells: Vec<_> = cells.into_iter().map(cell).collect();
        write!(self.0, "{}\r\n", cells.join(",")).map_err(ExportError::Write)
    }
}

/// A cell, in quotes where it needs them.
fn cell(text: &str) -> Cow<'_, str> {
    if text.contains(['"', ',', '\r', '\n']) {
        return Cow::Owned(format!("\"{}\"", text.replace('"', "\"\"")));
    }
    Cow::Borrowed(text)
}

fn run(record: &Record) -> [String; 23] {
    let Record { run, plan, conclusion: ended, .. } = record;
    let board = |part: fn(&crate::record::BoardSeen) -> Option<&String>| {
        record.board.as_ref().and_then(part).cloned().unwrap_or_default()
    };
    [
        run.id.clone(),
        run.product.clone(),
        run.serial.clone(),
        run.variant.clone(),
        plan.name.clone(),
        plan.version.clone(),
        plan.sha256.clone(),
        run.station.clone(),
        run.lane.clone(),
        run.operator.clone(),
        run.target.clone(),
        board(|board| Some(&board.kind)),
        board(|board| board.device.as_ref()),
        board(|board| Some(&board.build)),
        run.started_ms.to_string(),
        record.ended_ms.to_string(),
        number(record.seconds),
        ended.verdict.to_string(),
        ended.cause.name().to_owned(),
        ended.exit_code.to_string(),
        ended.headline.clone(),
        record.production.to_string(),
        record.marginal.to_string(),
    ]
}

fn step_columns(step: &StepRecord) -> [String; 7] {
    [
        step.seq.to_string(),
        step.attempt.to_string(),
        step.name.clone(),
        step.outcome.name().to_owned(),
        step.started_ms.to_string(),
        step.ended_ms.to_string(),
        step.detail.clone(),
    ]
}

fn measurement(one: &Measured) -> [String; 7] {
    [
        one.name.clone(),
        number(one.value),
        one.unit.clone(),
        number(one.low),
        number(one.high),
        one.blames.name().to_owned(),
        one.outcome.name().to_owned(),
    ]
}

/// The shortest digits that read back as this number.
fn number(value: Option<f64>) -> String {
    value.map_or_else(String::new, |value| value.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::tests::{pass, step};
    use crate::record::{RunCause, StepOutcome};

    /// Such as a run whose lane died before its first step: it was a run all the same.
    #[test]
    fn a_run_of_which_nothing_was_measured_has_a_line() {
        let lines = |steps: Vec<StepRecord>| {
            let mut table = Table::further(Vec::new());
            table.add(&Record { steps, measurements: Vec::new(), ..pass() }).unwrap();
            let text = String::from_utf8(table.end()).unwrap();
            text.lines().map(|line| line.split(',').nth(25).unwrap().to_owned()).collect::<Vec<_>>()
        };
        assert_eq!(lines(Vec::new()), ["run"]);
        assert_eq!(lines(vec![step(1, 1, StepOutcome::Error, RunCause::Crash)]), ["step 1"]);
    }
}
