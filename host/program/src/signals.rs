//! Signals: those that end a program, and one that must not end it.

use std::io;
use std::sync::Arc;

use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGXFSZ};

use crate::exit::Exit;

/// The signals that end what a program does, with their exit codes. SIGHUP is left out if the program was started with `nohup`, to
/// outlive its terminal.
pub fn ending() -> impl Iterator<Item = (i32, Exit)> {
    let all = [(SIGINT, Exit::Interrupted), (SIGTERM, Exit::Terminated), (SIGHUP, Exit::HungUp)];
    all.into_iter().filter(|(signal, _)| *signal != SIGHUP || !is_ignored(SIGHUP))
}

/// Whether this signal was set to be ignored when the program was started, as `nohup` does with SIGHUP. False if the system does
/// not say.
fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or_default();
    mask >> (signal - 1) & 1 == 1
}

/// Makes a write beyond the allowed file size (`ulimit -f`, systemd's `LimitFSIZE`) fail like any other write. Otherwise the
/// system would end the program without a word. This uses a handler, which programs started from this one do not inherit.
///
/// # Errors
/// The system's reason.
pub(crate) fn outlive_file_limit() -> io::Result<()> {
    signal_hook::flag::register(SIGXFSZ, Arc::default()).map(drop)
}
