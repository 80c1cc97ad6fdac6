//! From a target string to a link.

use std::error::Error;
use std::path::Path;

use halfrow_pipe::TargetError;

#[cfg(feature = "sim")]
pub(crate) use super::simulated::{check_simulated, open_simulated};
use super::{Candidate, OpenError, Reopener};
use crate::kinds::{self, Kind};
use crate::target::{BoardKind, Target};

/// Checks that `target` is written correctly. This is possible before its board is plugged in or powered.
///
/// # Errors
/// [`OpenError`] when its kind does not exist, or its address or options do not suit the kind, as those of a file that is no
/// serial port.
pub fn check(target: &Target) -> Result<(), OpenError> {
    (kind(target)?.check)(target)
}

fn kind(target: &Target) -> Result<&'static Kind, OpenError> {
    let unknown = || OpenError::UnknownKind { kind: target.kind.clone(), known: kinds::forms().join(", ") };
    kinds::of(target).ok_or_else(unknown)
}

/// Opens the link that `target` names, without sending anything over it.
///
/// # Errors
/// [`OpenError`] when the target's kind, address or options are wrong, or its link cannot be opened.
pub fn open(target: &Target) -> Result<Candidate, OpenError> {
    let kind = kind(target)?;
    let link = (kind.open)(target)?;
    let again = target.clone();
    // A recording would start again from its beginning, and what a board has written is not written over.
    let is_there_again = kind.board != BoardKind::Replay && written_file(target).is_none();
    let reopen = is_there_again.then(|| Box::new(move || Ok(open(&again)?.link)) as Reopener);
    Ok(Candidate { target: target.to_string(), kind: kind.board, link, reopen })
}

#[cfg(not(feature = "sim"))]
pub(crate) fn check_simulated(target: &Target) -> Result<(), OpenError> {
    Err(OpenError::NoSimulation(target.to_string()))
}

#[cfg(not(feature = "sim"))]
pub(crate) fn open_simulated(target: &Target) -> Result<Box<dyn crate::Link>, OpenError> {
    Err(OpenError::NoSimulation(target.to_string()))
}

/// The options of a target, as pairs of key and value.
pub(super) type Options<'a> = Vec<(&'a str, &'a str)>;

pub(super) fn options_of(target: &Target) -> Options<'_> {
    target.options.iter().map(|(key, value)| (key.as_str(), value.as_str())).collect()
}

/// Takes the value of `key` out of `options`.
pub(super) fn take<'a>(
    board: &'static str,
    target: &Target,
    options: &mut Options<'a>,
    key: &str,
) -> Result<Option<&'a str>, OpenError> {
    let values: Vec<_> = options.extract_if(.., |(name, _)| *name == key).map(|(_, value)| value).collect();
    match *values {
        [] => Ok(None),
        [value] => Ok(Some(value)),
        _ => Err(wrong_options(board, target, TargetError::Duplicate { key: key.to_owned() })),
    }
}

/// The option that says which clock the pipe of a board in this process follows.
pub(super) const PACE: &str = "pace";

/// Takes [`PACE`] out of `options`, and tells whether the pipe is paced.
pub(super) fn pace(
    board: &'static str,
    target: &Target,
    options: &mut Options<'_>,
) -> Result<bool, OpenError> {
    match take(board, target, options, PACE)? {
        Some("real") => Ok(true),
        Some("virtual") | None => Ok(false),
        Some(value) => Err(OpenError::Pace { key: PACE.to_owned(), value: value.to_owned() }),
    }
}

/// `error`, which names the options that the pipe and its board have, with `keys` among them.
pub(super) fn with_keys(error: TargetError, keys: &[&str]) -> TargetError {
    match error {
        TargetError::UnknownKey { key, known } => {
            TargetError::UnknownKey { key, known: format!("{}, {known}", keys.join(", ")) }
        }
        other => other,
    }
}

pub(super) fn wrong_options(
    board: &'static str,
    target: &Target,
    source: impl Error + Send + Sync + 'static,
) -> OpenError {
    OpenError::Options { board, target: target.to_string(), source: Box::new(source) }
}

/// How a target names the file that its board writes. Only a simulated board does.
pub const WRITTEN_FILE: &str = "trace=FILE";

/// The file that the board of `target` writes, if the target names one. It is made when the board is opened, never through a
/// link and never over a file.
#[must_use]
pub fn written_file(target: &Target) -> Option<&Path> {
    target.option(kinds::of(target)?.writes?).map(Path::new)
}
