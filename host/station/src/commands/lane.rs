//! `halfrow-station lane`, which the station starts for every run.

use std::fs;
use std::io::{self, BufRead as _};
use std::process;
use std::thread;

use clap::Args;
use nix::sys::resource::{Resource, getrlimit, setrlimit};
use nix::sys::signal::{SigSet, Signal};

use super::Failure;
use crate::console;
use crate::exit::Exit;
use crate::lane::child::{Orders, carry_out, orders};
use crate::lane::{Control, FILE_MIB, LaneJob, Message};

/// The program's name, which has the 15 letters that the system keeps.
const PROGRAM: &str = "halfrow-station";

/// Carry out one run; the station starts it
#[derive(Debug, Args)]
#[command(hide = true)]
pub(super) struct Arguments {}

pub(super) fn run(_: &Arguments) -> Result<Exit, Failure> {
    name();
    let mut line = String::new();
    io::stdin().lock().read_line(&mut line).map_err(Failure::error)?;
    let job: LaneJob = serde_json::from_str(&line).map_err(|error| {
        let why = anyhow::Error::from(error);
        Failure::call(why.context("the first line is no job; `halfrow-station run` starts lanes, not people"))
    })?;
    limit(job.memory_mib).map_err(Failure::error)?;
    let (orders, heeded) = orders();
    thread::Builder::new().name("stdin".to_owned()).spawn(move || heed(&orders)).map_err(Failure::error)?;
    carry_out(&job, &heeded, &|message: &Message| {
        // A station that no longer listens is gone, and the end of stdin then ends this process.
        if let Ok(line) = serde_json::to_string(message) {
            let _ = console::print(&line);
        }
    });
    Ok(Exit::Pass)
}

/// Names the process after the station; otherwise the system names it after the path that it was started by.
fn name() {
    if let Err(error) = fs::write("/proc/self/comm", PROGRAM) {
        tracing::debug!("the process has no name: {error}");
    }
}

/// Limits the process to `mib` MiB of addresses. If more is needed, this process ends, and not the station or another lane.
/// Likewise what it logs does not fill the station's disk: its files are limited, too. What has no room there is lost, and not
/// the run: the signal that would end the process is kept back, in all threads that begin later.
fn limit(mib: u64) -> nix::Result<()> {
    limit_to(Resource::RLIMIT_AS, mib)?;
    SigSet::from_iter([Signal::SIGXFSZ]).thread_block()?;
    limit_to(Resource::RLIMIT_FSIZE, FILE_MIB)
}

/// Limits a resource to `mib` MiB, or to what was allowed before if that is less.
fn limit_to(resource: Resource, mib: u64) -> nix::Result<()> {
    let (_, most) = getrlimit(resource)?;
    let bytes = mib.saturating_mul(1 << 20).min(most);
    setrlimit(resource, bytes, bytes)
}

/// Heeds what the station says until the station is gone, and then ends the process.
fn heed(orders: &Orders) {
    for line in io::stdin().lock().lines().map_while(Result::ok) {
        if let Ok(control) = serde_json::from_str::<Control>(&line) {
            orders.take(control);
        }
    }
    process::exit(Exit::Error.code().into());
}
