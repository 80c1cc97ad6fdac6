//! `halfrow-station serve`

use std::path::{self, PathBuf};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::thread;
use std::time::Duration;

use clap::Args;

use super::{Failure, recovered, signals};
use crate::console;
use crate::engine::Engine;
use crate::exit::Exit;
use crate::settings::Settings;
use crate::store::{Folder, Store};
use crate::web::{Access, Address, App, Server, User, Who};

/// How often it is looked whether a signal came.
const LOOK: Duration = Duration::from_millis(100);

/// Judge the boards in all lanes of a station, with pages in a browser
///
/// Prints where the pages are. A signal ends the runs that are under way, and the program.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The station's settings
    #[arg(long, value_name = "FILE", env = "HALFROW_STATION_SETTINGS")]
    settings: PathBuf,
    /// Who tests, at a station where nobody logs in
    #[arg(long, value_name = "NAME", env = "USER", default_value = "unknown")]
    operator: String,
}

pub(super) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    let settings = path::absolute(&arguments.settings).map_err(Failure::call)?;
    let settings = Settings::load(&settings).map_err(Failure::call)?;
    let address = Address::new("127.0.0.1:8612", None, &[]).map_err(Failure::call)?;
    let operator = User { name: arguments.operator.clone(), who: Who::Operator };
    serve(settings, Access::open(address, operator))
}

/// Serves the station until a signal comes.
pub(super) fn serve(settings: Settings, access: Access) -> Result<Exit, Failure> {
    let program = std::env::current_exe().map_err(Failure::error)?;
    let signal = signals::last().map_err(Failure::error)?;
    let listener = Server::listen(access.listen()).map_err(Failure::call)?;
    let port = listener.local_addr().map_err(Failure::error)?.port();
    let mut store = Store::open(&Folder::new(&settings.data))?;
    recovered(&mut store)?;
    let engine = Engine::start(settings.clone(), store, program).map_err(Failure::error)?;
    let engine = Arc::new(engine);
    let app = App::new(settings, Arc::clone(&engine), access.at(port));
    let server = Server::start(&app, listener).map_err(Failure::error)?;
    console::tell(&format!("http://127.0.0.1:{port}/"));
    let by = loop {
        match signals::stopped_by(signal.load(Ordering::Relaxed)) {
            Some(by) => break by,
            None => thread::sleep(LOOK),
        }
    };
    engine.close(Some(by));
    server.close();
    Ok(halfrow::Cause::Stopped(by).into())
}
