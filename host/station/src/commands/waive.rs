//! `halfrow-station waive`

use clap::Args;
use halfrow::words::plain;

use super::Failure;
use super::looking::Data;
use super::why::{entered, person};
use crate::console;
use crate::exit::Exit;
use crate::store::{NoWaiver, Store};

/// Waive the FAIL of a run: it stays FAIL, and everyone sees who waived it and why
///
/// For a unit that is used as it is, or a FAIL that the fixture caused. Yields count the unit as failed, and also as
/// waived.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The run, as `halfrow-station history` names it
    run: String,
    #[command(flatten)]
    data: Data,
    /// Why, in 500 characters at most
    #[arg(long, value_name = "TEXT")]
    reason: String,
    /// Your name, which the audit keeps
    #[arg(long, value_name = "NAME", value_parser = person)]
    operator: String,
}

pub(super) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    let mut store = Store::open_existing(&arguments.data.folder())?;
    entered(&mut store, &arguments.operator, &format!("waive {}", arguments.run))?;
    let waiver = store.waive(&arguments.run, &arguments.operator, &arguments.reason)?;
    let said = format!("run {} is waived by {}: {}", waiver.run, waiver.operator, waiver.reason);
    console::tell(&plain(&said));
    Ok(Exit::Pass)
}

impl From<NoWaiver> for Failure {
    fn from(error: NoWaiver) -> Self {
        match error {
            NoWaiver::Store(error) => error.into(),
            NoWaiver::NoRandomness(error) => Self::error(error),
            error => Self::call(error),
        }
    }
}
