//! The standard streams. No other part of a program writes to them, and a stream that takes nothing ends no run.
//!
//! A stream that is closed at the start counts as one that nobody reads: Rust's start-up code replaces it by `/dev/null`.

// Allowed only here.
#![allow(clippy::disallowed_methods)]

use std::borrow::Cow;
use std::fmt::Display;
use std::io::{self, IsTerminal as _, Write};
use std::sync::atomic::{AtomicBool, Ordering};

use anstream::AutoStream;
use halfrow::result::Problem;
use halfrow::words::{is_unfit, plain};

use crate::codes;

/// The result could not be written to stdout.
#[derive(Debug, thiserror::Error)]
#[error("the result cannot be written to stdout; free some space where it goes, or send it elsewhere")]
pub struct Unprinted(#[source] io::Error);

/// Prints a result and a newline to stdout. That the reader went away, as `head` does, is no error.
///
/// # Errors
/// [`Unprinted`] when stdout does not take it.
pub fn print(text: &str) -> Result<(), Unprinted> {
    print_raw(&format!("{text}\n"))
}

/// Writes a document to stdout, its bytes unchanged. A terminal gets it as by [`print()`].
///
/// # Errors
/// Like [`print()`].
pub fn hand_out(document: &[u8]) -> Result<(), Unprinted> {
    if io::stdout().is_terminal() {
        return print_raw(&String::from_utf8_lossy(document));
    }
    let mut stdout = io::stdout().lock();
    taken(stdout.write_all(document).and_then(|()| stdout.flush()))
}

/// Like [`print()`], without adding a newline.
///
/// # Errors
/// Like [`print()`].
pub(crate) fn print_raw(text: &str) -> Result<(), Unprinted> {
    let mut stdout = io::stdout().lock();
    let text = if stdout.is_terminal() { harmless(text) } else { text.into() };
    // Assembled first: the stripping of colours would write every piece of text separately.
    let mut bytes = AutoStream::new(Vec::new(), AutoStream::choice(&stdout));
    let styled = bytes.write_all(text.as_bytes());
    taken(styled.and_then(|()| stdout.write_all(&bytes.into_inner())).and_then(|()| stdout.flush()))
}

fn taken(written: io::Result<()>) -> Result<(), Unprinted> {
    match written {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        written => written.map_err(Unprinted),
    }
}

/// Prints a result that the files or the exit code of the command show as well. If stdout does not take it, stderr says so,
/// once.
pub fn tell(text: &str) {
    static SAID: AtomicBool = AtomicBool::new(false);
    if let Err(unprinted) = print(text)
        && !SAID.swap(true, Ordering::Relaxed)
    {
        error(&format_args!("{:#}; the exit code stands", anyhow::Error::from(unprinted)));
    }
}

/// Like [`tell`], for one line that holds names from outside: their control characters are spelt out.
pub fn tell_line(line: &str) {
    tell(&plain(line));
}

/// Says on stderr what went wrong, as far as stderr takes it.
pub fn error(what: &dyn Display) {
    diagnose(&format_args!("error: {what}"));
}

/// Says why there is no result: on stderr for people, with where its code is explained, and as `document` on stdout where that was
/// asked for.
pub fn explain(problem: &Problem, document: Option<&str>) {
    error(problem);
    if let Some(code) = codes::explained(problem) {
        diagnose(&format_args!("see `halfrow explain {code}`"));
    }
    if let Some(document) = document {
        tell(document);
    }
}

/// Asks on stderr for something to be typed. A failure is ignored: whoever types without seeing it knows what is asked for.
pub fn ask(what: &str) {
    diagnose_raw(&format!("{what}: "));
}

/// Writes one line to stderr, if that takes it. Control characters are spelt out, newlines among them: no name from outside begins a
/// line of its own.
pub fn diagnose(what: &dyn Display) {
    diagnose_raw(&format!("{}\n", plain(&what.to_string())));
}

/// Like [`diagnose`], without adding a newline, and with control characters kept.
pub(crate) fn diagnose_raw(text: &str) {
    // If stderr fails, there is nowhere left to report it.
    let _ = anstream::stderr().lock().write_all(text.as_bytes());
}

/// `text` for a terminal: newlines, tabs and colours are kept, and whatever else it may obey is spelt out as in JSON.
fn harmless(text: &str) -> Cow<'_, str> {
    let colours = |text: &str| {
        let digits = text
            .strip_prefix("\u{1b}[")?
            .trim_start_matches(|letter: char| letter.is_ascii_digit() || letter == ';');
        digits.strip_prefix('m').map(|rest| text.len() - rest.len())
    };
    let obeyed = |letter: char| is_unfit(letter) && !matches!(letter, '\n' | '\t');
    let mut shown = String::new();
    let mut rest = text;
    while let Some(place) = rest.find(obeyed) {
        let (before, behind) = rest.split_at(place);
        shown.push_str(before);
        let letter = behind.chars().next().unwrap_or_default();
        let kept = colours(behind);
        match kept {
            Some(length) => shown.push_str(&behind[..length]),
            None => shown.push_str(&format!("\\u{:04x}", u32::from(letter))),
        }
        rest = &behind[kept.unwrap_or(letter.len_utf8())..];
    }
    if shown.is_empty() { Cow::Borrowed(text) } else { Cow::Owned(shown + rest) }
}

/// Whether somebody watches stderr.
#[must_use]
pub fn is_watched() -> bool {
    io::stderr().is_terminal()
}

/// The writer of the log, which gets each event whole, with a newline at its end. Names of files are in it, so it goes to stderr as by
/// [`diagnose`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Log;

impl Write for Log {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let event = String::from_utf8_lossy(bytes);
        diagnose(&event.strip_suffix('\n').unwrap_or(&event));
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_terminal_is_told_colours_and_nothing_else_to_do() {
        let title = "\u{1b}[1mPASS\u{1b}[0m\n\u{1b}]0;x\u{7}a\u{9b}2Jb\u{1b}[2Jc\td";
        assert_eq!(harmless(title), "\u{1b}[1mPASS\u{1b}[0m\n\\u001b]0;x\\u0007a\\u009b2Jb\\u001b[2Jc\td");
        let name = serde_json::json!({ "name": "A\u{9b}31m\u{7f}Z\u{1b}[8m\u{202e}" });
        assert_eq!(serde_json::from_str::<serde_json::Value>(&harmless(&name.to_string())).unwrap(), name);
        assert!(!harmless(&name.to_string()).contains(is_unfit));
        assert!(matches!(harmless("façade\n"), Cow::Borrowed(_)));
    }
}
