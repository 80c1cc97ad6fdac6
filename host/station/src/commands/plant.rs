//! `halfrow-station plant`

use clap::{Args, Subcommand};
use halfrow::words::{count, verb};
use halfrow_program::number::counted;

use super::beginning::{SettingsFile, Signal, make_data, plant};
use super::fetching::{address, published};
use super::progress::teller;
use super::why::{Why, at_plant};
use super::{Failure, check, tell};
use crate::check::check_plant;
use crate::console;
use crate::exit::Exit;
use crate::settings::Settings;
use crate::store::{Plant, Snapshot};
use crate::web::{Access, App, Server, User, Who};

/// Keep the results of all stations in one PostgreSQL database
///
/// `[plant]` of the settings says where it is. Stations fill it by themselves, and go on without it.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    settings: SettingsFile,
    #[command(subcommand)]
    what: Action,
}

#[derive(Debug, Subcommand)]
enum Action {
    /// Make the plant's tables, or bring them up to date with a copy of all that is in them
    Prepare,
    /// Let a station have another folder than before: its disk was lost, or its computer replaced without a copy
    Forget {
        /// The station's name
        station: String,
        #[command(flatten)]
        why: Why,
    },
    /// Read everything that the plant keeps, and say what is not as it was sent
    ///
    /// Every record's hash is computed again, and all tables are made a second time from the records and compared: in
    /// memory, and beyond 64 MiB in a file in the folder that SQLITE_TMPDIR or TMPDIR names. Exit codes: 0 all is as it was
    /// sent, 3 something is not.
    Check {
        /// Print JSON
        #[arg(long)]
        json: bool,
    },
    /// Remove the steps and measurements of old runs, which their records have; runs, records and what is counted are kept for ever
    Prune {
        /// Of runs that began longer ago; 1 or more
        #[arg(long, value_name = "DAYS", value_parser = counted::<u32>(1, None))]
        older_than: u32,
        #[command(flatten)]
        why: Why,
    },
    /// Show the results of all stations in a browser; its pages change nothing
    Serve,
}

pub(super) fn run(Arguments { settings, what }: &Arguments) -> Result<Exit, Failure> {
    // The plans are not loaded, because those of the plant can be fetched only once it has tables.
    let address = || address(&published(settings)?);
    match what {
        Action::Prepare => {
            let address = address()?;
            let version = Plant::prepare(&address.patient())?;
            Ok(tell(&format!("the plant {address} has version {version}")))
        }
        Action::Forget { station, why } => {
            let mut plant = at_plant(&address()?, &why.operator, &format!("plant forget {station}"))?;
            if plant.forget(station, why.by())? {
                return Ok(tell(&format!("the next folder that says it is {station} is taken for it")));
            }
            Err(Failure::call(NoStation { station: station.clone() }))
        }
        Action::Check { json } => {
            let snapshot = Snapshot::of_plant(Plant::connect(&address()?.patient())?)?;
            check::tell(&check_plant(&snapshot, &mut teller())?, *json)
        }
        Action::Prune { older_than, why } => {
            let mut plant = at_plant(&address()?.patient(), &why.operator, "plant prune")?;
            let removed = plant.prune(*older_than, why.by(), &mut teller())?;
            let (rows, were) = (count(removed, "row"), verb(removed, "were"));
            Ok(tell(&format!("{rows} {were} removed; every record is kept")))
        }
        Action::Serve => serve(settings.load_without_lanes()?),
    }
}

fn serve(settings: Settings) -> Result<Exit, Failure> {
    let address = plant(&settings)?.address()?;
    let signal = Signal::heed()?;
    make_data(&settings)?;
    let everybody = User { name: String::new(), who: Who::Reader };
    let access = Access::of(&settings, everybody)?;
    let listener = Server::listen(access.listen()).map_err(Failure::call)?;
    let at = listener.local_addr().map_err(Failure::error)?;
    let app = App::of_plant(settings, address, access.at(at.port()));
    let server = Server::start(&app, listener).map_err(Failure::error)?;
    console::tell(&format!("The pages are at http://{at}/"));
    let by = signal.wait(|| server.refuse_ended().map_err(Failure::error))?;
    server.close();
    Ok(halfrow::Cause::Stopped(by).into())
}

/// The plant does not know a station of this name.
#[derive(Debug, thiserror::Error)]
#[error(
    "the plant has not heard of a station {station}; `halfrow-station plant serve` shows those that it has"
)]
pub(super) struct NoStation {
    pub(super) station: String,
}
