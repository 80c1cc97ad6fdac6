//! `halfrow-station codes`

use clap::Args;
use halfrow_program::codes as program;
use serde_json::json;

use super::{Failure, document, print};
use crate::codes::lists;
use crate::exit::Exit;

/// Print the page of all codes of the station's errors
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Print JSON
    #[arg(long)]
    pub(super) json: bool,
}

pub(super) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    if arguments.json {
        let entries = lists().flat_map(|list| list.codes);
        let codes: Vec<_> =
            entries.map(|(code, names)| json!({ "code": code, "parameters": names })).collect();
        return print(&document::text("codes", Exit::Pass, None, json!({ "codes": codes }))?);
    }
    print(format!("{HEAD}{}", program::page(lists())).trim_end())
}

const HEAD: &str = "# Codes of the station

Every error of `halfrow-station` in JSON has a code and parameters, and so has every fault or note of `check`. Codes are
stable: none changes its meaning or its parameters' names within a schema number, and new ones may come. Their sentence
is in `message`, and what to do in `remedy` and at its end.
`halfrow-station codes` prints this page; a test holds the two equal. Errors of boards, links, files, the system and of
command lines have the codes of [`halfrow`](CODES.md).
";
