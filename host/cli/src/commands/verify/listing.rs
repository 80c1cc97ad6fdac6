//! `halfrow verify --list`: what would be streamed, and what each part costs.

use serde::Serialize;

use crate::commands::print;
use crate::document::print_result;
use crate::exit::Exit;
use crate::failure::Failure;
use halfrow::board::{BoardNature, Capabilities};
use halfrow::link::{SerialBoard, bytes_per_second, kinds};
use halfrow::result::Variation;
use halfrow::run::{self, Build, Part, Plan, Prices, Rates, Selection, Timing, usual_capabilities};
use halfrow::target::{BoardKind, Target};
use halfrow::words::plain_lines;

/// Links for which prices are given if the target does not say how fast its link is: two UARTs and a FIFO.
const USUAL_LINKS: [(&str, f64); 3] =
    [("3 Mbaud", 300_000.0), ("12 Mbaud", 1_200_000.0), ("FIFO, 5 MB/s", 5_000_000.0)];
/// The assumed round trip over a link that was not measured, in seconds.
const ROUND_TRIP: f64 = 0.001;

/// With which tables a frame would be corrected.
#[derive(Serialize)]
#[serde(rename_all = "kebab-case")]
enum Tables {
    /// Those that the run is about.
    Judged,
    /// Those before them, so that the change is judged too.
    Decoy,
}

/// A frame that would be streamed.
#[derive(Serialize)]
struct Listed {
    number: u16,
    name: String,
    tables: Tables,
    timing: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    variation: Option<Variation>,
}

/// What a run costs on a link.
#[derive(Serialize)]
struct OnLink {
    link: String,
    bytes_per_second: f64,
    round_trip: f64,
    parts: Vec<Priced>,
    /// The seconds that every run takes at least, including the session's opening and one row.
    every_run: f64,
    whole_run: f64,
}

/// What a part adds to the shortest run.
#[derive(Serialize)]
struct Priced {
    part: String,
    /// Rows, or frames at speed.
    amount: usize,
    seconds: f64,
}

/// Prints what would be streamed to the board behind `target`, which is not opened, and what it would cost.
pub(super) fn list(plan: &Plan, target: &Target, as_json: bool) -> Result<Exit, Failure> {
    let (listed, links) = (listing(plan), on_links(plan, target));
    if as_json {
        let listed = serde_json::json!({ "listed": listed, "prices": links });
        print_result("verify", listed)?;
        return Ok(Exit::Pass);
    }
    let line = |Listed { number, name, tables, timing, variation }: &Listed| {
        let variation = variation.map_or_else(String::new, |variation| format!(", {variation}"));
        let tables = match tables {
            Tables::Judged => "your",
            Tables::Decoy => "decoy",
        };
        format!("{number:>4}  {name:<24} {tables:<6} tables, {timing}{variation}")
    };
    let mut lines: Vec<_> = listed.iter().map(line).collect();
    if !links.is_empty() {
        lines.push(String::new());
        lines.extend(table(&links));
    }
    print(&plain_lines(&lines))?;
    Ok(Exit::Pass)
}

fn listing(plan: &Plan) -> Vec<Listed> {
    let mut listed = Vec::new();
    for segment in plan.schedule(&Build::full(plan.tables.geometry().width())) {
        let timing = match segment.timing {
            Timing::Least => "least blanking",
            Timing::Sensor => "sensor blanking",
            Timing::Gaps(_) => "gaps",
        };
        let variation = plan.variation(&segment.geometry);
        listed.extend(segment.frames.iter().map(|frame| {
            let tables = if frame.generation == run::DECOY { Tables::Decoy } else { Tables::Judged };
            Listed { number: frame.number, name: frame.source.name(), tables, timing, variation }
        }));
    }
    listed
}

fn on_links(plan: &Plan, target: &Target) -> Vec<OnLink> {
    let nature = match kinds::board_of(target) {
        // It has already been streamed, at no cost now.
        BoardKind::Replay => return Vec::new(),
        BoardKind::Mock => BoardNature::Mock,
        BoardKind::Sim => BoardNature::Simulation,
        BoardKind::Hardware => BoardNature::Hardware,
    };
    let capabilities = usual_capabilities(plan, nature);
    let on_link = |(link, bytes_per_second)| on_link(plan, &capabilities, link, bytes_per_second);
    match stated_rate(target) {
        Some(rate) => vec![on_link((target.to_string(), rate))],
        None => USUAL_LINKS.map(|(link, rate)| on_link((link.to_owned(), rate))).into(),
    }
}

/// The bytes per second of the link, if the target gives its speed.
fn stated_rate(target: &Target) -> Option<f64> {
    let number = |key: &str| {
        let rate = target.option(key)?.parse::<f64>().ok();
        rate.filter(|rate| rate.is_finite() && *rate > 0.0)
    };
    let board = target.option("board").and_then(SerialBoard::named).map(|board| f64::from(board.baud));
    number("speed").or_else(|| number("baud").or(board).map(bytes_per_second))
}

fn on_link(plan: &Plan, capabilities: &Capabilities, link: String, bytes_per_second: f64) -> OnLink {
    let rates = Rates { bytes_per_second, round_trip: ROUND_TRIP };
    let prices = Prices::new(plan, capabilities, rates);
    let parts = prices.parts();
    let priced = |&part: &Part| Priced {
        part: plan.name_of(part),
        amount: prices.most(part),
        seconds: prices.of_part(part),
    };
    OnLink {
        link,
        bytes_per_second,
        round_trip: ROUND_TRIP,
        parts: parts.iter().map(priced).collect(),
        every_run: prices.opening() + prices.seconds(&Selection::least()),
        whole_run: prices.opening() + prices.seconds(&Selection::all(parts)),
    }
}

/// The prices, with a line for each part and a column for each link.
fn table(links: &[OnLink]) -> Vec<String> {
    let line = |name: &str, amount: String, of: &dyn Fn(&OnLink) -> String| {
        links
            .iter()
            .fold(format!("{name:<40} {amount:>6}"), |line, link| line + &format!(" {:>14}", of(link)))
    };
    let seconds = |seconds: f64| format!("{seconds:.3} s");
    let parts = links.first().map_or(&[][..], |link| &link.parts);
    let part = |(place, part): (usize, &Priced)| {
        let of = |link: &OnLink| link.parts.get(place).map_or_else(String::new, |part| seconds(part.seconds));
        line(&part.part, part.amount.to_string(), &of)
    };
    let head = line("part", "amount".to_owned(), &|link| link.link.clone());
    let every = line("every run", String::new(), &|link| seconds(link.every_run));
    let whole = line("the whole run", String::new(), &|link| seconds(link.whole_run));
    [head, every].into_iter().chain(parts.iter().enumerate().map(part)).chain([whole]).collect()
}
