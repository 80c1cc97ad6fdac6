//! `halfrow explain`

use std::collections::{BTreeMap, BTreeSet};

use clap::builder::{PossibleValue, StringValueParser, TypedValueParser};
use clap::{Arg, Args, Command};
use serde_json::json;

use super::{Context, Failure, print};
use crate::call_error::CallError;
use crate::document::print_result;
use crate::exit::Exit;
use crate::text::{BOLD, push};
use known::{Explanation, MEANINGS, known};

mod acts;
mod known;
mod lines;
mod unexercised;

/// How similar a code must be to an unknown one, 0 to 1, to be suggested.
const LIKENESS: f64 = 0.8;
/// The page that explains words of results that are not codes.
const GLOSSARY: &str = "docs/glossary.md";
/// The most codes that are suggested.
const MOST_LIKE: usize = 5;

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The codes, as `halfrow codes` and `halfrow-station codes` list them; or a verdict, a check or another word at the left of a result, a rule of the wire, a fault of the mock board
    #[arg(required = true, value_name = "CODE", value_parser = Code, hide_possible_values = true)]
    codes: Vec<String>,
}

/// Any text; completions offer the codes.
#[derive(Clone)]
struct Code;

impl TypedValueParser for Code {
    type Value = String;

    fn parse_ref(
        &self,
        line: &Command,
        argument: Option<&Arg>,
        value: &std::ffi::OsStr,
    ) -> Result<String, clap::Error> {
        StringValueParser::new().parse_ref(line, argument, value)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        let known = known();
        let codes: BTreeSet<_> =
            MEANINGS.iter().map(|&(code, ..)| code).filter(|&code| known.contains_key(code)).collect();
        Some(Box::new(codes.into_iter().map(PossibleValue::new)))
    }
}

pub(super) fn run(arguments: &Arguments, context: &Context) -> Result<Exit, Failure> {
    let known = known();
    // Verdicts are in capitals, everything else in small letters.
    let of = |code: &String| {
        [code.clone(), code.to_uppercase(), code.to_lowercase()].iter().find_map(|it| known.get(it))
    };
    let (mut found, mut without) = (Vec::new(), None);
    for code in &arguments.codes {
        match of(code) {
            Some(it) => found.extend(it.iter().cloned()),
            None => without = without.or_else(|| Some(unknown(code, &known))),
        }
    }
    // A document is whole or none; on a terminal, one unknown code takes nothing from the others.
    let is_shown = without.is_none() || !context.json && !found.is_empty();
    if is_shown && context.json {
        print_result("explain", json!({ "codes": found }))?;
    } else if is_shown {
        print(found.iter().map(text).collect::<Vec<_>>().join("\n").trim_end())?;
    }
    without.map_or(Ok(Exit::Pass), |error| Err(Failure::call(error)))
}

/// The error for an unknown code, which suggests the most similar codes.
fn unknown(code: &str, known: &BTreeMap<String, Vec<Explanation>>) -> CallError {
    let wanted = code.to_lowercase().replace(['_', ' '], "-");
    let likeness = |known: &str| match known.contains(&wanted) {
        true => 1.0,
        false => strsim::jaro_winkler(known, &wanted),
    };
    let mut like: Vec<_> = known.keys().map(|known| (likeness(known), known.as_str())).collect();
    like.retain(|&(likeness, _)| likeness >= LIKENESS && !wanted.is_empty());
    like.sort_by(|one, other| other.0.total_cmp(&one.0));
    let near: Vec<_> = like.into_iter().take(MOST_LIKE).map(|(_, known)| known).collect();
    let remedy = match near.is_empty() {
        true => format!("`halfrow codes` lists all codes, and {GLOSSARY} explains other words"),
        false => format!("try {}, or see {GLOSSARY} for words that are not codes", near.join(", ")),
    };
    CallError::CodeUnknown { code: code.to_owned(), remedy }
}

/// An explanation as text for a terminal.
fn text(it: &Explanation) -> String {
    let kind = it.of.replace('-', " ");
    let mut text = format!("{BOLD}{}{BOLD:#} ({kind})\n", it.code);
    let mut add = |word: &str, words: &str| {
        if !words.is_empty() {
            push(&mut text, word, BOLD, words);
        }
    };
    add("means", &it.meaning);
    add("as in", &it.sentence);
    add("verdict", &it.verdict.map_or_else(String::new, |verdict| verdict.to_string()));
    add("fault", it.fault);
    it.acts.iter().enumerate().for_each(|(place, act)| add(if place == 0 { "do" } else { "" }, act));
    add("values", &it.parameters.join(", "));
    add("in JSON", it.place);
    text
}
