//! The standard streams. Nothing else of a program writes to them, and a stream that takes nothing ends no run.
//!
//! A stream that is closed is one that nobody wants to read, as `/dev/null` is: Rust's start-up code puts that there.

// Here alone.
#![allow(clippy::disallowed_methods)]

use std::borrow::Cow;
use std::fmt::Display;
use std::io::{self, IsTerminal as _, Write};
use std::sync::atomic::{AtomicBool, Ordering};

use anstream::AutoStream;
use halfrow::words::plain;

/// A result that stdout did not take.
#[derive(Debug, thiserror::Error)]
#[error("the result cannot be written to stdout; free some space where it goes, or send it elsewhere")]
pub struct Unprinted(#[source] io::Error);

/// Prints a result and a line's end to stdout. A reader that went away, as `head` does, has seen enough.
///
/// # Errors
/// [`Unprinted`] when stdout does not take it.
pub fn print(text: &str) -> Result<(), Unprinted> {
    print_raw(&format!("{text}\n"))
}

/// Writes a document to stdout, with each of its bytes as it is. A terminal is shown what [`print()`] would show it.
///
/// # Errors
/// As [`print()`].
pub fn hand_out(document: &[u8]) -> Result<(), Unprinted> {
    if io::stdout().is_terminal() {
        return print_raw(&String::from_utf8_lossy(document));
    }
    let mut stdout = io::stdout().lock();
    taken(stdout.write_all(document).and_then(|()| stdout.flush()))
}

/// [`print()`] without a line's end of its own.
///
/// # Errors
/// As [`print()`].
pub(crate) fn print_raw(text: &str) -> Result<(), Unprinted> {
    let mut stdout = io::stdout().lock();
    let text = if stdout.is_terminal() { harmless(text) } else { text.into() };
    // Put together first: the stripping of colours would write every piece of text by itself.
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

/// Prints what is not the only result of a command: its files or its exit code say it, too. If stdout does not take it,
/// stderr says so, once.
pub fn tell(text: &str) {
    static SAID: AtomicBool = AtomicBool::new(false);
    if let Err(unprinted) = print(text)
        && !SAID.swap(true, Ordering::Relaxed)
    {
        error(&format_args!("{:#}; the exit code stands", anyhow::Error::from(unprinted)));
    }
}

/// Says on stderr what went wrong, if it can be said.
pub fn error(what: &dyn Display) {
    diagnose(&format_args!("error: {what}"));
}

/// Says on stderr where more is said of the code of what went wrong, if it has one.
pub fn refer(code: Option<&str>) {
    if let Some(code) = code {
        diagnose(&format_args!("see `halfrow explain {code}`"));
    }
}

/// Asks on stderr for something that is typed behind it. Whoever types blind knows what is asked.
pub fn ask(what: &str) {
    diagnose_raw(&format!("{what}: "));
}

/// Writes a line to stderr, if that takes it, with what a terminal would obey spelt out.
pub fn diagnose(what: &dyn Display) {
    let lines: Vec<_> = what.to_string().split('\n').map(|line| plain(line).into_owned()).collect();
    diagnose_raw(&format!("{}\n", lines.join("\n")));
}

/// [`diagnose`] without a line's end of its own.
pub(crate) fn diagnose_raw(text: &str) {
    // Nobody is left to be told that this cannot be told.
    let _ = anstream::stderr().lock().write_all(text.as_bytes());
}

/// What a terminal may obey is ends of lines, tabs and colours; what else it would is spelt out, as JSON would have it.
fn harmless(text: &str) -> Cow<'_, str> {
    let colours = |text: &str| {
        let digits = text
            .strip_prefix("\u{1b}[")?
            .trim_start_matches(|letter: char| letter.is_ascii_digit() || letter == ';');
        digits.strip_prefix('m').map(|rest| text.len() - rest.len())
    };
    let obeyed = |letter: char| letter.is_control() && !matches!(letter, '\n' | '\t');
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

/// Where the log goes: stderr, which takes it or does not.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Log;

impl Write for Log {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let _ = io::stderr().lock().write_all(bytes);
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
        let name = serde_json::json!({ "name": "A\u{9b}31m\u{7f}Z\u{1b}[8m" });
        assert_eq!(serde_json::from_str::<serde_json::Value>(&harmless(&name.to_string())).unwrap(), name);
        assert!(matches!(harmless("façade\n"), Cow::Borrowed(_)));
    }
}
