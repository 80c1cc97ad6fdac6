//! The library's errors as Python's exceptions: the same codes, parameters, sentences and remedies.

use std::error::Error;
use std::io;

use halfrow::exit::Exit;
use halfrow::optics::OpticsError;
use halfrow::result::Problem;
use pyo3::prelude::*;

/// The command line's code for a wrong value.
const VALUE_WRONG: &str = "usage-value-wrong";
/// And for two options that exclude each other.
const CONFLICT: &str = "usage-arguments-conflict";
/// The code for a system that has no thread left.
const NO_THREAD: &str = "run-thread-missing";

/// Who is to blame for an error, which decides the exception's class.
#[derive(Clone, Copy)]
pub(crate) enum Whose {
    /// The call or something that it names: `halfrow.InputError`, which is also a `ValueError`. The command line exits with 2
    /// then.
    Call,
    /// Anything else: `halfrow.HalfrowError`.
    World,
}

impl Whose {
    /// `Call` if it is the call's fault, else `World`.
    pub(crate) const fn of_call(is_of_call: bool) -> Self {
        if is_of_call { Self::Call } else { Self::World }
    }
}

/// The exception for `error` in a call or in something that it names.
pub(crate) fn input<E: Error + 'static>(error: E) -> PyErr {
    refused(&error)
}

/// The exception for a call that is refused because of `error`. A full disk is no fault of the call.
pub(crate) fn refused(error: &(dyn Error + 'static)) -> PyErr {
    let whose = Whose::of_call(Exit::of_refusal(error) == Exit::Usage);
    exception(whose, &Problem::of(error).of_refusal(error))
}

/// The exception for a lens, tables or a kernel that cannot be used. Tables of another datapath are refused
/// like a board of another datapath.
pub(crate) fn optics(error: impl Into<OpticsError>) -> PyErr {
    let error = error.into();
    let is_of_call = !error.is_other_datapath() && !matches!(error, OpticsError::Damaged(_));
    if is_of_call { refused(&error) } else { failed(error) }
}

/// The exception for `error`, for which the call is not to blame.
pub(crate) fn failed<E: Error + 'static>(error: E) -> PyErr {
    raised(Whose::World, &error)
}

/// The exception for a run for which the system has no thread, as `error` says.
pub(crate) fn no_thread(error: &io::Error) -> PyErr {
    let told = format!(
        "this computer has no thread left to work on ({error}); end other programs, or allow this user more processes, then run again"
    );
    exception(Whose::World, &Problem::new(NO_THREAD, told))
}

/// The exception for an option that could not be converted from Python, as `error` says. It names the option as the caller
/// wrote it, not the types of this package.
pub(crate) fn not_taken(py: Python<'_>, error: &PyErr) -> PyErr {
    let Some(reason) = error.cause(py) else { return error.clone_ref(py) };
    let told = error.value(py).to_string();
    let option = told.rsplit_once('.').map_or(told.as_str(), |(_, option)| option);
    wrong_value(format!("{option} is not what verify takes: {}; see help(halfrow.verify)", reason.value(py)))
}

/// The exception for `error`.
pub(crate) fn raised(whose: Whose, error: &(dyn Error + 'static)) -> PyErr {
    exception(whose, &Problem::of(error))
}

/// The exception for a wrong argument. The message ends in what to do.
pub(crate) fn wrong_value(message: impl Into<String>) -> PyErr {
    exception(Whose::Call, &Problem::new(VALUE_WRONG, message))
}

/// The exception for an argument that has no effect beside another, or needs another.
pub(crate) fn conflict(message: impl Into<String>) -> PyErr {
    exception(Whose::Call, &Problem::new(CONFLICT, message))
}

fn exception(whose: Whose, problem: &Problem) -> PyErr {
    let class = match whose {
        Whose::Call => "InputError",
        Whose::World => "HalfrowError",
    };
    Python::attach(|py| {
        let made = || {
            let class = py.import("halfrow._errors")?.getattr(class)?;
            let told = serde_json::to_string(problem).unwrap_or_default();
            class.call_method1("_of_json", (told,))
        };
        made().map_or_else(|error| error, PyErr::from_value)
    })
}
