//! `halfrow station`

use std::convert::Infallible;
use std::ffi::OsString;
use std::os::unix::process::CommandExt as _;
use std::path::Path;
use std::process::Command;

use anyhow::Context as _;
use clap::Args;

use super::{Failure, wrong_call};

/// The program that lies beside this one.
const PROGRAM: &str = "halfrow-station";

/// Start the production station, a program of its own
///
/// `halfrow station help` lists its commands.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// What the station is called with
    #[arg(trailing_var_arg = true, allow_hyphen_values = true, value_name = "ARGUMENTS")]
    arguments: Vec<OsString>,
}

/// Becomes the station, if it is there.
pub(super) fn run(arguments: &Arguments) -> Result<Infallible, Failure> {
    let here =
        std::env::current_exe().context("this program cannot tell where it is").map_err(Failure::error)?;
    let program = here.parent().unwrap_or(Path::new(".")).join(PROGRAM);
    if !program.exists() {
        return Err(wrong_call!(
            "the station is a program of its own, and {} is not there; build it with `cargo build --release --package \
             {PROGRAM}`, or install it with `cargo install --path host/station`",
            program.display()
        ));
    }
    let error = Command::new(&program).args(&arguments.arguments).exec();
    let what = format!("{} cannot be started; build or install it again", program.display());
    Err(Failure::error(anyhow::Error::from(error).context(what)))
}
