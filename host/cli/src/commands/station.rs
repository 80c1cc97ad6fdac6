//! `halfrow station`

use std::convert::Infallible;
use std::ffi::OsString;
use std::os::unix::process::CommandExt as _;
use std::path::Path;
use std::process::Command;

use clap::Args;

use super::Failure;
use crate::beside;
use crate::call_error::CallError;

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// What the station is called with
    #[arg(trailing_var_arg = true, allow_hyphen_values = true, value_name = "ARGUMENTS")]
    arguments: Vec<OsString>,
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
