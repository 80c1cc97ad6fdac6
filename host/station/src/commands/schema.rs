//! `halfrow-station schema`

use clap::{Args, ValueEnum};
use serde_json::Value;

use super::{Failure, print};
use crate::codes;
use crate::exit::Exit;

/// The schema of what the program prints as JSON. It is written by hand; only the codes come from the program.
const SCHEMA: &str = include_str!("../../schema/station-1.json");
/// The schema of a run's record.
const RECORD: &str = include_str!("../../schema/record-1.json");

/// The schemas of what the commands that show results print; each is a definition of its own name.
const RESULTS: &str = include_str!("../../schema/results-1.json");

/// Print the JSON Schema of what `run`, `check`, `prune` and `codes` print with `--json`, or of a record, or of what was judged
///
/// If `history`, `unit`, `yield` or `pareto` have no result, they print what the first of these schemas calls `failed`.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// `record`: of what is kept of a run, goes to sinks, and is written by `export`; else of what this command prints with
    /// `--json` if there is a result
    of: Option<Of>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Of {
    Record,
    History,
    Unit,
    Yield,
    Pareto,
}

pub(super) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    let schema = match arguments.of {
        None => of_documents(),
        Some(Of::Record) => return print(RECORD.trim_end()),
        Some(Of::History) => of_results("history"),
        Some(Of::Unit) => of_results("unit"),
        Some(Of::Yield) => of_results("yield"),
        Some(Of::Pareto) => of_results("pareto"),
    };
    let text = schema.and_then(|schema| serde_json::to_string_pretty(&schema));
    print(&text.map_err(Failure::error)?)
}

fn of_documents() -> Result<Value, serde_json::Error> {
    let mut schema: Value = serde_json::from_str(SCHEMA)?;
    schema["$defs"]["code"]["enum"] = codes::all().into();
    Ok(schema)
}

/// The schema for one command, instead of for any of them.
fn of_results(command: &str) -> Result<Value, serde_json::Error> {
    let Value::Object(mut schema) = serde_json::from_str(RESULTS)? else { return Ok(Value::Null) };
    schema.retain(|key, _| key != "oneOf");
    schema.insert("title".to_owned(), format!("halfrow-station {command} --json, schema 1").into());
    schema.insert("$ref".to_owned(), format!("#/$defs/{command}").into());
    Ok(schema.into())
}
