//! Signals that end runs.

use std::io;
use std::sync::Arc;
use std::sync::atomic::AtomicUsize;

use halfrow_program::signals::is_ignored;
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::flag;

use crate::exit::Exit;

/// The exit code of the last signal, or 0 before the first one.
pub(super) fn last() -> io::Result<Arc<AtomicUsize>> {
    let last = Arc::new(AtomicUsize::new(0));
    for (signal, exit) in [(SIGINT, Exit::Interrupted), (SIGTERM, Exit::Terminated), (SIGHUP, Exit::HungUp)] {
        // Whoever starts a program with `nohup` wants it to outlive the terminal.
        if signal == SIGHUP && is_ignored(SIGHUP) {
            continue;
        }
        flag::register_usize(signal, Arc::clone(&last), exit.code().into())?;
    }
    Ok(last)
}
