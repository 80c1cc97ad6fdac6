//! What is known about every code, and about the other words of a report.

use std::collections::BTreeMap;

use halfrow::report::wording::bench_then_next;
use halfrow::result::{CheckName, Rule, examples};
use halfrow::verdict::Verdict;
use halfrow::words::sentence;
use serde::Serialize;

use super::{acts, lines, unexercised};
use crate::commands::codes::{self, Entry};

/// Each code with its meaning and its error's message, from the comments of the sources.
pub(super) const MEANINGS: &[(&str, &str, &str)] = include!(concat!(env!("OUT_DIR"), "/meanings.rs"));

/// The codes of `halfrow-station`'s own errors, each with the names of its parameters.
const CODES_OF_STATION: &[(&str, &[&str])] = include!(concat!(env!("OUT_DIR"), "/codes_of_station.rs"));

/// What there is to say about a code.
#[derive(Clone, Debug, Default, Serialize)]
pub(super) struct Explanation {
    pub(super) code: String,
    /// What kind of word it is: finding, defect, not-exercised, error, station-error, verdict, check, rule, line or
    /// fault.
    pub(super) of: &'static str,
    pub(super) meaning: String,
    /// An example sentence, or a message with the names of its parameters in capitals.
    pub(super) sentence: String,
    /// The verdict that it leads to; none if it does not decide the verdict.
    pub(super) verdict: Option<Verdict>,
    pub(super) fault: &'static str,
    #[serde(rename = "do")]
    pub(super) acts: Vec<String>,
    pub(super) parameters: Vec<String>,
    #[serde(rename = "where")]
    pub(super) place: &'static str,
}

/// Every code, and every other word of a report, with its explanations.
pub(super) fn known() -> BTreeMap<String, Vec<Explanation>> {
    let of_station = CODES_OF_STATION.iter().map(|&(code, names)| Entry {
        of: "station-error",
        code: code.to_owned(),
        parameters: names.iter().map(|&name| name.to_owned()).collect(),
    });
    let mut known: BTreeMap<_, _> =
        of_station.chain(codes::all()).map(|entry| (entry.code.clone(), of_entry(entry))).collect();
    let mut add =
        |code: &str, change: &dyn Fn(&mut Explanation)| known.get_mut(code).into_iter().for_each(change);
    for &(code, meaning, message) in MEANINGS {
        add(code, &|it| it.say(meaning, message));
    }
    for (verdict, finding) in examples::findings_with_verdicts() {
        add(&finding.code(), &|it| {
            it.sentence = finding.sentence();
            it.acts = bench_then_next(codes::bench(&finding), codes::act(&finding));
            (it.verdict, it.fault) = (verdict, fault(verdict));
        });
    }
    for suspect in examples::suspects() {
        add(&suspect.defect.tagged().0, &|it| {
            it.sentence = format!("{}: {}", suspect.place(), suspect.evidence());
            it.acts = vec![
                format!("At the bench: {}", suspect.technician()),
                format!("Next, in this example: {}", suspect.designer()),
            ];
        });
    }
    for part in examples::not_exercised() {
        add(&part.tagged().0, &|it| {
            (it.sentence, it.fault) = (part.words(), unexercised::fault(&part));
            it.acts = vec![unexercised::act(&part).to_owned()];
        });
    }
    // A code may have the same name as a check or a fault.
    let mut all: BTreeMap<String, Vec<Explanation>> = BTreeMap::new();
    for it in known.into_values().chain(words()) {
        all.entry(it.code.clone()).or_default().push(it);
    }
    all
}

/// The words of a report that are not codes: verdicts, checks, the wire's rules, the words at the left of its lines, and the faults
/// that a mock board can have.
fn words() -> impl Iterator<Item = Explanation> {
    let meaning = |name: &str| MEANINGS.iter().find(|(known, ..)| *known == name).map_or("", |(_, it, _)| it);
    let verdicts = [Verdict::Pass, Verdict::Fail, Verdict::Error].map(|verdict| Explanation {
        code: verdict.to_string(),
        of: "verdict",
        meaning: meaning(&verdict.to_string().to_lowercase()).to_owned(),
        verdict: Some(verdict),
        fault: fault(Some(verdict)),
        acts: vec![act(verdict).to_owned()],
        place: "`verdict` of a result",
        ..Explanation::default()
    });
    let checks = CheckName::ALL.map(|check| Explanation {
        code: check.to_string(),
        of: "check",
        meaning: meaning(check.name()).to_owned(),
        fault: "depends on the result: the code of the finding beside it says whose it is",
        acts: vec!["Run `halfrow explain` with the code of that finding.".to_owned()],
        place: "`name` of each of a result's `checks`",
        ..Explanation::default()
    });
    let faults = halfrow_mock::catalogue().map(|it| Explanation {
        code: it.name.to_owned(),
        of: "fault",
        meaning: sentence(&it.summary()).unwrap_or_default(),
        fault: "the mock board's, when it is asked for one: `--board mock,fault=NAME`",
        parameters: it.parameters.iter().map(|parameter| parameter.key.to_owned()).collect(),
        place: "what `halfrow faults --json` lists",
        ..Explanation::default()
    });
    faults.chain(checks).chain(rules()).chain(lines::all()).chain(verdicts)
}

