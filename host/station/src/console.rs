//! The standard streams. Nothing else of the program writes to them, and a stream that takes nothing ends no run.

// Here alone.
#![allow(clippy::disallowed_methods)]

use std::fmt::Display;
use std::io::{self, Write};

/// A result that stdout did not take.
#[derive(Debug, thiserror::Error)]
#[error("the result cannot be written to stdout; free some space where it goes, or send it elsewhere")]
pub struct Unprinted(#[source] io::Error);

/// Prints a result and a line's end to stdout. A reader that went away, as `head` does, has seen enough.
///
/// # Errors
/// [`Unprinted`] when stdout does not take it.
pub fn print(text: &str) -> Result<(), Unprinted> {
    let mut stdout = io::stdout().lock();
    match writeln!(stdout, "{text}").and_then(|()| stdout.flush()) {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        written => written.map_err(Unprinted),
    }
}

/// Prints what is not the only result of a command: its exit code says it, too. If stdout does not take it, stderr says
/// so.
pub fn tell(text: &str) {
    if let Err(unprinted) = print(text) {
        error(&format_args!("{:#}; the exit code stands", anyhow::Error::from(unprinted)));
    }
}

/// Says on stderr what went wrong, if it can be said.
pub fn error(what: &dyn Display) {
    // Nobody is left to be told that this cannot be told.
    let _ = writeln!(io::stderr().lock(), "error: {what}");
}

/// Asks on stderr for something that is typed behind it.
pub fn ask(what: &str) {
    let mut stderr = io::stderr().lock();
    // Whoever types blind knows what is asked.
    let _ = write!(stderr, "{what}: ").and_then(|()| stderr.flush());
}

/// Where the log goes: stderr, which takes it or does not.
#[derive(Clone, Copy, Debug)]
pub struct Log;

impl Write for Log {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let _ = io::stderr().lock().write_all(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
