//! `halfrow-station history`

use clap::Args;
use halfrow::Verdict;
use halfrow_program::number::counted;

use super::Failure;
use super::looking::{Filtered, Results, either, table, time};
use crate::exit::Exit;
use crate::history::runs::{Cursor, MOST, Page, RunLine, page};

/// The most characters of a result that are shown.
const MOST_RESULT: usize = 80;
/// The column of the station, before the lane that it has.
const STATION_AT: usize = 4;

/// List runs, the newest first
#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    results: Results,
    #[command(flatten)]
    filtered: Filtered,
    /// How many at most, 1 to 1000
    #[arg(long, value_name = "RUNS", default_value = "50", value_parser = counted::<u32>(1, Some(u64::from(MOST))))]
    limit: u32,
    /// Continue after this place, with which the page before ended
    #[arg(long, value_name = "PLACE")]
    after: Option<Cursor>,
    /// Print JSON
    #[arg(long)]
    pub(super) json: bool,
}

pub(super) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    let filter = arguments.filtered.filter()?;
    let page = page(&arguments.results.snapshot()?, &filter, arguments.after.as_ref(), arguments.limit)?;
    either(&page, arguments.json, |page| text(page, arguments.results.is_of_plant()))
}

/// The run's verdict, or that it is open.
pub(super) fn verdict(run: &RunLine) -> String {
    run.verdict.map_or_else(|| "open".to_owned(), |verdict| verdict.to_string())
}

/// Why the run was no PASS, cut to what fits on a line.
fn why(run: &RunLine) -> String {
    let headline = run.headline.as_deref().filter(|_| run.verdict != Some(Verdict::Pass));
    let headline = headline.unwrap_or_default();
    match headline.char_indices().nth(MOST_RESULT) {
        Some((end, _)) => format!("{}…", &headline[..end]),
        None => headline.to_owned(),
    }
}

fn text(page: &Page, is_plant: bool) -> String {
    let rows = page.runs.iter().map(|run| {
        let waived = if run.waived { ", waived" } else { "" };
        let mut row = vec![
            time(run.started_ms),
            run.serial.clone(),
            format!("{}{waived}", verdict(run)),
            format!("{} {} {}", run.product, run.plan, run.version),
            run.lane.clone(),
            run.operator.clone(),
            run.id.clone(),
            why(run),
        ];
        if is_plant {
            row.insert(STATION_AT, run.station.clone());
        }
        row
    });
    let mut header = vec!["began", "serial", "verdict", "plan", "lane", "operator", "run", "result"];
    if is_plant {
        header.insert(STATION_AT, "station");
    }
    if page.runs.is_empty() {
        return "no runs".to_owned();
    }
    let mut text = table(&header, &[], rows);
    if let Some(next) = &page.next {
        text.push_str(&format!("\nmore: --after {next}"));
    }
    text
}
