//! `halfrow faults`

use clap::Args;
use halfrow_pipe::FaultInfo;
use serde::Serialize;
use serde_json::json;

use super::{Context, Failure, print};
use crate::document::print_result;
use crate::exit::Exit;

#[derive(Debug, Args)]
pub(super) struct Arguments {}

#[derive(Serialize)]
struct Fault {
    name: &'static str,
    #[serde(rename = "where")]
    place: &'static str,
    summary: String,
    parameters: Vec<Parameter>,
}

#[derive(Serialize)]
struct Parameter {
    key: &'static str,
    default: Option<&'static str>,
    range: String,
    meaning: &'static str,
}

impl From<FaultInfo> for Fault {
    fn from(info: FaultInfo) -> Self {
        let parameters = info.parameters.iter().map(|it| Parameter {
            key: it.key,
            default: it.default,
            range: it.range.to_string(),
            meaning: it.meaning,
        });
        Self {
            name: info.name,
            place: info.place.name(),
            summary: info.summary(),
            parameters: parameters.collect(),
        }
    }
}

pub(super) fn run(_: &Arguments, context: &Context) -> Result<Exit, Failure> {
    let faults: Vec<Fault> = halfrow_mock::catalogue().map(Fault::from).collect();
    if context.json {
        print_result("faults", json!({ "faults": faults }))?;
    } else {
        let lines: Vec<String> = faults
            .iter()
            .map(|fault| format!("{:<22} {:<6} {}", fault.name, fault.place, fault.summary))
            .collect();
        print(&lines.join("\n"))?;
    }
    Ok(Exit::Pass)
}
