//! `halfrow link`

use std::time::Duration;

use clap::Args;
use halfrow_program::number::{seconds, whole_number};
use serde::Serialize;
use serde_json::json;

use super::{Context, Failure, print_or_tell};
use crate::arguments::board::BoardArguments;
use crate::console;
use crate::document::result_text;
use crate::exit::Exit;
use halfrow::board::{Board, RetryLimit};
use halfrow::link_test::{self, Errors, Figures, LinkTestError, Rate, RoundTrips, Throughput};
use halfrow::result::BoardReport;
use halfrow::words::{count, grouped, plain, verb};

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// How long each of the five parts takes, 0.001 to 86400 seconds
    #[arg(long, value_name = "SECONDS", default_value = "1", value_parser = seconds(0.001..=86_400.0))]
    seconds: Duration,
    /// Seed of what is sent
    #[arg(long, value_name = "SEED", default_value_t = 1, value_parser = whole_number())]
    seed: u64,
    #[command(flatten)]
    board: BoardArguments,
}

pub(super) fn run(arguments: &Arguments, context: &Context) -> Result<Exit, Failure> {
    let candidate = arguments.board.candidate(&context.settings)?;
    let options = arguments.board.measuring_options(&context.settings)?;
    let asked = Board::with(candidate.link, &options, |board| {
        let tested = link_test::run(board, arguments.seconds, arguments.seed);
        (tested, BoardReport::of(board.welcome(), board.capabilities(), candidate.kind, candidate.target))
    });
    let (tested, board) = asked?;
    let limit = arguments.board.retry_limit(&context.settings);
    let figures = tested.map_err(|error| failed(error, &board, limit, context))?;
    let too_poor = figures.errors.are_beyond(limit);
    let exit = match (figures.errors.wrong, too_poor) {
        (1.., _) => Exit::Fail,
        (0, true) => Exit::Error,
        (0, false) => Exit::Pass,
    };
    if context.json {
        let retry_limit = limit.of(figures.errors.packets_out);
        let link = LinkSummary { figures: &figures, retry_limit, too_poor };
        return print_or_tell(exit, &result_text("link", exit, Some(&board), json!({ "link": link }))?);
    }
    let verdict = if too_poor { "too poor for verify" } else { "good enough for verify" };
    let (figures, last) = (text(&figures), enough(verdict, &figures.errors, limit));
    print_or_tell(exit, &format!("{}\n{figures}\n{last}", of_board(&board)))
}

/// The failure of a test that did not come to its end, once the figures are told that it has nevertheless.
fn failed(error: LinkTestError, board: &BoardReport, limit: RetryLimit, context: &Context) -> Failure {
    match error {
        LinkTestError::Board(error) => error.into(),
        LinkTestError::BrokeOff { ref source, .. } => Failure::of(source.cause().into(), error),
        LinkTestError::PoorLink { ref link, ref errors, .. } => {
            if !context.json {
                let [of_link, damaged] = damage(link, errors);
                let last = enough("too poor for verify, since this test broke off", errors, limit);
                console::tell(&format!("{}\n{of_link}\n{damaged}\n{last}", of_board(board)));
            }
            let figures = json!({ "link": link, "errors": errors });
            let retry_limit = limit.of(errors.packets_out);
            let link = LinkSummary { figures: &figures, retry_limit, too_poor: true };
            let so_far = json!({ "board": board, "link": link });
            Failure { so_far: Some(so_far), ..Failure::error(error) }
        }
        LinkTestError::NoFrame(_) => Failure::error(error),
    }
}

fn of_board(board: &BoardReport) -> String {
    plain(&format!("{:<12} {} ({})", "board", board.target, board.kind)).into_owned()
}

/// The figures, and whether a board can be judged over such a link.
#[derive(Serialize)]
struct LinkSummary<'a, F> {
    #[serde(flatten)]
    figures: &'a F,
    /// The most packets that a run of this length may send again, late ones not counted.
    retry_limit: u64,
    too_poor: bool,
}

/// `too poor for verify: 9.6 % sent again (120 of 1,250), the limit is 16 plus 5 %`, late ones not counted.
fn enough(verdict: &str, errors: &Errors, limit: RetryLimit) -> String {
    let share = 100.0 * errors.lost() as f64 / errors.packets_out.max(1) as f64;
    let (again, all) = (grouped(errors.lost()), grouped(errors.packets_out));
    // Rounded: 7 % as a share, times 100, is not 7 any more.
    let (percent, fixed) = ((1e8 * limit.share).round() / 1e6, limit.fixed);
    format!(
        "{:<12} {verdict}: {share:.1} % sent again ({again} of {all}), the limit is {fixed} plus {percent} %",
        "judging"
    )
}

