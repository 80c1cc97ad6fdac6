//! `halfrow-station unit`

use clap::Args;
use halfrow::words::plain_lines;

use super::Failure;
use super::history::verdict;
use super::looking::{Results, either, time};
use crate::exit::Exit;
use crate::history::mismatch::{Bound, Mismatch};
use crate::history::unit::{Binding, StepUntested, Unit, UnitRun, units};
use crate::record::in_one_line;
use crate::store::{Rebinding, Removed};

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
    let mut units = units(&snapshot, &arguments.serial)?;
    if units.is_empty() {
        return Err(Failure::call(NoSuchUnit { serial: arguments.serial.clone() }));
    }
    for run in units.iter_mut().flat_map(|unit| &mut unit.runs) {
        run.read_record(&snapshot);
    }
    let (rebindings, removed) = (snapshot.rebindings()?, snapshot.pruned()?);
    either(&units, arguments.json, |units| {
        let lines = |unit| unit_lines(unit, &rebindings, &removed);
        plain_lines(units.iter().flat_map(lines))
    })
}

fn unit_lines(unit: &Unit, rebindings: &[Rebinding], removed: &Removed) -> Vec<String> {
    let Unit { product, serial, runs, bindings, .. } = unit;
    let mut lines = vec![format!("{serial}, {product}, first seen {}", time(unit.first_seen_ms))];
    lines.extend(bindings.iter().map(binding));
    lines.extend(rebindings.iter().filter_map(|change| rebound(unit, change)));
    lines.extend(unit.mismatches.iter().map(mismatch));
    for run in runs {
        lines.extend(run_lines(run, bindings));
        lines.extend(kept_lines(run, removed));
    }
    lines
}

fn binding(one: &Binding) -> String {
    let Binding { device, from_ms, to_ms, operator, reason } = one;
    let until = to_ms.map(|ms| format!(" until {}", time(ms))).unwrap_or_default();
    format!("  device    {device} from {}{until}, by {operator}: {reason}", time(*from_ms))
}

/// A change of this unit's bindings, by which another unit may have got its device.
fn rebound(unit: &Unit, change: &Rebinding) -> Option<String> {
    let Rebinding { at_ms, operator, reason, .. } = change;
    let whose = if change.unit_id == unit.id {
        ""
    } else if unit.bindings.iter().any(|one| one.to_ms == Some(*at_ms)) {
        " another unit got its device,"
    } else {
        return None;
    };
    Some(format!("  rebound   {}{whose} by {operator}: {reason}", time(*at_ms)))
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

fn run_lines(run: &UnitRun, bindings: &[Binding]) -> Vec<String> {
    let line = &run.line;
    let verdict = verdict(line);
    let headline = line.headline.as_deref().unwrap_or("it is under way");
    let device = run.device.as_deref().unwrap_or("not known");
    let mut bound = bindings.iter().filter(|one| one.device == device).peekable();
    let is_lost = bound.peek().is_some() && bound.all(|one| one.to_ms.is_some());
    let lost = if is_lost { ", bound to this unit no more" } else { "" };
    let mut lines = vec![
        String::new(),
        format!("{verdict} {}: {headline}", time(line.started_ms)),
        format!("  run       {}, {} {}", line.id, line.plan, line.version),
        format!("  place     {}, lane {}, by {}", line.station, line.lane, line.operator),
        format!("  board     {}, device {device}{lost}", run.target),
    ];
    lines.extend(run.steps.iter().map(|step| {
        let again = if step.attempt > 1 { format!(", try {}", step.attempt) } else { String::new() };
        format!("  step      {}{again} {}: {}", step.name, step.outcome, step.detail)
    }));
    let untested = |of: &StepUntested| format!("  untested  {}", in_one_line(&of.step, &of.parts));
    lines.extend(run.not_exercised.iter().map(untested));
    lines.extend(run.suspects.iter().map(|suspect| {
        let share = suspect.share().map(|share| format!(": explains {share:.0} %")).unwrap_or_default();
        format!("  suspect   {}{share}", suspect.named())
    }));
    lines
}

/// What was kept of a run, and what of that was removed since.
fn kept_lines(run: &UnitRun, removed: &Removed) -> Vec<String> {
    let line = &run.line;
    let ended_ms = line.ended_ms.unwrap_or(i64::MAX);
    let mut lines: Vec<_> = line.record_sha256.iter().map(|hash| format!("  record    {hash}")).collect();
    lines.extend(run.attachments.iter().map(|one| {
        let is_gone = removed.explains(&one.sha256, ended_ms);
        let gone = if is_gone { ", removed since by its age" } else { "" };
        format!("  evidence  {} {}{gone}", one.name, one.sha256)
    }));
    lines.extend(run.waivers.iter().map(|waiver| {
        format!("  waived    {} by {}: {}", time(waiver.at_ms), waiver.operator, waiver.reason)
    }));
    lines
}
