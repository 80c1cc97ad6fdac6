//! `halfrow-station schema`

use clap::Args;
use serde_json::Value;

use super::{Failure, print};
use crate::codes;
use crate::exit::Exit;

/// What the program prints as JSON; the codes come from the program.
const SCHEMA: &str = include_str!("../../schema/station-1.json");

/// Print the JSON Schema of what `run`, `check`, `prune` and `codes` print with `--json`
#[derive(Debug, Args)]
pub(super) struct Arguments {}

pub(super) fn run(_: &Arguments) -> Result<Exit, Failure> {
    let mut schema: Value = serde_json::from_str(SCHEMA).map_err(Failure::error)?;
    schema["$defs"]["code"]["enum"] = codes::all().into();
    print(&serde_json::to_string_pretty(&schema).map_err(Failure::error)?)
}
