//! `halfrow info`

use clap::Args;
use serde_json::json;

use super::{Context, Failure, print};
use crate::arguments::board::BoardArguments;
use crate::document::result_text;
use crate::exit::Exit;
use halfrow::board::{Board, Status};
use halfrow::result::BoardReport;
use halfrow::words::plain_lines;

#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    board: BoardArguments,
}

pub(super) fn run(arguments: &Arguments, context: &Context) -> Result<Exit, Failure> {
    let candidate = arguments.board.candidate(&context.settings)?;
    let options = arguments.board.open_options(&context.settings)?;
    let asked = Board::with(candidate.link, &options, |board| {
        (
            board.status(),
            BoardReport::of(board.welcome(), board.capabilities(), candidate.kind, candidate.target),
        )
    });
    let (status, report) = asked?;
    let status = status?;
    if context.json {
        let counters: serde_json::Map<_, _> =
            status.counters().into_iter().map(|(name, count)| (name.to_owned(), count.into())).collect();
        print(&result_text("info", Exit::Pass, Some(&report), json!({ "counters": counters }))?)?;
    } else {
        print(&text(&report, &status))?;
    }
    Ok(Exit::Pass)
}

fn text(board: &BoardReport, status: &Status) -> String {
    let mut lines = vec![format!("{:<19} {} ({})", "board", board.target, board.kind)];
    if let Some(identity) = &board.identity {
        lines.extend(identity.lines().into_iter().map(|(name, value)| format!("{name:<19} {value}")));
    }
    lines.push(String::new());
    lines.extend(status.counters().into_iter().map(|(name, count)| format!("{name:<19} {count}")));
    plain_lines(lines)
}
