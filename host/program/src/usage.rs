//! What is wrong with a command line, as text and as a document. What an error quotes of the call, and of the environment, has its
//! control characters spelt out: scripts pass names and scanned labels on that hold any.

use std::error::Error as _;
use std::ffi::OsString;

use clap::builder::StyledStr;
use clap::error::{ContextValue, ErrorKind};
use clap::{Command, Error};
use halfrow::result::{Parameters, Problem, split_remedy};
use halfrow::words::{is_unfit, plain, sentence};

use crate::codes;

/// `error` with what it quotes spelt out, except in the words of its source, which [`text`] spells.
pub(crate) fn spelt(mut error: Error) -> Error {
    let is_unfit_text = |(_, value): (_, &ContextValue)| match value {
        ContextValue::String(text) => text.contains(is_unfit),
        ContextValue::Strings(texts) => texts.iter().any(|text| text.contains(is_unfit)),
        _ => false,
    };
    if error.context().any(is_unfit_text) {
        let spelt: Vec<_> =
            error.context().filter_map(|(kind, value)| Some((kind, in_plain(value)?))).collect();
        for (kind, value) in spelt {
            error.insert(kind, value);
        }
    }
    error
}

fn in_plain(value: &ContextValue) -> Option<ContextValue> {
    let spelt = |text: &String| plain(text).into_owned();
    match value {
        ContextValue::String(text) => Some(ContextValue::String(spelt(text))),
        ContextValue::Strings(texts) => Some(ContextValue::Strings(texts.iter().map(spelt).collect())),
        // Tips, which quote it as well. Their own colours cannot be told from those of the call.
        ContextValue::StyledStrs(tips) => {
            let tips = tips.iter().map(|tip| StyledStr::from(spelt(&tip.to_string())));
            Some(ContextValue::StyledStrs(tips.collect()))
        }
        _ => None,
    }
}

/// What clap has to say, with colours.
pub(crate) fn text(told: &Error) -> String {
    let text = told.render().ansi().to_string();
    match told.source().map(ToString::to_string) {
        Some(said) if said.contains(is_unfit) => text.replace(&said, &plain(&said)),
        _ => text,
    }
}

/// Why the command line of `program` cannot be used.
pub(crate) fn problem(told: &Error, program: &Command) -> Problem {
    let message = anstream::adapter::strip_str(&text(told)).to_string();
    let ends = ["\n\nUsage:", "\n\nFor more information"];
    let end = ends.iter().filter_map(|end| message.find(end)).min().unwrap_or(message.len());
    let message = message[..end].trim_start_matches("error: ").trim();
    let found = Problem::new(codes::of_usage(told.kind()), message);
    let name = program.get_name();
    let help = || Some(format!("See `{name} help` and `{name} COMMAND --help`."));
    let remedy = match told.kind() {
        ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand => None,
        ErrorKind::ValueValidation => wanted(told).or_else(help),
        ErrorKind::InvalidUtf8 => found.remedy.or_else(help),
        _ => help(),
    };
    Problem { remedy, ..found }
}

/// What the reader of a value asks for instead.
fn wanted(told: &Error) -> Option<String> {
    let said = told.source()?.to_string();
    let said = plain(&said);
    sentence(split_remedy(&said, &Parameters::new()).map_or(&*said, |(_, remedy)| remedy))
}

/// The error about one of `arguments` that must be text and is none, which clap does not name. That is so if `read` finds nothing of
/// that kind any more once it is text.
pub(crate) fn no_text(
    arguments: &[OsString],
    program: &Command,
    read: impl Fn(&[OsString]) -> Option<Error>,
) -> Option<Error> {
    let mut in_text = arguments.to_vec();
    for (place, argument) in arguments.iter().enumerate().filter(|(_, argument)| argument.to_str().is_none())
    {
        let shown = argument.to_string_lossy().into_owned();
        in_text[place] = shown.clone().into();
        if read(&in_text).is_some_and(|error| error.kind() == ErrorKind::InvalidUtf8) {
            continue;
        }
        let before = place.checked_sub(1).and_then(|before| arguments[before].to_str());
        let behind =
            before.filter(|before| before.starts_with('-')).map(|option| format!(" behind {option}"));
        let told = format!(
            "the argument `{shown}`{} is no text in UTF-8; write it in UTF-8, which a terminal does if `locale charmap` prints UTF-8",
            behind.unwrap_or_default()
        );
        return Some(Error::raw(ErrorKind::InvalidUtf8, format!("{}\n", plain(&told))).with_cmd(program));
    }
    None
}
