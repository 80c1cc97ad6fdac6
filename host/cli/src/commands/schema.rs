//! `halfrow schema`

use clap::Args;
use serde_json::{Value, json};

use super::{Failure, codes, print};
use crate::call_error::CallError;
use crate::exit::Exit;

/// The schema of what the program prints as JSON. It is written by hand; only the codes come from the program.
const SCHEMA: &str = include_str!("../../../schema/halfrow-1.json");

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The command whose documents alone are wanted, as `verify` [default: all]
    #[arg(value_name = "COMMAND")]
    command: Option<String>,
}

pub(super) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    let mut schema: Value = serde_json::from_str(SCHEMA).map_err(Failure::error)?;
    if let Some(command) = &arguments.command {
        let commands = schema["properties"]["command"]["enum"].as_array().cloned().unwrap_or_default();
        let known = commands.iter().filter_map(Value::as_str).collect::<Vec<_>>();
        if !known.contains(&command.as_str()) {
            let (command, known) = (command.clone(), known.join(", "));
            return Err(Failure::call(CallError::NoDocument { command, known }));
        }
        schema["properties"]["command"] = json!({ "const": command });
    }
    schema["$defs"]["code"]["enum"] =
        codes::all().into_iter().map(|entry| Value::String(entry.code)).collect();
    print(&serde_json::to_string_pretty(&schema).map_err(Failure::error)?)?;
    Ok(Exit::Pass)
}
