//! `halfrow-station lanes`

use std::io::{self, BufRead};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::time::Duration;
use std::{iter, thread};

use clap::Args;
use halfrow::words::plain;

use super::Failure;
use super::beginning::{Disk, Ready, Sending, SettingsFile};
use super::fetching::fetch_at_start;
use crate::console;
use crate::engine::{EngineEnded, News};
use crate::exit::Exit;
use crate::store::LastTold;

/// How often signals are checked for.
const LOOK: Duration = Duration::from_millis(100);

/// Judge the boards in all lanes of a station, with scans from stdin
///
/// Every whole line of stdin is a scan: a serial number, or HR:LANE:NAME, HR:START, HR:ABORT, HR:OUT, HR:IN, HR:MOCK. What
/// happens is printed, one JSON object per line. When stdin ends, the runs under way are finished; a signal ends them at
/// once.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    settings: SettingsFile,
    /// Who tests
    #[arg(long, value_name = "NAME", env = "USER", default_value = "unknown")]
    operator: String,
    #[command(flatten)]
    disk: Disk,
}

pub(super) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    fetch_at_start(&arguments.settings)?;
    let settings = arguments.settings.load()?;
    let ready = Ready::of(&settings, &arguments.disk)?;
    let signal = ready.signal.clone();
    let engine = ready.start()?;
    let news = engine.listen();
    let sending = Sending::begin(&settings, engine.store(), &LastTold::default())?;
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
            Err(RecvTimeoutError::Timeout) => sending.refuse_ended()?,
            Err(RecvTimeoutError::Disconnected) => break None,
        }
    };
    engine.close(by);
    let _ = printer.join();
    Ok(by.map_or(Exit::Pass, |by| halfrow::Cause::Stopped(by).into()))
}

/// The lines of stdin, numbered, until its end.
fn scans() -> io::Result<Receiver<(u64, String)>> {
    let (sender, scans) = mpsc::channel();
    thread::Builder::new().name("scans".to_owned()).spawn(move || {
        let mut stdin = io::stdin().lock();
        let lines = iter::from_fn(|| line(&mut stdin));
        // Once the station closes, nobody takes scans any more.
        (1..).zip(lines).take_while(|scan| sender.send(scan.clone()).is_ok()).for_each(drop);
    })?;
    Ok(scans)
}

/// The next line; none at the end. A line without an end is no scan: a scanner that was pulled out has sent only a part of a label.
fn line(from: &mut impl BufRead) -> Option<String> {
    let mut line = Vec::new();
    from.read_until(b'\n', &mut line).ok()?;
    // What is not UTF-8 gets characters that no label has, so it is refused.
    let text = String::from_utf8_lossy(&line);
    match text.strip_suffix('\n') {
        Some(label) => Some(label.trim_end_matches('\r').to_owned()),
        None if text.is_empty() => None,
        None => {
            tracing::warn!("stdin ended within a scan, which is not taken: {}", plain(&text));
            None
        }
    }
}

fn print(news: &Receiver<News>) {
    for one in news {
        match serde_json::to_string(&one) {
            Ok(line) => console::tell(&line),
            Err(error) => tracing::error!("a piece of news is no JSON: {error}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Some serial numbers begin with another one.
    #[test]
    fn a_label_that_was_cut_off_is_no_scan() {
        let mut stdin = b"CAT00001\r\n\xff\n\nCAT000".as_slice();
        let lines: Vec<_> = iter::from_fn(|| line(&mut stdin)).collect();
        assert_eq!(lines, ["CAT00001", "\u{fffd}", ""]);
    }
}
