//! `halfrow-station yield`

use std::cmp::Reverse;
use std::fmt::Write as _;

use clap::Args;
use halfrow::words::count;

use super::Failure;
use super::looking::{Counted, Results, either, table, time};
use crate::exit::Exit;
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
    let header = ["units of", "judged", "first pass", "in the end", "waived", "runs", "errors", "crashes"];
    let mut text = table(&header, &[1, 4, 5, 7], lines.iter().map(row));
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

fn row(line: &Yield) -> Vec<String> {
    let Yield { plan, first_pass, last, errors, .. } = line;
    let lane = line.lane.iter().map(|lane| format!("lane {lane}"));
    let place = line.station.iter().cloned().chain(lane);
    let names = [plan.product.clone(), plan.plan.clone()].into_iter();
    let day = line.day.iter().chain(&line.week).map(ToString::to_string);
    vec![
        names.chain(day).chain(place).collect::<Vec<_>>().join(" "),
        first_pass.of.to_string(),
        first_pass.text(),
        last.text(),
        line.waived.to_string(),
        errors.of.to_string(),
        errors.text(),
        line.crashes.to_string(),
    ]
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
