//! Compares documents with their schemas, and files of the repository with the output of the commands that print them.
//! Differences are reported with their place.

use jsonschema::error::ValidationErrorKind;
use jsonschema::{ValidationError, Validator};
use serde_json::Value;

/// A longer excerpt of a document, in bytes, tells its reader nothing.
const FEW: usize = 200;

/// Where a document departs from its schema, each with its place.
#[must_use]
pub fn errors(validator: &Validator, document: &Value) -> Vec<String> {
    validator.iter_errors(document).flat_map(|error| told(&error)).collect()
}

/// The sentences of an error. Where no alternative of several fits, those of the alternatives of the value's own type: an object
/// is not called a bad null.
fn told(error: &ValidationError<'_>) -> Vec<String> {
    use ValidationErrorKind::{AnyOf, Constant, OneOfNotValid, Type};
    let place = error.instance_path();
    if let OneOfNotValid { context } | AnyOf { context } = error.kind() {
        let is_other = |inner: &ValidationError<'_>| {
            inner.instance_path() == place && matches!(inner.kind(), Type { .. } | Constant { .. })
        };
        let meant = context.iter().filter(|errors| !errors.iter().any(is_other));
        let inner: Vec<_> = meant.flatten().flat_map(told).collect();
        if !inner.is_empty() {
            return inner;
        }
    }
    let whole = error.to_string();
    let said = if whole.len() > FEW { error.masked().to_string() } else { whole };
    vec![format!("{said} at {place}")]
}

/// Compares a file of the repository with what `command` has printed.
///
/// # Panics
/// If they differ, with the first line that does.
#[track_caller]
pub fn assert_printed_by(command: &str, printed: &str, file: &str, kept: &str) {
    if printed == kept {
        return;
    }
    let (mut ours, mut theirs) = (printed.lines(), kept.lines());
    let mut pairs = (1..).map(|number| (number, ours.next(), theirs.next()));
    let first = pairs.find(|(_, ours, theirs)| ours != theirs || ours.is_none());
    let (number, ours, theirs) = first.unwrap_or_default();
    let line = |line: Option<&str>| line.unwrap_or("nothing, it has ended").to_owned();
    let (ours, theirs) = (line(ours), line(theirs));
    panic!(
        "{file} is not what `{command}` prints; run: {command} > {file}\nfirst other line, {number}\nprinted: {ours}\nthere:   {theirs}"
    );
}
