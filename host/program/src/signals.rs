//! Signals: those that the program was started to ignore, and one that must not end it.

use std::io;
use std::sync::Arc;

use signal_hook::consts::SIGXFSZ;

/// Whether this signal was set to be ignored when the program was started, as `nohup` does with SIGHUP. False if the system does
/// not say.
#[must_use]
pub fn is_ignored(signal: i32) -> bool {
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
pub fn outlive_file_limit() -> io::Result<()> {
    signal_hook::flag::register(SIGXFSZ, Arc::default()).map(drop)
}
