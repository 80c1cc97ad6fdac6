//! `halfrow-station yield`

use std::cmp::Reverse;
use std::fmt::Write as _;

use clap::Args;
use halfrow::words::{count, plain};

use super::Failure;
use super::looking::{Counted, Results, either, table, time};
use crate::exit::Exit;
use crate::history::control::Limits;
use crate::history::rate::per_cent;
use crate::history::yields::{By, Flip, Yield, Yields, yields};

/// How many of the units that failed first are listed.
const MOST_FLIPS: usize = 20;

/// Count how many units are judged good, at first and in the end
///
/// A unit belongs to the lane and the day of its first judgement. ERROR is no judgement, and has a rate of its own. Each
/// share is followed by its 95 % interval (Wilson).
#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    results: Results,
    /// A line for each
    #[arg(long, value_enum, default_value = "plan")]
    by: By,
    #[command(flatten)]
    counted: Counted,
    /// Print JSON
    #[arg(long)]
    pub(super) json: bool,
}

pub(super) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    let snapshot = arguments.results.snapshot()?;
    let yields = yields(&snapshot, &arguments.counted.wanted()?, arguments.by)?;
    either(&yields, arguments.json, text)
}

fn text(Yields { lines, flips }: &Yields) -> String {
    let has_band = lines.iter().any(|line| line.limits.is_some());
    let band = has_band.then_some("band");
    let header = ["units of", "judged", "first pass"].into_iter().chain(band);
    let header: Vec<_> = header.chain(["in the end", "waived", "runs", "errors", "crashes"]).collect();
    let numbers = [1, 4, 5, 7].map(|column| column + usize::from(has_band && column > 2));
    let mut text = table(&header, &numbers, lines.iter().map(|line| row(line, has_band)));
    text.push_str(&beyond(lines));
    if !flips.is_empty() {
        let newest = newest(flips);
        text.push_str("\n\nfirst FAIL, in the end PASS\n");
        let header = ["serial", "plan", "judgements", "failed", "passed", "run that failed"];
        text.push_str(&table(&header, &[2], newest.iter().copied().map(flip)));
        let left = flips.len() - newest.len();
        if left > 0 {
            let units = count(left, "unit");
            write!(text, "\n{units} more, which passed before these; all are in what --json prints")
                .unwrap_or_default();
        }
    }
    text
}

/// The [`MOST_FLIPS`] that passed last, the latest first.
fn newest(flips: &[Flip]) -> Vec<&Flip> {
    let mut newest: Vec<_> = flips.iter().collect();
    newest.sort_by_key(|flip| Reverse(flip.passed_ms));
    newest.truncate(MOST_FLIPS);
    newest
}

/// The days or weeks that are beyond the band of their plan.
fn beyond(lines: &[Yield]) -> String {
    let is_beyond = |line: &&Yield| line.limits.is_some_and(|limits| limits.is_beyond);
    let beyond: Vec<_> = lines.iter().filter(is_beyond).map(name).collect();
    if beyond.is_empty() {
        String::new()
    } else {
        format!("\n\nbeyond the band: {}", plain(&beyond.join(", ")))
    }
}

/// What a line is about.
fn name(line: &Yield) -> String {
    let lane = line.lane.iter().map(|lane| format!("lane {lane}"));
    let place = line.station.iter().cloned().chain(lane);
    let names = [line.plan.product.clone(), line.plan.plan.clone()].into_iter();
    let day = line.day.iter().chain(&line.week).map(ToString::to_string);
    names.chain(day).chain(place).collect::<Vec<_>>().join(" ")
}

/// The range of the first pass if nothing has changed, and whether it is beyond that.
fn band(limits: Option<Limits>) -> String {
    let Some(Limits { limits: ends, is_beyond, .. }) = limits else { return "–".to_owned() };
    let [low, high] = ends.map(per_cent);
    format!("{low}–{high} %{}", if is_beyond { ", beyond" } else { "" })
}

fn row(line: &Yield, has_band: bool) -> Vec<String> {
    let Yield { first_pass, last, errors, .. } = line;
    let mut row = vec![name(line), first_pass.of.to_string(), first_pass.counted()];
    row.extend(has_band.then(|| band(line.limits)));
    row.extend([
        last.counted(),
        line.waived.to_string(),
        errors.of.to_string(),
        errors.counted(),
        line.crashes.to_string(),
    ]);
    row
}

fn flip(flip: &Flip) -> Vec<String> {
    vec![
        flip.serial.clone(),
        format!("{} {}", flip.plan.product, flip.plan.plan),
        flip.judgements.to_string(),
        time(flip.failed_ms),
        time(flip.passed_ms),
        flip.failed.clone(),
    ]
}
