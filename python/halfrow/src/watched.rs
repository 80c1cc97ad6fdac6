//! Work on a thread of its own, while the one that called listens to Python's signals and tells of progress.

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use halfrow::progress::{Event, Progress};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

use crate::errors;

/// How long a signal may wait for somebody to look.
const LOOK: Duration = Duration::from_millis(20);

/// What the work tells.
enum Told<T> {
    Event(Event),
    Result(T),
}

/// The result of `work`, whose events go to `listener`. Python's lock is free meanwhile.
///
/// A signal handler or a listener that raises, as Ctrl-C does, sets `is_stopped`; the exception is passed on as soon as the work
/// has ended in order, or at once when another is raised before; the work then goes on to that end behind it.
pub(crate) fn watched<T: Send + 'static>(
    py: Python<'_>,
    listener: Option<&Bound<'_, PyAny>>,
    is_stopped: &AtomicBool,
    work: impl FnOnce(&dyn Progress) -> T + Send + 'static,
) -> PyResult<T> {
    let (sender, told) = mpsc::channel();
    let worker = thread::Builder::new().name("run".to_owned()).spawn(move || {
        let events = sender.clone();
        // Whoever called may be gone.
        let result = work(&move |event| _ = events.send(Told::Event(event)));
        _ = sender.send(Told::Result(result));
    });
    let worker = worker.map_err(|error| errors::no_thread(&error))?;
    let told = Mutex::new(told);
    let mut raised: Option<PyErr> = None;
    loop {
        let next = py.detach(|| {
            told.lock().map_or(Err(RecvTimeoutError::Disconnected), |told| told.recv_timeout(LOOK))
        });
        let outcome = match next {
            Ok(Told::Result(result)) => return raised.map_or(Ok(result), Err),
            Ok(Told::Event(event)) if raised.is_none() => {
                tell(listener, &event).and_then(|()| py.check_signals())
            }
            Ok(Told::Event(_)) | Err(RecvTimeoutError::Timeout) => py.check_signals(),
            Err(RecvTimeoutError::Disconnected) => return Err(without_result(worker)),
        };
        if let Err(error) = outcome {
            if raised.is_some() {
                return Err(error);
            }
            is_stopped.store(true, Ordering::Relaxed);
            raised = Some(error);
        }
    }
}

/// Goes on with the panic of a worker that has left no result.
fn without_result(worker: JoinHandle<()>) -> PyErr {
    match worker.join() {
        Err(panic) => std::panic::resume_unwind(panic),
        Ok(()) => PyRuntimeError::new_err(
            "the run ended without a result; this is a fault of halfrow, so report it",
        ),
    }
}

/// Calls `listener` with the event's kind, its words and its rows.
fn tell(listener: Option<&Bound<'_, PyAny>>, event: &Event) -> PyResult<()> {
    let Some(listener) = listener else { return Ok(()) };
    let (kind, words, rows) = match event {
        Event::Step(step) => ("step", step.to_string(), 0),
        Event::RowsExpected(rows) => ("rows-expected", String::new(), *rows),
        Event::Frame(name) => ("frame", name.clone(), 0),
        Event::Rows(rows) => ("rows", String::new(), *rows),
        // A soak's, which this package does not begin.
        Event::Soaked(_) => return Ok(()),
        Event::Done => ("done", String::new(), 0),
    };
    listener.call1((kind, words, rows)).map(drop)
}
