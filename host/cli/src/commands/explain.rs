//! `halfrow explain`

use std::collections::BTreeMap;

use clap::builder::{PossibleValue, StringValueParser, TypedValueParser};
use clap::{Arg, Args, Command};
use serde::Serialize;
use serde_json::{Value, json};

use super::document::print_result;
use super::{CallError, Context, Failure, codes, print};
use crate::exit::Exit;
use crate::text::{BOLD, push};
use halfrow::result::examples;
use halfrow::verdict::Verdict;

/// Each code with its meaning and its error's message, from the comments of the sources.
const MEANINGS: &[(&str, &str, &str)] = include!(concat!(env!("OUT_DIR"), "/meanings.rs"));

/// The codes of `halfrow-station`'s own errors, each with the names of its parameters.
const CODES_OF_STATION: &[(&str, &[&str])] = include!(concat!(env!("OUT_DIR"), "/codes_of_station.rs"));

/// How like a code must be to what was asked for, 0 to 1, to be named in its place.
const LIKENESS: f64 = 0.8;
/// Codes that are named at most.
const MOST_LIKE: usize = 5;

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The codes, as `halfrow codes` and `halfrow-station codes` list them
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
        let codes = MEANINGS.iter().map(|&(code, ..)| code).filter(move |&code| known.contains_key(code));
        Some(Box::new(codes.map(PossibleValue::new)))
    }
}

/// What is to be said of a code.
#[derive(Clone, Debug, Default, Serialize)]
struct Explanation {
    code: String,
    /// finding, defect, not-exercised, error or station-error.
    of: String,
    meaning: String,
    /// A sentence with it, or with what stands for its parameters in capitals.
    sentence: String,
    /// The verdict that it leads to; none when that is another's matter.
    verdict: Option<Verdict>,
    fault: &'static str,
    #[serde(rename = "do")]
    acts: Vec<String>,
    parameters: Vec<String>,
    #[serde(rename = "where")]
    place: &'static str,
}

pub(super) fn run(arguments: &Arguments, context: &Context) -> Result<Exit, Failure> {
    let known = known();
    let found =
        arguments.codes.iter().map(|code| known.get(code).cloned().ok_or_else(|| unknown(code, &known)));
    let found = found.collect::<Result<Vec<_>, _>>().map_err(Failure::call)?;
    if context.json {
        print_result("explain", Exit::Pass, None, json!({ "codes": found }))?;
    } else {
        print(found.iter().map(Explanation::text).collect::<Vec<_>>().join("\n").trim_end())?;
    }
    Ok(Exit::Pass)
}

/// Names the codes that are most like one that is none.
fn unknown(code: &str, known: &BTreeMap<String, Explanation>) -> CallError {
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
        true => "`halfrow codes` lists all".to_owned(),
        false => format!("try {}, or see all by `halfrow codes`", near.join(", ")),
    };
    CallError::CodeUnknown { code: code.to_owned(), remedy }
}

/// Every code with what is said of it.
fn known() -> BTreeMap<String, Explanation> {
    let of_station = CODES_OF_STATION
        .iter()
        .map(|(code, names)| json!({ "of": "station-error", "code": code, "parameters": names }));
    let mut known: BTreeMap<_, _> = of_station
        .chain(codes::all())
        .map(|entry| of_entry(&entry))
        .map(|it| (it.code.clone(), it))
        .collect();
    let mut add =
        |code: &str, change: &dyn Fn(&mut Explanation)| known.get_mut(code).into_iter().for_each(change);
    for &(code, meaning, message) in MEANINGS {
        add(code, &|it| it.say(meaning, message));
    }
    for (verdict, finding) in examples::findings_with_verdicts() {
        add(&finding.code(), &|it| {
            it.sentence = finding.sentence();
            it.acts = finding.remedy().into_iter().collect();
            (it.verdict, it.fault) = (verdict, fault(verdict));
        });
    }
    for suspect in examples::suspects() {
        add(&suspect.defect.tagged().0, &|it| {
            it.sentence = format!("{}: {}", suspect.place(), suspect.evidence());
            it.acts = vec![
                format!("At the bench: {}", suspect.technician()),
                format!("Next: {}", suspect.designer()),
            ];
        });
    }
    for part in examples::not_exercised() {
        add(&part.tagged().0, &|it| it.sentence = part.words());
    }
    known
}

