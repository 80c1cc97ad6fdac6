//! `halfrow-station waive`

use clap::Args;

use super::looking::Data;
use super::why::{Why, at_station};
use super::{Failure, tell};
use crate::exit::Exit;
use crate::store::NoWaiver;

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
    #[command(flatten)]
    why: Why,
}

pub(super) fn run(Arguments { run, data, why }: &Arguments) -> Result<Exit, Failure> {
    let Why { reason, operator } = why;
    let mut store = at_station(&data.folder(), operator, &format!("waive {run}"))?;
    let waiver = store.waive(run, operator, reason)?;
    let said = format!("run {} is waived by {}: {}", waiver.run, waiver.operator, waiver.reason);
    Ok(tell(&said))
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
