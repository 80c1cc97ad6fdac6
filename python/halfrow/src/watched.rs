//! Work on a thread of its own, while the calling thread handles Python's signals and reports progress.

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use halfrow::progress::{Event, Progress};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

use crate::errors;

/// How long a signal may have to wait.
const LOOK: Duration = Duration::from_millis(20);

/// A message from the work.
enum Message<T> {
    Event(Event),
    Result(T),
}

/// The result of `work`, whose events go to `listener`. Python's lock is released meanwhile.
///
/// If a signal handler (such as that of Ctrl-C) or the listener raises, `is_stopped` is set, and the exception is passed on when
/// the work has ended in order. If another exception is raised before that, it is passed on at once, and the work ends by itself
/// on its thread. Work that cannot be stopped has no `is_stopped`: then the first exception is passed on at once.
pub(crate) fn watched<T: Send + 'static>(
    py: Python<'_>,
    listener: Option<&Bound<'_, PyAny>>,
    is_stopped: Option<&AtomicBool>,
    work: impl FnOnce(&dyn Progress) -> T + Send + 'static,
) -> PyResult<T> {
    let (sender, told) = mpsc::channel();
    let worker = thread::Builder::new().name("run".to_owned()).spawn(move || {
        let events = sender.clone();
        // The caller may be gone.
        let result = work(&move |event| _ = events.send(Message::Event(event)));
        _ = sender.send(Message::Result(result));
    });
    let worker = worker.map_err(|error| errors::no_thread(&error))?;
    let told = Mutex::new(told);
    let mut raised: Option<PyErr> = None;
    loop {
        let next = py.detach(|| {
            told.lock().map_or(Err(RecvTimeoutError::Disconnected), |told| told.recv_timeout(LOOK))
        });
        let outcome = match next {
            Ok(Message::Result(result)) => return raised.map_or(Ok(result), Err),
            Ok(Message::Event(event)) if raised.is_none() => {
                tell(listener, &event).and_then(|()| py.check_signals())
            }
            Ok(Message::Event(_)) | Err(RecvTimeoutError::Timeout) => py.check_signals(),
            Err(RecvTimeoutError::Disconnected) => return Err(without_result(worker)),
        };
        if let Err(error) = outcome {
            let Some(is_stopped) = is_stopped.filter(|_| raised.is_none()) else { return Err(error) };
            is_stopped.store(true, Ordering::Relaxed);
            raised = Some(error);
        }
    }
}

/// Resumes the panic of a worker that has left no result.
fn without_result(worker: JoinHandle<()>) -> PyErr {
    match worker.join() {
        Err(panic) => std::panic::resume_unwind(panic),
        Ok(()) => PyRuntimeError::new_err(
            "the run ended without a result; this is a fault of halfrow, so report it",
        ),
    }
}

/// Calls `listener` with the event's kind, name and rows.
fn tell(listener: Option<&Bound<'_, PyAny>>, event: &Event) -> PyResult<()> {
    let Some(listener) = listener else { return Ok(()) };
    let (kind, name, rows) = match event {
        Event::Step(step) => ("step", step.name().to_owned(), 0),
        Event::RowsExpected(rows) => ("rows-expected", String::new(), *rows),
        Event::Frame(name) => ("frame", name.clone(), 0),
        Event::AtSpeed(judged) => ("frame", judged.to_string(), 0),
        Event::Rows(rows) => ("rows", String::new(), *rows),
        // An event of a soak, which this package never starts.
        Event::Soaked(_) => return Ok(()),
        Event::Done => ("done", String::new(), 0),
    };
    listener.call1((kind, name, rows)).map(drop)
}
