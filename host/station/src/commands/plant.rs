//! `halfrow-station plant`

use std::thread;
use std::time::Duration;

use clap::{Args, Subcommand};

use super::beginning::{SettingsFile, Signal};
use super::why::Why;
use super::{Failure, print};
use crate::console;
use crate::exit::Exit;
use crate::settings::{PlantSettings, PlantSettingsError, Settings};
use crate::store::{Plant, PlantAddress, PlantError};
use crate::web::{Access, App, Server, User, Who};

/// How often it is looked whether a signal came.
const LOOK: Duration = Duration::from_millis(100);

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
    /// Let a station have another folder than before: its disk was lost, or its computer replaced without a copy
    Forget {
        /// The station's name
        station: String,
        #[command(flatten)]
        why: Why,
    },
    /// Show the results of all stations in a browser; its pages only look
    Serve,
}

pub(super) fn run(Arguments { settings, what }: &Arguments) -> Result<Exit, Failure> {
    let settings = settings.load_plant()?;
    let address = plant(&settings)?.address()?;
    match what {
        What::Prepare => {
            let version = Plant::prepare(&address)?;
            print(&format!("the plant {address} has version {version}"))
        }
        What::Forget { station, why: Why { reason, operator } } => {
            if Plant::connect(&address)?.forget(station, operator, reason)? {
                return print(&format!("the next folder that says it is {station} is taken for it"));
            }
            Err(Failure::call(NoStation { station: station.clone() }))
        }
        What::Serve => serve(settings, address),
    }
}

fn serve(settings: Settings, plant: PlantAddress) -> Result<Exit, Failure> {
    let signal = Signal::heed()?;
    std::fs::create_dir_all(&settings.data).map_err(Failure::call)?;
    let everybody = User { name: String::new(), who: Who::Reader };
    let access = Access::of(&settings, everybody).map_err(Failure::call)?;
    let listener = Server::listen(access.listen()).map_err(Failure::call)?;
    let at = listener.local_addr().map_err(Failure::error)?;
    let app = App::of_plant(settings, plant, access.at(at.port()));
    let server = Server::start(&app, listener).map_err(Failure::error)?;
    console::tell(&format!("The pages are at http://{at}/"));
    let by = loop {
        match signal.by() {
            Some(by) => break by,
            None => thread::sleep(LOOK),
        }
    };
    server.close();
    Ok(halfrow::Cause::Stopped(by).into())
}

/// `[plant]` of these settings.
pub(super) fn plant(settings: &Settings) -> Result<&PlantSettings, Failure> {
    settings.plant.as_ref().ok_or_else(|| Failure::call(NoPlant))
}

/// Settings that name no plant.
#[derive(Debug, thiserror::Error)]
#[error("the settings name no plant; write url = \"postgres://halfrow@db.example/plant\" into [plant]")]
pub(super) struct NoPlant;

/// A station that the plant never heard of.
#[derive(Debug, thiserror::Error)]
#[error(
    "the plant has not heard of a station {station}; `halfrow-station plant serve` shows those that it has"
)]
pub(super) struct NoStation {
    pub(super) station: String,
}

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
