//! What whoever started a program wants it to hear, and what it must not die of.

use std::io;
use std::sync::Arc;

use signal_hook::consts::SIGXFSZ;

/// Whether whoever started the program wants it not to hear this signal, as far as the system tells: `nohup` does so with SIGHUP.
#[must_use]
pub fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or_default();
    mask >> (signal - 1) & 1 == 1
}

/// Makes a write beyond the longest file that is allowed (`ulimit -f`, systemd's `LimitFSIZE`) fail like any other. The system would end
/// the program without a word. A handler does it, which no program that is started from this one inherits.
///
/// # Errors
/// The system's reason.
pub fn outlive_file_limit() -> io::Result<()> {
    signal_hook::flag::register(SIGXFSZ, Arc::default()).map(drop)
}
