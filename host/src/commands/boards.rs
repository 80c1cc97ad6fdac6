//! `halfrow boards`

use clap::Args;
use serde::Serialize;

use super::{Failure, print, print_json};
use crate::target::BoardKind;
use crate::verdict::Exit;

/// List the boards that can be named with --board
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Print a JSON list
    #[arg(long)]
    pub(super) json: bool,
}

#[derive(Serialize)]
struct Entry {
    target: &'static str,
    kind: BoardKind,
    summary: &'static str,
}

const BOARDS: [Entry; 5] = [
    Entry {
        target: "mock",
        kind: BoardKind::Mock,
        summary: "a board in this program; mock,KEY=VALUE sets its build, its wire and its fault",
    },
    Entry {
        target: "sim",
        kind: BoardKind::Sim,
        summary: "the board's Verilog under simulation; sim,KEY=VALUE sets its wire and that wire's fault, trace=FILE \
                  writes a waveform (in programs built with --features sim)",
    },
    Entry { target: "sim:uart", kind: BoardKind::Sim, summary: "the same behind the pins of its UART" },
    Entry { target: "sim:fifo", kind: BoardKind::Sim, summary: "the same behind the pins of its FT2232H" },
    Entry {
        target: "replay:FILE",
        kind: BoardKind::Replay,
        summary: "the board that answered when FILE was written with --record",
    },
];

pub(super) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    if arguments.json {
        print_json(&BOARDS)?;
    } else {
        let lines: Vec<String> =
            BOARDS.iter().map(|board| format!("{:<12} {}", board.target, board.summary)).collect();
        print(&lines.join("\n"))?;
    }
    Ok(Exit::Pass)
}
