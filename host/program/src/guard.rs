//! Faults of the program itself: a panic becomes an error of the command and never ends the process by itself.

use std::any::Any;
use std::backtrace::{Backtrace, BacktraceStatus};
use std::panic::{self, AssertUnwindSafe, PanicHookInfo};
use std::process::ExitCode;
use std::sync::Mutex;

use crate::console;
use crate::exit::Exit;
use crate::signals;

/// The program itself failed (a panic).
#[derive(Debug, thiserror::Error)]
#[error(
    "the program itself has failed: {0}; run it again, and report this line with the call that led to it"
)]
pub struct InternalError(String);

/// Message and place of the first panic, since a panic that comes through other threads loses its place.
static FIRST: Mutex<Option<String>> = Mutex::new(None);

/// Runs `run` and returns its result as the process's exit code. A panic is reported and becomes an error.
pub fn end(run: impl FnOnce() -> Exit) -> ExitCode {
    // If the system takes no handler, such a write ends the program; nothing else changes.
    let _ = signals::outlive_file_limit();
    panic::set_hook(Box::new(note));
    let exit = guarded(run).unwrap_or_else(|fault| {
        console::error(&fault);
        Exit::Error
    });
    ExitCode::from(exit.code())
}

/// What `run` returns.
///
/// # Errors
/// [`InternalError`] when it panics, or a thread panics whose panic it passes on. In a program that [`end`] runs, the error names
/// the panic's place.
pub fn guarded<T>(run: impl FnOnce() -> T) -> Result<T, InternalError> {
    // Earlier panics were dealt with.
    drop(first());
    panic::catch_unwind(AssertUnwindSafe(run)).map_err(|panic| {
        let said = first().or_else(|| said_by(&*panic).map(str::to_owned));
        InternalError(said.unwrap_or_else(|| "for no reason that is known".to_owned()))
    })
}

fn first() -> Option<String> {
    FIRST.lock().ok().and_then(|mut first| first.take())
}

fn said_by(panic: &(dyn Any + Send)) -> Option<&str> {
    panic.downcast_ref::<String>().map(String::as_str).or_else(|| panic.downcast_ref::<&str>().copied())
}

/// Keeps what a panic says, and writes its backtrace if `RUST_BACKTRACE` asks for one.
fn note(panic: &PanicHookInfo<'_>) {
    let message = panic.payload_as_str().unwrap_or("a panic without a message");
    let place = panic.location().map_or_else(String::new, |place| format!(" ({place})"));
    if let Ok(mut first) = FIRST.lock() {
        first.get_or_insert_with(|| format!("{message}{place}"));
    }
    let trace = Backtrace::capture();
    if trace.status() == BacktraceStatus::Captured {
        console::diagnose(&format_args!("{message}{place}\n{trace}"));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_an_error_that_says_what_and_where() {
        let said = guarded(|| panic!("{} fell", "the moon")).map(|()| 0).unwrap_err().to_string();
        assert!(said.contains("has failed: the moon fell;"), "{said}");
        panic::set_hook(Box::new(note));
        assert_eq!(guarded(|| 7).unwrap(), 7);
        // A panic that was dealt with is not mistaken for the next.
        assert!(guarded(|| panic::catch_unwind(|| panic!("a cloud")).is_err()).unwrap());
        let said = guarded(|| panic!("the sky fell")).map(|()| 0).unwrap_err().to_string();
        assert!(said.contains("the sky fell (") && said.contains("guard.rs:"), "{said}");
        let behind = || std::thread::scope(|scope| scope.spawn(|| panic!("below ground")).join().is_ok());
        let said = guarded(|| assert!(behind())).unwrap_err().to_string();
        assert!(said.contains("below ground"), "{said}");
    }
}
