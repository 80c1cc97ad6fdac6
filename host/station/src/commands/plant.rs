//! `halfrow-station plant`

use clap::{Args, Subcommand};

use super::beginning::SettingsFile;
use super::{Failure, print};
use crate::exit::Exit;
use crate::settings::{PlantSettings, PlantSettingsError, Settings};
use crate::store::{Plant, PlantError};

/// Keep the results of all stations in one PostgreSQL database
///
/// `[plant]` of the settings says where it is. Stations fill it by themselves, and go on without it.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    settings: SettingsFile,
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, Subcommand)]
enum What {
    /// Make the plant's tables, or bring them up to date with a copy of all that is in them
    Prepare,
}

pub(super) fn run(Arguments { settings, what }: &Arguments) -> Result<Exit, Failure> {
    let settings = settings.load()?;
    let address = plant(&settings)?.address().map_err(Failure::call)?;
    match what {
        What::Prepare => {
            let version = Plant::prepare(&address)?;
            print(&format!("the plant {address} has version {version}"))
        }
    }
}

/// `[plant]` of these settings.
pub(super) fn plant(settings: &Settings) -> Result<&PlantSettings, Failure> {
    settings.plant.as_ref().ok_or_else(|| Failure::call(NoPlant))
}

/// Settings that name no plant.
#[derive(Debug, thiserror::Error)]
#[error("the settings name no plant; write url = \"postgres://halfrow@db.example/plant\" into [plant]")]
pub(super) struct NoPlant;

impl From<PlantError> for Failure {
    fn from(error: PlantError) -> Self {
        Self::error(error)
    }
}

impl From<PlantSettingsError> for Failure {
    fn from(error: PlantSettingsError) -> Self {
        Self::call(error)
    }
}
