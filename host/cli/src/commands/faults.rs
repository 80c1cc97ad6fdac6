//! `halfrow faults`

use clap::Args;
use serde::Serialize;

use super::{Failure, print, print_json};
use crate::exit::Exit;

/// List the faults that the mock board can have
///
/// Use one as `--board mock,fault=NAME`, with its parameters behind further commas. Those of the wire serve `sim` as well.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Print a JSON list of objects with name, where (wire or board) and summary
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Fault {
    name: &'static str,
    #[serde(rename = "where")]
    place: &'static str,
    summary: &'static str,
}

pub(super) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    let faults: Vec<Fault> = halfrow_mock::catalogue()
        .iter()
        .map(|info| Fault {
            name: info.name,
            place: match info.place {
                halfrow_mock::Place::Wire => "wire",
                halfrow_mock::Place::Board => "board",
            },
            summary: info.summary,
        })
        .collect();
    if arguments.json {
        print_json(&faults)?;
    } else {
        let lines: Vec<String> = faults
            .iter()
            .map(|fault| format!("{:<22} {:<6} {}", fault.name, fault.place, fault.summary))
            .collect();
        print(&lines.join("\n"))?;
    }
    Ok(Exit::Pass)
}
