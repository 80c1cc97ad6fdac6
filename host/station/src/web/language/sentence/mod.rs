//! What has a code, translated into a language.

mod doing;
mod parameters;
#[cfg(test)]
mod tests;

use halfrow::result::split_remedy;
use serde_json::Value;

use super::{Words, filled};
use crate::record::TEST_AGAIN;
use crate::said::{DIFFERED, Said};
use parameters::late;

/// The language of recorded sentences.
const ENGLISH: &str = "en";
/// Parameters that say what a finding is about: their remedies come first.
const ABOUT: [&str; 4] = ["suspect", "defect", "found", "reason"];
/// The parameter of a finding whose cause may be the link.
const DOUBT: &str = "doubt";
/// The code of rows that are late, and the key of what it asks for where they come and go.
pub(super) const LATE: &str = "latency-wrong";
pub(super) const LATE_AT_TIMES: &str = "latency-wrong-at-times";
/// The code of a broken rule, and the key of what it asks for where only signatures are wrong.
pub(super) const BROKEN: &str = "rule-broken";
pub(super) const BROKEN_AT_SPEED: &str = "rule-broken-at-speed";

/// A sentence on a page.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::web) struct Sentence {
    /// The sentence.
    pub(in crate::web) text: String,
    /// `en` if it is in English on a page of another language.
    pub(in crate::web) foreign: Option<&'static str>,
}

impl Words {
    /// What was said, with its causes; in English if the language has no words for all of it.
    pub(in crate::web) fn tell(&self, said: &Said) -> Sentence {
        let (sentences, foreign) = self.sentences(said);
        Sentence { text: sentences.join(self.say("told.colon")), foreign }
    }

    /// What was said without its remedy, and the remedy: `recorded`, which is in English, or the one that it ends in.
    pub(in crate::web) fn parted(&self, said: &Said, recorded: Option<&str>) -> (Sentence, Option<Sentence>) {
        let (why, asked) = self.split(said, recorded);
        let asked = asked.or_else(|| {
            let Sentence { text, foreign } = self.remedy(Some(said), recorded?);
            Some(Sentence { text: written(&text), foreign })
        });
        (why, asked)
    }

    /// Like [`Self::parted`], but a remedy that is not part of the sentence stays in whole sentences, and nothing is split off
    /// where no remedy is recorded.
    pub(in crate::web) fn with_remedy(
        &self,
        said: &Said,
        recorded: Option<&str>,
    ) -> (Sentence, Option<Sentence>) {
        let Some(recorded) = recorded else { return (self.tell(said), None) };
        let (why, asked) = self.split(said, Some(recorded));
        (why, Some(asked.unwrap_or_else(|| self.remedy(Some(said), recorded))))
    }

    /// What was said, split before its remedy where it ends in that.
    fn split(&self, said: &Said, recorded: Option<&str>) -> (Sentence, Option<Sentence>) {
        let is_asked = |one: &Said| {
            split_remedy(&one.message, &one.parameters)
                .is_some_and(|(_, asked)| recorded.is_none_or(|known| written(known) == written(asked)))
        };
        let (mut sentences, foreign) = self.sentences(said);
        let asking = all(said).zip(&mut sentences).find(|(one, _)| is_asked(one));
        let asked = asking.and_then(|(one, sentence)| {
            let (why, asked) = split_remedy(sentence, &one.parameters)?;
            let told = Sentence { text: written(asked), foreign };
            *sentence = why.to_owned();
            Some(told)
        });
        (Sentence { text: sentences.join(self.say("told.colon")), foreign }, asked)
    }

    /// What was said and each of its causes, and their language if it is not the page's.
    fn sentences(&self, said: &Said) -> (Vec<String>, Option<&'static str>) {
        let english = |said: &Said| said.message.clone();
        let own = |one: &Said| self.sentence(&one.code, &one.parameters.clone().into());
        if self.code == ENGLISH {
            return (all(said).map(english).collect(), None);
        }
        match (all(said).map(own).collect::<Option<Vec<_>>>(), own(said)) {
            (Some(own), _) => (own, None),
            // A cause that comes from the system or a library has no translation.
            (None, Some(first)) => {
                ([first].into_iter().chain(said.causes.iter().map(english)).collect(), None)
            }
            (None, None) => (all(said).map(english).collect(), Some(ENGLISH)),
        }
    }

    /// What to do about it: `recorded`, which is in English, unless the language has words for it.
    pub(in crate::web) fn remedy(&self, said: Option<&Said>, recorded: &str) -> Sentence {
        let own = said.and_then(|said| self.asked(&said.code, &said.parameters.clone().into()));
        let own = own.or_else(|| (recorded == TEST_AGAIN).then(|| self.say("told.again").to_owned()));
        match own.filter(|_| self.code != ENGLISH) {
            Some(text) => Sentence { text, foreign: None },
            None => self.english(recorded.to_owned()),
        }
    }

    /// A sentence in English.
    pub(in crate::web) fn english(&self, text: String) -> Sentence {
        Sentence { text, foreign: (self.code != ENGLISH).then_some(ENGLISH) }
    }

    fn sentence(&self, code: &str, parameters: &Value) -> Option<String> {
        let words = self.of_code("said", code)?;
        let why = filled(words, &|name| self.named(name, parameters));
        let Some(differed) = parameters.get(DIFFERED) else { return Some(why) };
        let of = |name: &str| if name == "why" { Some(why.clone()) } else { self.named(name, differed) };
        Some(filled(self.say("told.differed"), &of))
    }

    fn asked(&self, code: &str, parameters: &Value) -> Option<String> {
        // If the cause may be the link, nothing is asked about the board.
        let about: &[&str] = if parameters.get(DOUBT).is_some() { &[] } else { &ABOUT };
        let inner = about.iter().find_map(|name| {
            let about = parameters.get(name)?;
            self.asked(about.get("code")?.as_str()?, about.get("parameters").unwrap_or(&Value::Null))
        });
        inner.or_else(|| {
            let words = self.of_code("remedy", asked_by(code, parameters))?;
            Some(filled(words, &|name| self.named(name, parameters)))
        })
    }
}

/// What was said, and its causes.
fn all(said: &Said) -> impl Iterator<Item = &Said> {
    [said].into_iter().chain(&said.causes)
}

/// What to do, written as a line of its own: with a capital and without a full stop.
fn written(asked: &str) -> String {
    let mut letters = asked.trim().trim_end_matches(['.', '。']).chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// The key of a code's remedy.
fn asked_by<'a>(code: &'a str, parameters: &Value) -> &'a str {
    match code {
        LATE if late(parameters).is_some_and(|late| late.come_and_go()) => LATE_AT_TIMES,
        BROKEN if parameters.pointer("/found/other-signatures").is_some() => BROKEN_AT_SPEED,
        _ => code,
    }
}