fn text(figures: &Figures) -> String {
    let Figures { link, errors, round_trips, .. } = figures;
    let mut lines = damage(link, errors).to_vec();
    let timed = [
        ("round trip", times(round_trips)),
        ("to board", rates(&figures.to_board)),
        ("to host", rates(&figures.to_host)),
        ("together", rates(&figures.together)),
    ];
    if timed.iter().all(|(_, told)| told.is_none()) {
        lines.push(format!("{:<12} {NOT_MEASURED}", "times"));
    } else {
        lines.extend(timed.map(|(name, told)| {
            let told = told.unwrap_or_else(|| NOT_MEASURED.to_owned());
            format!("{name:<12} {told}")
        }));
    }
    if errors.wrong > 0 {
        let (answers, hold) = (count(errors.wrong, "answer"), verb(errors.wrong, "hold"));
        lines.push(format!("{:<12} {answers} {hold} other bytes than were sent, with a right CRC", "BOARD"));
    }
    lines.join("\n")
}

/// The name of the link, and what was damaged on it.
fn damage(link: &str, errors: &Errors) -> [String; 2] {
    let damaged = errors.damaged();
    let share = if damaged == 0 { "none".to_owned() } else { format!("{:.1e}", errors.rate) };
    let late = match errors.late {
        0 => String::new(),
        late => format!(", {} only since the answer was late", grouped(late)),
    };
    [
        format!("{:<12} {link}", "link"),
        format!(
            "{:<12} {} of {} ({} out, {} in): {share}, below {:.1e} at 95 % confidence; {} sent again{late}",
            "damaged",
            grouped(damaged),
            count(errors.packets, "packet"),
            grouped(errors.damaged_out),
            grouped(errors.damaged_in),
            errors.bound,
            grouped(errors.retries)
        ),
    ]
}

/// What replaces a figure that cannot be measured on a wire without a speed.
const NOT_MEASURED: &str = "not measured on a simulated link";

fn times(trips: &RoundTrips) -> Option<String> {
    if trips.most_us <= 0.0 {
        return None;
    }
    let RoundTrips { median_us, p90_us, p99_us, least_us, most_us, count } = *trips;
    let [median, p90, p99, least, most] =
        [median_us, p90_us, p99_us, least_us, most_us].map(|time| grouped(time.round() as u64));
    let count = grouped(count);
    Some(format!("median {median} µs, 90 % {p90} µs, 99 % {p99} µs, {least} to {most} µs in {count}"))
}

fn rates(both: &Throughput) -> Option<String> {
    both.out.bytes_per_second.or(both.back.bytes_per_second)?;
    Some(format!("{} out, {} in", rate(&both.out), rate(&both.back)))
}

fn rate(rate: &Rate) -> String {
    match (rate.bytes_per_second, rate.share) {
        (Some(rate), Some(share)) => format!("{:.3} MB/s ({:.1} %)", rate / 1e6, 100.0 * share),
        (Some(rate), None) => format!("{:.3} MB/s", rate / 1e6),
        (None, _) => NOT_MEASURED.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::commands::Cli;

    #[test]
    fn a_wrong_seed_is_refused_in_the_words_of_verify() {
        let said = |command| {
            let error = Cli::line().try_get_matches_from(["halfrow", command, "--seed", "x"]).unwrap_err();
            error.to_string().lines().next().unwrap().to_owned()
        };
        assert_eq!(said("link"), said("verify"));
    }

    #[test]
    fn the_limit_is_printed_as_it_was_given() {
        let errors = Errors {
            packets: 2,
            bytes: 20,
            packets_out: 1,
            damaged_out: 0,
            damaged_in: 0,
            retries: 0,
            late: 0,
            wrong: 0,
            rate: 0.0,
            bound: 1.0,
        };
        for percent in [0.0, 0.1, 2.345, 7.0, 14.0, 28.0, 55.0, 100.0] {
            let limit = RetryLimit::of_percent(percent);
            let said = enough("good enough for verify", &errors, limit);
            assert!(said.ends_with(&format!(", the limit is 16 plus {percent} %")), "{said}");
        }
    }
}