/// The rules of the wire, each by the word that a finding has for it.
fn rules() -> impl Iterator<Item = Explanation> {
    Rule::ALL.iter().filter_map(|rule| {
        Some(Explanation {
            code: serde_json::to_value(rule).ok()?.as_str()?.to_owned(),
            of: "rule",
            meaning: sentence(rule.meaning()).unwrap_or_default(),
            fault: "the board's, if the verdict is FAIL; otherwise the link may have done it, as its finding says",
            acts: vec!["Run `halfrow explain` with the code of the finding that names it.".to_owned()],
            place: "`rule` among the parameters of a finding, such as `rule-broken`",
            ..Explanation::default()
        })
    })
}

/// What to do after a verdict, whatever led to it.
const fn act(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Pass => {
            "Nothing. The line `limits` names what no frame put to the test. Of a run within a time (--within) the verdict's \
             line says how many parts were left out, and the lines `within` which."
        }
        Verdict::Fail => {
            "Do what stands after \"At the bench\", then run again. If the board fails again, set it aside with its report."
        }
        Verdict::Error => {
            "Do what the last line of the result says, then run again: nothing is known of the board yet."
        }
    }
}

/// What is known about a code from its kind alone.
fn of_entry(Entry { of, code, parameters }: Entry) -> Explanation {
    let (verdict, fault, place) = match of {
        "finding" => (None, fault(None), "`finding` of a result, and of each of its `checks`"),
        "defect" => (
            Some(Verdict::Fail),
            fault(Some(Verdict::Fail)),
            "`suspects` of a result, and `suspect` of its finding",
        ),
        "not-exercised" => {
            (Some(Verdict::Pass), "nobody's: the run did not test it", "`not_exercised` of a result")
        }
        "station-error" => (
            None,
            "not the board's: the station's, its settings', its plant's or the command's",
            "what `halfrow-station` answers with `--json`, and what `check` finds",
        ),
        _ => (
            None,
            "no verdict on the board: exit code 2 if the command or a file is wrong, otherwise ERROR (most often exit code 3)",
            "`error` of a result and its `causes`; `finding`, where it ends a run",
        ),
    };
    Explanation { code, of, parameters, verdict, fault, place, ..Explanation::default() }
}

/// Whose fault it is, according to the verdict.
fn fault(verdict: Option<Verdict>) -> &'static str {
    match verdict {
        Some(Verdict::Pass) => "nobody's: it is as it must be",
        Some(Verdict::Fail) => "the board's",
        Some(Verdict::Error) => {
            "no verdict on the board, which was not judged: look at the link, the station and the command, and at what the board \
             says of itself"
        }
        None => "nobody's: it only says what was not done",
    }
}

/// A message template, with the names of its parameters in capitals.
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

impl Explanation {
    /// Takes what the sources say. Without a comment, the message serves as the meaning.
    fn say(&mut self, meaning: &str, message: &str) {
        self.sentence = named_places(message);
        self.acts = acts::of(&self.code, &self.sentence).into_iter().collect();
        if meaning.is_empty() {
            self.meaning = sentence(&std::mem::take(&mut self.sentence)).unwrap_or_default();
        } else {
            self.meaning = meaning.to_owned();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_code_has_a_meaning_from_the_comments_of_the_sources() {
        for it in known().into_values().flatten() {
            assert!(it.meaning.ends_with('.'), "{it:?}");
            assert!(!it.meaning.contains("[`"), "{it:?}");
        }
    }

    #[test]
    fn what_is_filled_in_is_named() {
        let said = named_places("{} is {width} x {height:>4}, above {MAX_SIDE}; crop it");
        assert_eq!(said, "… is WIDTH x HEIGHT, above …; crop it");
    }
}
