//! `halfrow-station lang-check`

use std::path::{Path, PathBuf};

use clap::Args;

use super::{Failure, print};
use crate::console;
use crate::exit::Exit;
use crate::input_error::text_of;
use crate::web::language;

/// Check a language of the pages: whether all words are there, and none too many
///
/// Every fault is shown with its line: keys that are missing or that no page says, and figures in braces that a sentence
/// does not have. host/station/lang/de.toml is one to begin with; its keys stay, its words change.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The language's file [default: the languages that are part of the program]
    file: Option<PathBuf>,
}

pub(super) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    let faults = match &arguments.file {
        Some(path) => {
            let text = text_of(path)?;
            faults(path, &text)?
        }
        None => language::built_in()
            .map(|(path, text)| faults(&path, text))
            .collect::<Result<Vec<_>, _>>()?
            .concat(),
    };
    for fault in &faults {
        console::error(fault);
    }
    if !faults.is_empty() {
        return Ok(Exit::Usage);
    }
    print("all words are there, and none too many")
}

fn faults(path: &Path, text: &str) -> Result<Vec<String>, Failure> {
    let faults = language::faults(path, text)?;
    Ok(faults.iter().map(ToString::to_string).collect())
}
