//! The log of a program.

use tracing::level_filters::LevelFilter;

use crate::console;

/// Sends what is logged to stderr: warnings alone at `verbosity` 0, at 1 what happens, and above it every packet that is late or
/// damaged. The first call in a process counts.
pub fn to_stderr(verbosity: u8) {
    let level = match verbosity {
        0 => LevelFilter::WARN,
        1 => LevelFilter::INFO,
        _ => LevelFilter::DEBUG,
    };
    // Somebody who embeds the program may log by ways of his own.
    let _ = tracing_subscriber::fmt()
        .with_max_level(level)
        .with_writer(|| console::Log)
        .log_internal_errors(false)
        .with_ansi(false)
        .without_time()
        .with_target(false)
        .try_init();
}
