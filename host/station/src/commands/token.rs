//! `halfrow-station token`

use clap::{Args, Subcommand};
use halfrow::words::plain_lines;

use super::beginning::{SettingsFile, make_data};
use super::{Failure, print, tell};
use crate::exit::Exit;
use crate::web::{Scope, Tokens, add_token};

/// Say which machines may read the pages
///
/// A machine sends its token with every request, as `Authorization: Bearer TOKEN`. The file that `tokens` under `[access]`
/// of the settings names keeps the mark of a token under the station's key. Changes take effect at once.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    settings: SettingsFile,
    #[command(subcommand)]
    what: Action,
}

#[derive(Debug, Subcommand)]
enum Action {
    /// Draw a token and print it, this once
    Add {
        /// Which machine, as it stands in the audit
        name: String,
        /// What it is for
        #[arg(long, value_enum, default_value = "read")]
        scope: Scope,
    },
    /// Remove a machine's token
    Remove {
        /// Which machine
        name: String,
    },
    /// Print every machine's name and scope
    List,
}

/// The settings do not say where it is kept which machines may read.
#[derive(Debug, thiserror::Error)]
#[error("the settings name no file of tokens; write tokens = \"tokens.toml\" into [access]")]
pub(super) struct NoTokens;

pub(super) fn run(Arguments { settings, what }: &Arguments) -> Result<Exit, Failure> {
    let settings = settings.load_without_lanes()?;
    let file = settings.access.as_ref().and_then(|access| access.tokens.as_ref());
    let file = file.ok_or_else(|| Failure::call(NoTokens))?;
    match what {
        Action::Add { name, scope } => {
            make_data(&settings)?;
            let name = name.trim();
            let shown = print(&add_token(&settings, file, name, *scope)?);
            if shown.is_err() {
                // Nobody has seen it, nor ever will.
                Tokens::remove_from(file, name)?;
            }
            shown
        }
        Action::Remove { name } => {
            Tokens::remove_from(file, name)?;
            Ok(tell(&format!("{name} may not read any more")))
        }
        Action::List => {
            let tokens = Tokens::load_or_none(file)?;
            let lines: Vec<_> = tokens.names().map(|(name, scope)| format!("{scope:<5} {name}")).collect();
            print(&plain_lines(&lines))
        }
    }
}
