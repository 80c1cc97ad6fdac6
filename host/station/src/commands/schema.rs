//! `halfrow-station schema`

use clap::{Args, ValueEnum};
use serde_json::Value;

use super::{Failure, print};
use crate::codes;
use crate::exit::Exit;

/// What the program prints as JSON; the codes come from the program.
const SCHEMA: &str = include_str!("../../schema/station-1.json");
/// What is kept of a run.
const RECORD: &str = include_str!("../../schema/record-1.json");

/// Print the JSON Schema of what `run`, `check`, `prune` and `codes` print with `--json`, or of a record
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// `record`: of what is kept of a run, goes to sinks, and is written by `export`
    of: Option<Of>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Of {
    Record,
}

pub(super) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    if let Some(Of::Record) = arguments.of {
        return print(RECORD.trim_end());
    }
    let mut schema: Value = serde_json::from_str(SCHEMA).map_err(Failure::error)?;
    schema["$defs"]["code"]["enum"] = codes::all().into();
    print(&serde_json::to_string_pretty(&schema).map_err(Failure::error)?)
}
