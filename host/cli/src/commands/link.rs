//! `halfrow link`

use std::time::Duration;

use clap::Args;
use halfrow_program::number::seconds;
use serde_json::json;

use super::{Context, Failure, print_or_tell};
use crate::arguments::board::BoardArguments;
use crate::document::result_text;
use crate::exit::Exit;
use halfrow::board::Board;
use halfrow::link_test::{self, Figures, LinkTestError, Rate, RoundTrips, Throughput};
use halfrow::result::BoardReport;
use halfrow::words::count;

#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    board: BoardArguments,
    /// How long each of the five parts takes
    #[arg(long, value_name = "SECONDS", default_value = "1", value_parser = seconds(0.001..=86_400.0))]
    seconds: Duration,
    /// Seed of what is sent
    #[arg(long, value_name = "SEED", default_value_t = 1)]
    seed: u64,
}

pub(super) fn run(arguments: &Arguments, context: &Context) -> Result<Exit, Failure> {
    let candidate = arguments.board.candidate(&context.settings)?;
    let options = arguments.board.measuring_options(&context.settings)?;
    let asked = Board::with(candidate.link, &options, |board| {
        let tested = link_test::run(board, arguments.seconds, arguments.seed);
        (tested, BoardReport::of(board, candidate.kind, candidate.target))
    });
    let (tested, board) = asked?;
    let figures = tested.map_err(|error| match error {
        LinkTestError::Board(error) => error.into(),
        error @ LinkTestError::NoFrame(_) => Failure::error(error),
    })?;
    let exit = if figures.errors.wrong > 0 { Exit::Fail } else { Exit::Pass };
    if context.json {
        return print_or_tell(exit, &result_text("link", exit, Some(&board), json!({ "link": figures }))?);
    }
    print_or_tell(exit, &format!("{:<12} {} ({})\n{}", "board", board.target, board.kind, text(&figures)))
}

fn text(figures: &Figures) -> String {
    let Figures { link, errors, round_trips, .. } = figures;
    let damaged = errors.damaged_out + errors.damaged_in;
    let share = if damaged == 0 { "none".to_owned() } else { format!("{:.1e}", errors.rate) };
    let mut lines = vec![
        format!("{:<12} {link}", "link"),
        format!(
            "{:<12} {damaged} of {} packets ({} out, {} in): {share}, below {:.1e} at 95 % confidence; {} sent again",
            "damaged", errors.packets, errors.damaged_out, errors.damaged_in, errors.bound, errors.retries
        ),
        format!("{:<12} {}", "round trip", times(round_trips)),
    ];
    let parts =
        [("to board", &figures.to_board), ("to host", &figures.to_host), ("together", &figures.together)];
    lines.extend(parts.map(|(name, both)| format!("{name:<12} {}", rates(both))));
    if errors.wrong > 0 {
        let (answers, hold) =
            (count(errors.wrong, "answer"), if errors.wrong == 1 { "holds" } else { "hold" });
        lines.push(format!("{:<12} {answers} {hold} other bytes than were sent, with a right CRC", "BOARD"));
    }
    lines.join("\n")
}

/// What replaces a figure that cannot be measured on a wire without a speed.
const NOT_MEASURED: &str = "virtual clock: not measured";

fn times(trips: &RoundTrips) -> String {
    if trips.most_us <= 0.0 {
        return NOT_MEASURED.to_owned();
    }
    format!(
        "median {:.0} µs, 90 % {:.0} µs, 99 % {:.0} µs, {:.0} to {:.0} µs in {}",
        trips.median_us, trips.p90_us, trips.p99_us, trips.least_us, trips.most_us, trips.count
    )
}

fn rates(both: &Throughput) -> String {
    match (both.out.bytes_per_second, both.back.bytes_per_second) {
        (None, None) => NOT_MEASURED.to_owned(),
        _ => format!("{} out, {} in", rate(&both.out), rate(&both.back)),
    }
}

fn rate(rate: &Rate) -> String {
    match (rate.bytes_per_second, rate.share) {
        (Some(rate), Some(share)) => format!("{:.3} MB/s ({:.1} %)", rate / 1e6, 100.0 * share),
        (Some(rate), None) => format!("{:.3} MB/s", rate / 1e6),
        (None, _) => NOT_MEASURED.to_owned(),
    }
}
