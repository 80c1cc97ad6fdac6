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
use crate::web::{Access, App, Server, User, Who};

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
    let everybody = User { name: arguments.operator.clone(), who: Who::Operator };
    serve(&settings, everybody)
}

/// Serves the station until a signal comes. Where nobody logs in, everybody at the computer itself is `everybody`.
pub(super) fn serve(settings: &Settings, everybody: User) -> Result<Exit, Failure> {
    let program = std::env::current_exe().map_err(Failure::error)?;
    let signal = signals::last().map_err(Failure::error)?;
    let mut store = Store::open(&Folder::new(&settings.data))?;
    let access = Access::of(settings, everybody).map_err(Failure::call)?;
    let listener = Server::listen(access.listen()).map_err(Failure::call)?;
    let at = listener.local_addr().map_err(Failure::error)?;
    recovered(&mut store)?;
    let engine = Engine::start(settings.clone(), store, program).map_err(Failure::error)?;
    let engine = Arc::new(engine);
    let app =
        App::new(settings.clone(), Arc::clone(&engine), access.at(at.port())).map_err(Failure::error)?;
    let server = Server::start(&app, listener).map_err(Failure::error)?;
    console::tell(&format!("the pages are at http://{at}/"));
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
