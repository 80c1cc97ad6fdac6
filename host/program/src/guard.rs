//! Faults of the program itself: a panic becomes an error of the command and never ends the process by itself.

use std::any::Any;
use std::backtrace::{Backtrace, BacktraceStatus};
use std::collections::VecDeque;
use std::panic::{self, AssertUnwindSafe, PanicHookInfo};
use std::process::ExitCode;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread::{self, ThreadId};

use crate::console;
use crate::exit::Exit;
use crate::signals;

/// The program itself failed (a panic).
#[derive(Debug, thiserror::Error)]
#[error(
    "the program itself has failed: {0}; run it again, and report this line with the call that led to it"
)]
pub struct InternalError(String);

/// The last panics, since a panic that comes through other threads loses its place.
static PANICS: Mutex<Panics> = Mutex::new(Panics { noted: 0, last: VecDeque::new() });
/// How many of them are kept.
const MOST_KEPT: usize = 64;
/// What a panic says that only tells of one in a thread of its scope (`std::thread::scope`).
const IN_SCOPE: &str = "a scoped thread panicked";

struct Panics {
    /// How many there were.
    noted: u64,
    last: VecDeque<Panic>,
}

struct Panic {
    /// How many there were before it.
    number: u64,
    thread: ThreadId,
    message: String,
    place: String,
}

impl Panics {
    fn note(&mut self, message: String, place: String) {
        self.last.truncate(MOST_KEPT - 1);
        self.last.push_front(Panic { number: self.noted, thread: thread::current().id(), message, place });
        self.noted += 1;
    }

    /// Message and place of the panic that came to this thread with `message`, if it was noted after the first `begun`: its own, or
    /// that of a thread whose panic it passed on.
    fn of(&self, message: &str, begun: u64) -> Option<String> {
        let of_this = |panic: &&Panic| panic.thread == thread::current().id();
        let since = || self.last.iter().take_while(|panic| panic.number >= begun);
        let is_it = |panic: &&Panic| panic.message == message;
        let below = since().filter(|panic| message == IN_SCOPE && !of_this(panic)).last();
        let found = below.or_else(|| since().filter(is_it).find(of_this)).or_else(|| since().find(is_it));
        found.map(|Panic { message, place, .. }| format!("{message}{place}"))
    }
}

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
    let begun = panics().noted;
    panic::catch_unwind(AssertUnwindSafe(run)).map_err(|panic| {
        let said = said_by(&*panic);
        let noted = panics().of(said.unwrap_or(NO_MESSAGE), begun);
        let said = noted.or_else(|| said.map(str::to_owned));
        InternalError(said.unwrap_or_else(|| "for no reason that is known".to_owned()))
    })
}

fn panics() -> MutexGuard<'static, Panics> {
    PANICS.lock().unwrap_or_else(PoisonError::into_inner)
}

fn said_by(panic: &(dyn Any + Send)) -> Option<&str> {
    panic.downcast_ref::<String>().map(String::as_str).or_else(|| panic.downcast_ref::<&str>().copied())
}

/// What is said of a panic that says nothing.
const NO_MESSAGE: &str = "a panic without a message";

/// Keeps what a panic says, and writes its backtrace if `RUST_BACKTRACE` asks for one.
fn note(panic: &PanicHookInfo<'_>) {
    let message = panic.payload_as_str().unwrap_or(NO_MESSAGE);
    let place = panic.location().map_or_else(String::new, |place| format!(" ({place})"));
    panics().note(message.to_owned(), place.clone());
    let trace = Backtrace::capture();
    if trace.status() == BacktraceStatus::Captured {
        console::diagnose(&format_args!("{message}{place}"));
        trace.to_string().lines().for_each(|line| console::diagnose(&line));
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
        // Another thread's panic that nobody passed on is not mistaken for it.
        let apart = || thread::spawn(|| panic!("the floor fell")).join().is_err();
        let said = guarded(|| assert!(!apart(), "the roof fell")).unwrap_err().to_string();
        assert!(said.contains("the roof fell ("), "{said}");
        let passed_on = || thread::spawn(|| panic!("below ground")).join().map_err(panic::resume_unwind);
        let said = guarded(passed_on).unwrap_err().to_string();
        assert!(said.contains("below ground (") && said.contains("guard.rs:"), "{said}");
        // A scope says only that a thread panicked.
        let said = guarded(|| thread::scope(|scope| _ = scope.spawn(|| panic!("under water"))));
        assert!(said.as_ref().unwrap_err().to_string().contains("under water ("), "{said:?}");
    }
}
