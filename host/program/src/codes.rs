//! The codes of errors that both programs have, and how a page lists codes.

use std::error::Error;

use clap::error::ErrorKind;
use halfrow::result::Problem;
use halfrow::result::codes::{self, CodeList, Coded};

use crate::console::Unprinted;
use crate::exit::Exit;
use crate::guard::InternalError;

codes::codes! {
    ;
    Unprinted => "result-not-printed"
    ;
    InternalError => "program-failed"
}

/// The call contradicts itself or its input; the message says how.
const REFUSED: &str = "call-refused";
/// The command could not be carried out; the message says why.
const FAILED: &str = "command-failed";
/// The codes of errors without a type of their own.
pub const UNTYPED: [&str; 3] = [REFUSED, FAILED, codes::FOREIGN];
/// The command line cannot be used: an argument is unknown, missing, wrong, or in conflict with another.
pub const USAGE: [&str; 6] = [
    "usage-argument-unknown",
    "usage-value-wrong",
    "usage-argument-missing",
    "usage-arguments-conflict",
    "usage-command-unknown",
    "usage-wrong",
];

/// The codes of the types of errors that both programs have.
#[must_use]
pub fn lists() -> &'static [CodeList] {
    LISTS
}

/// The code of an error of both programs, of the library, or of the system.
#[must_use]
pub fn known(error: &(dyn Error + 'static)) -> Option<Coded> {
    lookup(error).or_else(|| codes::lookup(error))
}

/// Why a command has no result, with the code that `known` returns for the error.
#[must_use]
pub fn problem(
    exit: Exit,
    error: &anyhow::Error,
    known: fn(&(dyn Error + 'static)) -> Option<Coded>,
) -> Problem {
    let problem = Problem::by(error.as_ref(), known);
    if problem.code != codes::FOREIGN {
        return problem;
    }
    Problem { code: if exit == Exit::Usage { REFUSED } else { FAILED }.to_owned(), ..problem }
}

/// The code of `problem`; none if the error has no type of its own, so that `explain` has nothing more to say.
pub(crate) fn explained(problem: &Problem) -> Option<&str> {
    Some(problem.code.as_str()).filter(|code| !UNTYPED.contains(code))
}

/// The code of a command line that cannot be read.
pub(crate) fn of_usage(kind: ErrorKind) -> &'static str {
    USAGE[match kind {
        ErrorKind::UnknownArgument => 0,
        ErrorKind::InvalidValue | ErrorKind::ValueValidation | ErrorKind::InvalidUtf8 => 1,
        ErrorKind::MissingRequiredArgument
        | ErrorKind::NoEquals
        | ErrorKind::TooFewValues
        | ErrorKind::WrongNumberOfValues => 2,
        ErrorKind::ArgumentConflict | ErrorKind::TooManyValues => 3,
        ErrorKind::InvalidSubcommand | ErrorKind::MissingSubcommand => 4,
        _ => 5,
    }]
}

/// Lists of codes in Markdown, each under the name of its type.
pub fn page<'a>(lists: impl Iterator<Item = &'a CodeList>) -> String {
    let mut text = String::new();
    for list in lists.filter(|list| !list.codes.is_empty()) {
        text += &format!("\n{}:\n\n", list.error);
        for (code, names) in list.codes {
            text += &format!("* `{code}`{}\n", parameters(names.iter()));
        }
    }
    text
}

/// The names of a code's parameters in Markdown.
#[must_use]
pub fn parameters(names: impl Iterator<Item = impl AsRef<str>>) -> String {
    let names: Vec<_> = names.map(|name| format!("`{}`", name.as_ref())).collect();
    if names.is_empty() { String::new() } else { format!(" ({})", names.join(", ")) }
}
