//! Signals that end runs.

use std::io;
use std::sync::Arc;
use std::sync::atomic::AtomicUsize;

use halfrow::verdict::StoppedBy;
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::flag;

use crate::exit::Exit;

/// Holds the exit code of the last signal, and 0 before.
pub(super) fn last() -> io::Result<Arc<AtomicUsize>> {
    let last = Arc::new(AtomicUsize::new(0));
    for (signal, exit) in [(SIGINT, Exit::Interrupted), (SIGTERM, Exit::Terminated), (SIGHUP, Exit::HungUp)] {
        flag::register_usize(signal, Arc::clone(&last), exit.code().into())?;
    }
    Ok(last)
}

/// Who wants it to end, of the exit code of the last signal.
pub(super) fn stopped_by(code: usize) -> Option<StoppedBy> {
    let by = [StoppedBy::Person, StoppedBy::System, StoppedBy::Disconnection];
    by.into_iter().find(|&by| usize::from(Exit::from(halfrow::Cause::Stopped(by)).code()) == code)
}
