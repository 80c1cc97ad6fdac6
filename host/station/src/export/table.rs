//! Runs as CSV (RFC 4180): a line for each measurement, with its step and its run.

use std::borrow::Cow;
use std::io::Write;

use super::ExportError;
use crate::record::{BoardSeen, Measured, Record, StepRecord};

/// A column of `T`: its name, and its cell. A value that does not exist is empty.
type Column<T> = (&'static str, fn(&T) -> String);

/// The columns of the run, which come first.
const OF_RUN: [Column<Record>; 23] = [
    ("run", |of| of.run.id.clone()),
    ("product", |of| of.run.product.clone()),
    ("serial", |of| of.run.serial.clone()),
    ("variant", |of| of.run.variant.clone()),
    ("plan", |of| of.plan.name.clone()),
    ("version", |of| of.plan.version.clone()),
    ("plan_sha256", |of| of.plan.sha256.clone()),
    ("station", |of| of.run.station.clone()),
    ("lane", |of| of.run.lane.clone()),
    ("operator", |of| of.run.operator.clone()),
    ("target", |of| of.run.target.clone()),
    ("board_kind", |of| of_board(of, |board| Some(&board.kind))),
    ("device", |of| of_board(of, |board| board.device.as_ref())),
    ("build", |of| of_board(of, |board| Some(&board.build))),
    ("started_ms", |of| of.run.started_ms.to_string()),
    ("ended_ms", |of| of.ended_ms.to_string()),
    ("seconds", |of| number(of.seconds)),
    ("verdict", |of| of.conclusion.verdict.to_string()),
    ("cause", |of| of.conclusion.cause.to_string()),
    ("exit_code", |of| of.conclusion.exit_code.to_string()),
    ("headline", |of| of.conclusion.headline.clone()),
    ("production", |of| of.production.to_string()),
    ("marginal", |of| of.marginal.to_string()),
];

/// Those of the step, which follow.
const OF_STEP: [Column<StepRecord>; 7] = [
    ("seq", |of| of.seq.to_string()),
    ("attempt", |of| of.attempt.to_string()),
    ("step", |of| of.name.clone()),
    ("step_outcome", |of| of.outcome.to_string()),
    ("step_started_ms", |of| of.started_ms.to_string()),
    ("step_ended_ms", |of| of.ended_ms.to_string()),
    ("detail", |of| of.detail.clone()),
];

/// Those of the measurement, which come last.
const OF_MEASUREMENT: [Column<Measured>; 7] = [
    ("measurement", |of| of.name.clone()),
    ("value", |of| number(of.value)),
    ("unit", |of| of.unit.clone()),
    ("low", |of| number(of.low)),
    ("high", |of| number(of.high)),
    ("blames", |of| of.blames.to_string()),
    ("outcome", |of| of.outcome.to_string()),
];

/// Further ones of the run, at the end: whoever reads by place finds the others where they were.
const FURTHER: [Column<Record>; 2] = [
    ("program", |of| of.program.clone()),
    ("code", |of| of.conclusion.finding.as_ref().map(|said| said.code.clone()).unwrap_or_default()),
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
        let (run, step, measured) = (OF_RUN.map(name), OF_STEP.map(name), OF_MEASUREMENT.map(name));
        table.line(run.into_iter().chain(step).chain(measured).chain(FURTHER.map(name)))?;
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
        let run = (&OF_RUN.map(|(_, cell)| cell(record))[..], &FURTHER.map(|(_, cell)| cell(record))[..]);
        for step in &record.steps {
            self.lines(run, &OF_STEP.map(|(_, cell)| cell(step)), &step.measurements)?;
        }
        // Those of the run as a whole have the step 0, as in the store.
        let whole: [&str; OF_STEP.len()] = ["0", "1", "run", "", "", "", ""];
        if record.measurements.is_empty() && !record.steps.is_empty() {
            return Ok(());
        }
        self.lines(run, &whole.map(str::to_owned), &record.measurements)
    }

    /// Returns what it was written to.
    pub fn end(self) -> W {
        self.0
    }

    fn lines(
        &mut self,
        (run, further): (&[String], &[String]),
        step: &[String],
        measured: &[Measured],
    ) -> Result<(), ExportError> {
        let mut line = |measurement: &[String]| {
            let cells = run.iter().chain(step).chain(measurement).chain(further);
            self.line(cells.map(String::as_str))
        };
        if measured.is_empty() {
            return line(&OF_MEASUREMENT.map(|_| String::new()));
        }
        measured.iter().try_for_each(|one| line(&OF_MEASUREMENT.map(|(_, cell)| cell(one))))
    }

    fn line<'a>(&mut self, cells: impl IntoIterator<Item = &'a str>) -> Result<(), ExportError> {
        let cells: Vec<_> = cells.into_iter().map(cell).collect();
        write!(self.0, "{}\r\n", cells.join(",")).map_err(ExportError::Write)
    }
}

const fn name<T>((name, _): Column<T>) -> &'static str {
    name
}

/// A cell, in quotes where it needs them.
fn cell(text: &str) -> Cow<'_, str> {
    if text.contains(['"', ',', '\r', '\n']) {
        return Cow::Owned(format!("\"{}\"", text.replace('"', "\"\"")));
    }
    Cow::Borrowed(text)
}

fn of_board(record: &Record, part: fn(&BoardSeen) -> Option<&String>) -> String {
    record.board.as_ref().and_then(part).cloned().unwrap_or_default()
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
