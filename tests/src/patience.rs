//! Waiting for what a test needs to see. How busy the machine is decides nothing: the limit only ends a hang.

use std::panic::resume_unwind;
use std::process::{Child, ExitStatus};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::{Duration, Instant};

/// Far longer than anything takes that ends at all.
pub const LIMIT: Duration = Duration::from_secs(300);

/// How often the condition is checked.
const TICK: Duration = Duration::from_millis(2);

/// Waits until `is_done`.
///
/// # Panics
/// When that takes longer than [`LIMIT`].
pub fn wait_until(what: &str, mut is_done: impl FnMut() -> bool) {
    let begun = Instant::now();
    while !is_done() {
        assert!(begun.elapsed() < LIMIT, "waited in vain: {what}");
        thread::sleep(TICK);
    }
}

/// The exit status of `child`, which must end.
///
/// # Panics
/// When it does not end within [`LIMIT`].
pub fn end_of(child: &mut Child) -> ExitStatus {
    let mut status = None;
    wait_until("a program to end", || {
        status = child.try_wait().unwrap();
        status.is_some()
    });
    status.unwrap()
}

/// The result of `work`, which must come to an end.
///
/// # Panics
/// When it does not end within [`LIMIT`], and when `work` panics.
pub fn come_to_an_end<T: Send + 'static>(work: impl FnOnce() -> T + Send + 'static) -> T {
    come_to_an_end_within(LIMIT, work).unwrap_or_else(|| panic!("it hangs: nothing came of it in {LIMIT:?}"))
}

/// The result of `work`; none if there is none within `limit`, and always if that is zero: then its thread is left running.
///
/// # Panics
/// When `work` panics.
pub fn come_to_an_end_within<T: Send + 'static>(
    limit: Duration,
    work: impl FnOnce() -> T + Send + 'static,
) -> Option<T> {
    let (say, hear) = channel();
    let thread = thread::spawn(move || {
        // Nobody listens any more when it took too long.
        let _ = say.send(work());
    });
    if limit.is_zero() {
        return None;
    }
    match hear.recv_timeout(limit) {
        Ok(result) => Some(result),
        Err(RecvTimeoutError::Timeout) => None,
        Err(RecvTimeoutError::Disconnected) => resume_unwind(thread.join().unwrap_err()),
    }
}
