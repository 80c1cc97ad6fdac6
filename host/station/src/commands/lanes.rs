//! `halfrow-station lanes`

use std::io::{self, BufRead as _};
use std::path::PathBuf;
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::thread;
use std::time::Duration;

use clap::Args;

use super::Failure;
use super::beginning::{Disk, Ready, outbox, settings};
use super::publish::fetch_at_start;
use crate::console;
use crate::engine::News;
use crate::exit::Exit;
use crate::store::Store;

/// How often signals are checked for.
const LOOK: Duration = Duration::from_millis(100);

/// Judge the boards in all lanes of a station, with scans from stdin
///
/// Every line of stdin is a scan: a serial number, or HR:LANE:NAME, HR:START, HR:ABORT, HR:OUT, HR:IN, HR:MOCK. What
/// happens is printed, one JSON object per line. When stdin ends, the runs under way are finished; a signal ends them at
/// once.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The station's settings
    #[arg(long, value_name = "FILE", env = "HALFROW_STATION_SETTINGS")]
    settings: PathBuf,
    /// Who tests
    #[arg(long, value_name = "NAME", env = "USER", default_value = "unknown")]
    operator: String,
    #[command(flatten)]
    disk: Disk,
}

pub(super) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    fetch_at_start(&arguments.settings)?;
    let settings = settings(&arguments.settings)?;
    let ready = Ready::of(&settings, &arguments.disk)?;
    let signal = ready.signal.clone();
    let engine = ready.start()?;
    let news = engine.listen();
    let outbox = outbox(&settings, &engine)?;
    let printer = thread::Builder::new().name("news".to_owned()).spawn(move || print(&news));
    let printer = printer.map_err(Failure::error)?;
    let scans = scans().map_err(Failure::error)?;
    let by = loop {
        if let Some(by) = signal.by() {
            break Some(by);
        }
        match scans.recv_timeout(LOOK) {
            Ok((number, line)) => engine.scan(number, &line, &arguments.operator),
            Err(RecvTimeoutError::Timeout) if engine.has_ended() => return Err(Failure::error(EngineEnded)),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => break None,
        }
    };
    engine.close(by);
    outbox.close();
    engine.store().with(Store::fold_log);
    let _ = printer.join();
    Ok(by.map_or(Exit::Pass, |by| halfrow::Cause::Stopped(by).into()))
}

/// The station's engine has stopped.
#[derive(Debug, thiserror::Error)]
#[error("the station has stopped working, by a fault of its own that the log describes; start it again")]
pub(super) struct EngineEnded;

/// The lines of stdin, numbered, until its end.
fn scans() -> io::Result<Receiver<(u64, String)>> {
    let (sender, scans) = mpsc::channel();
    thread::Builder::new().name("scans".to_owned()).spawn(move || {
        // What is not UTF-8 gets characters that no label has, so it is refused.
        let text = |line: Vec<u8>| String::from_utf8_lossy(&line).trim_end_matches('\r').to_owned();
        let lines = io::stdin().lock().split(b'\n').map_while(Result::ok).map(text);
        // Once the station closes, nobody takes scans any more.
        (1..).zip(lines).take_while(|scan| sender.send(scan.clone()).is_ok()).for_each(drop);
    })?;
    Ok(scans)
}

fn print(news: &Receiver<News>) {
    for one in news {
        match serde_json::to_string(&one) {
            Ok(line) => console::tell(&line),
            Err(error) => tracing::error!("a piece of news is no JSON: {error}"),
        }
    }
}
