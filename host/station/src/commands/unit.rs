//! `halfrow-station unit`

use clap::Args;
use halfrow::Verdict;
use halfrow::words::plain_lines;

use super::Failure;
use super::history::verdict;
use super::looking::{Results, either, time};
use crate::exit::Exit;
use crate::history::mismatch::{Bound, Mismatch};
use crate::history::unit::{Unit, UnitRun, units};
use crate::record::in_one_line;
use crate::store::Snapshot;

/// Show all that is known of the units of a serial number
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The serial number
    serial: String,
    #[command(flatten)]
    results: Results,
    /// Print JSON
    #[arg(long)]
    pub(super) json: bool,
}

/// No unit of this serial number was tested here.
#[derive(Debug, thiserror::Error)]
#[error("no unit {serial} was tested here; `halfrow-station history` lists the runs")]
pub(super) struct NoSuchUnit {
    pub(super) serial: String,
}

pub(super) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    let snapshot = arguments.results.snapshot()?;
    let units = units(&snapshot, &arguments.serial)?;
    if units.is_empty() {
        return Err(Failure::call(NoSuchUnit { serial: arguments.serial.clone() }));
    }
    either(&units, arguments.json, |units| {
        plain_lines(units.iter().flat_map(|unit| unit_lines(unit, &snapshot)))
    })
}

fn unit_lines(unit: &Unit, of: &Snapshot) -> Vec<String> {
    let Unit { product, serial, runs, .. } = unit;
    let mut lines = vec![format!("{serial}, {product}, first seen {}", time(unit.first_seen_ms))];
    lines.extend(unit.mismatches.iter().map(mismatch));
    lines.extend(runs.iter().flat_map(|run| run_lines(run, &not_exercised(run, of))));
    lines
}

fn mismatch(one: &Mismatch) -> String {
    let Bound { device, serial, from_ms, station, .. } = &one.bound;
    let by = station.as_ref().map_or_else(|| "by a person".to_owned(), |name| format!("by {name}"));
    format!(
        "  mismatch  {} judges device {} as {}, last {} in run {}; here {serial} is device {device} since {}, {by}",
        one.station,
        one.device,
        one.serial,
        time(one.last_ms),
        one.run,
        time(*from_ms),
    )
}

/// What a PASS did not test, a line for each step; nothing where its record is not here.
fn not_exercised(run: &UnitRun, of: &Snapshot) -> Vec<String> {
    let line = &run.line;
    let hash = line.record_sha256.as_ref().filter(|_| line.verdict == Some(Verdict::Pass));
    let record = hash.and_then(|hash| of.record(hash).ok());
    let parts = record.as_ref().map(|(record, _)| record.not_exercised()).unwrap_or_default();
    parts.iter().map(in_one_line).collect()
}

fn run_lines(run: &UnitRun, not_exercised: &[String]) -> Vec<String> {
    let line = &run.line;
    let verdict = verdict(line);
    let headline = line.headline.as_deref().unwrap_or("it is under way");
    let device = run.device.as_deref().unwrap_or("not known");
    let mut lines = vec![
        String::new(),
        format!("{verdict} {}: {headline}", time(line.started_ms)),
        format!("  run       {}, {} {}", line.id, line.plan, line.version),
        format!("  place     {}, lane {}, by {}", line.station, line.lane, line.operator),
        format!("  board     {}, device {device}", run.target),
    ];
    let evidence = run.attachments.iter().map(|one| format!("  evidence  {} {}", one.name, one.sha256));
    lines.extend(run.steps.iter().map(|step| {
        let again = if step.attempt > 1 { format!(", try {}", step.attempt) } else { String::new() };
        format!("  step      {}{again} {}: {}", step.name, step.outcome, step.detail)
    }));
    lines.extend(not_exercised.iter().map(|parts| format!("  untested  {parts}")));
    lines.extend(run.suspects.iter().map(|suspect| {
        let share = suspect.share().map(|share| format!(": explains {share:.0} %")).unwrap_or_default();
        format!("  suspect   {}{share}", suspect.named())
    }));
    lines.extend(line.record_sha256.iter().map(|hash| format!("  record    {hash}")));
    lines.extend(evidence);
    lines.extend(run.waivers.iter().map(|waiver| {
        format!("  waived    {} by {}: {}", time(waiver.at_ms), waiver.operator, waiver.reason)
    }));
    lines
}
