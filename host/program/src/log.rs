//! The log of a program.

use tracing::level_filters::LevelFilter;

use crate::console;

/// Sends the log to stderr: only warnings at `verbosity` 0, what happens at 1, and above that every packet that is late or
/// damaged. Only the first call in a process counts.
pub fn to_stderr(verbosity: u8) {
    let level = match verbosity {
        0 => LevelFilter::WARN,
        1 => LevelFilter::INFO,
        _ => LevelFilter::DEBUG,
    };
    // It fails if an embedding program has already set up a log of its own.
    let _ = tracing_subscriber::fmt()
        .with_max_level(level)
        .with_writer(|| console::Log)
        .log_internal_errors(false)
        .with_ansi(false)
        .without_time()
        .with_target(false)
        .try_init();
}
