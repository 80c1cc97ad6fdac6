//! `halfrow station`

use std::convert::Infallible;
use std::ffi::OsString;
use std::os::unix::process::CommandExt as _;
use std::path::Path;
use std::process::Command;

use clap::Args;

use super::Failure;
use crate::arguments::given::{Given, written};
use crate::beside;
use crate::call_error::CallError;
use halfrow::call::VoidOption;

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// What the station is called with
    #[arg(trailing_var_arg = true, allow_hyphen_values = true, value_name = "ARGUMENTS")]
    arguments: Vec<OsString>,
}

/// The options that every command of this program has, and the station's program does not get.
const OURS: [&str; 5] = ["settings", "quiet", "verbose", "model_path", "json"];

/// Refuses an option that a call of the station gives to this program, which would do nothing.
pub(super) fn refuse_ours(given: &Given) -> Result<(), VoidOption> {
    let reason = "is taken for `halfrow` here, and the station is a program of its own; leave it out, or write the station's own \
                  behind its command, as in `halfrow station check --verbose`";
    let void = OURS.into_iter().find(|id| given.is_flag(id));
    void.map_or(Ok(()), |id| Err(VoidOption { option: written(id), reason }))
}

/// Replaces this process with the station's program, if that is there.
pub(super) fn run(arguments: &Arguments) -> Result<Infallible, Failure> {
    let not_started = |path: &Path, source| CallError::StationNotStarted { path: path.to_owned(), source };
    let path = beside::station()
        .map_err(|source| Failure::error(not_started(Path::new(beside::STATION), source)))?;
    if !path.exists() {
        return Err(Failure::call(CallError::StationMissing { path }));
    }
    let source = Command::new(&path).args(&arguments.arguments).exec();
    Err(Failure::error(not_started(&path, source)))
}