/// What is known of a code by its kind alone.
fn of_entry(entry: &Value) -> Explanation {
    let text = |key: &str| entry[key].as_str().unwrap_or_default().to_owned();
    let parameters = entry["parameters"].as_array().into_iter().flatten().filter_map(Value::as_str);
    let (verdict, fault, place) = match entry["of"].as_str() {
        Some("finding") => (None, fault(None), "`finding` of a result, and of each of its `checks`"),
        Some("defect") => (
            Some(Verdict::Fail),
            fault(Some(Verdict::Fail)),
            "`suspects` of a result, and `suspect` of its finding",
        ),
        Some("not-exercised") => (
            Some(Verdict::Pass),
            "nobody's: the frames of the run leave it open; stream others, or all built-in ones",
            "`not_exercised` of a result",
        ),
        Some("station-error") => (
            None,
            "never the board's result: the station's, its settings', its plant's or the call's",
            "what `halfrow-station` answers with `--json`, and what `check` finds",
        ),
        _ => (
            None,
            "never the board's result: no verdict and exit code 2 where the call or a file is wrong, else ERROR (link, \
             station, time)",
            "`error` of a result and its `causes`; `finding`, where it ends a run",
        ),
    };
    Explanation {
        code: text("code"),
        of: text("of"),
        parameters: parameters.map(str::to_owned).collect(),
        verdict,
        fault,
        place,
        ..Explanation::default()
    }
}

/// Whose fault it is, by the verdict.
fn fault(verdict: Option<Verdict>) -> &'static str {
    match verdict {
        Some(Verdict::Pass) => "nobody's: it is as it must be",
        Some(Verdict::Fail) => "the board's",
        Some(Verdict::Error) => "the link's, the station's or the call's: the board was not judged by it",
        None => "nobody's: it says what was not done",
    }
}

/// A message with the names of what is filled in in capitals.
fn named_places(message: &str) -> String {
    let mut parts = message.split('{');
    let mut text = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (name, rest) = part.split_once('}').unwrap_or(("", part));
        let name = name.split(':').next().unwrap_or_default();
        let is_name = name.starts_with(|letter: char| letter.is_ascii_lowercase());
        text += &if is_name { name.to_uppercase() } else { "…".to_owned() };
        text += rest;
    }
    text
}

/// With a capital and a full stop.
fn as_sentence(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().map_or_else(String::new, |first| format!("{}{}.", first.to_uppercase(), letters.as_str()))
}

impl Explanation {
    /// Takes what the sources say. Where there is no comment the message is one, and tells of no act.
    fn say(&mut self, meaning: &str, message: &str) {
        let sentence = named_places(message);
        if meaning.is_empty() {
            self.meaning = as_sentence(&sentence);
            return;
        }
        self.meaning = meaning.to_owned();
        self.acts = sentence.rsplit_once("; ").map(|(_, act)| act.to_owned()).into_iter().collect();
        self.sentence = sentence;
    }

    fn text(&self) -> String {
        let kind = self.of.replace('-', " ");
        let mut text = format!("{BOLD}{}{BOLD:#} ({kind})\n", self.code);
        let mut add = |word: &str, words: &str| {
            if !words.is_empty() {
                push(&mut text, word, BOLD, words);
            }
        };
        add("means", &self.meaning);
        add("as in", &self.sentence);
        add("verdict", &self.verdict.map_or_else(String::new, |verdict| verdict.to_string()));
        add("fault", self.fault);
        self.acts.iter().enumerate().for_each(|(place, act)| add(if place == 0 { "do" } else { "" }, act));
        add("values", &self.parameters.join(", "));
        add("in JSON", self.place);
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_code_has_a_meaning_from_the_comments_of_the_sources() {
        for (code, it) in known() {
            assert!(it.meaning.ends_with('.'), "{code}: {it:?}");
            assert!(!it.meaning.contains("[`"), "{code}: {it:?}");
        }
    }

    #[test]
    fn what_is_filled_in_is_named() {
        let said = named_places("{} is {width} x {height:>4}, above {MAX_SIDE}; crop it");
        assert_eq!(said, "… is WIDTH x HEIGHT, above …; crop it");
    }
}
