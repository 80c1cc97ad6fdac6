//! What has a code, in the words of a language.

use serde_json::Value;

use super::{Words, filled};
use crate::said::Said;

/// The language of what was told.
const ENGLISH: &str = "en";
/// Parameters that say what a finding is about: what is to be done is asked of them first.
const ABOUT: [&str; 4] = ["suspect", "defect", "found", "reason"];

/// A sentence on a page.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::web) struct Told {
    /// It.
    pub(in crate::web) text: String,
    /// `en` if it stands in English on a page of another language.
    pub(in crate::web) foreign: Option<&'static str>,
}

impl Words {
    /// What was said, with its causes; in English if the language has no words for all of it.
    pub(in crate::web) fn tell(&self, said: &Said) -> Told {
        let all = [said].into_iter().chain(&said.causes);
        let own: Option<Vec<_>> =
            all.map(|one| self.sentence(&one.code, &one.parameters.clone().into())).collect();
        match own {
            _ if self.code == ENGLISH => Told { text: said.to_string(), foreign: None },
            Some(own) => Told { text: own.join(": "), foreign: None },
            // A cause that is the system's or a library's own has no words here.
            None => match self.sentence(&said.code, &said.parameters.clone().into()) {
                Some(first) => Told { text: causes(first, said), foreign: None },
                None => self.english(said.to_string()),
            },
        }
    }

    /// What to do about it: `recorded`, which is in English, unless the language has words for it.
    pub(in crate::web) fn remedy(&self, said: Option<&Said>, recorded: &str) -> Told {
        let own = said.and_then(|said| self.asked(&said.code, &said.parameters.clone().into()));
        match own.filter(|_| self.code != ENGLISH) {
            Some(text) => Told { text, foreign: None },
            None => self.english(recorded.to_owned()),
        }
    }

    /// What was told in English.
    pub(in crate::web) fn english(&self, text: String) -> Told {
        Told { text, foreign: (self.code != ENGLISH).then_some(ENGLISH) }
    }

    fn sentence(&self, code: &str, parameters: &Value) -> Option<String> {
        let words = self.of_code("said", code)?;
        Some(filled(words, &|name| Some(self.value(at(parameters, name)?))))
    }

    fn asked(&self, code: &str, parameters: &Value) -> Option<String> {
        let inner = ABOUT.iter().find_map(|name| {
            let about = parameters.get(name)?;
            self.asked(about.get("code")?.as_str()?, about.get("parameters").unwrap_or(&Value::Null))
        });
        inner.or_else(|| {
            let words = self.of_code("remedy", code)?;
            Some(filled(words, &|name| Some(self.value(at(parameters, name)?))))
        })
    }

    /// A parameter as people read it.
    fn value(&self, value: &Value) -> String {
        match value {
            Value::Null => "–".to_owned(),
            Value::String(text) if text.is_empty() => "–".to_owned(),
            Value::String(text) => text.clone(),
            Value::Number(number) if number.is_f64() => {
                let rounded = number.as_f64().map(|value| (value * 1e6).round() / 1e6);
                rounded.map_or_else(|| number.to_string(), |value| self.figures(&value.to_string()))
            }
            Value::Array(values) => {
                values.iter().map(|value| self.value(value)).collect::<Vec<_>>().join(", ")
            }
            Value::Object(fields) => {
                let text = |key: &str| fields.get(key).and_then(Value::as_str);
                let own = text("code")
                    .filter(|_| self.code != ENGLISH)
                    .and_then(|code| self.sentence(code, fields.get("parameters").unwrap_or(&Value::Null)));
                let named = || ["message", "name", "code"].into_iter().find_map(text).map(str::to_owned);
                own.or_else(named).unwrap_or_else(|| value.to_string())
            }
            value @ (Value::Bool(_) | Value::Number(_)) => value.to_string(),
        }
    }
}

/// The sentence with its causes as they were told.
fn causes(first: String, said: &Said) -> String {
    let causes = said.causes.iter().map(|cause| cause.message.clone());
    [first].into_iter().chain(causes).collect::<Vec<_>>().join(": ")
}

/// The parameter of this name; `place.row` is the row of the place.
fn at<'a>(parameters: &'a Value, name: &str) -> Option<&'a Value> {
    name.split('.').try_fold(parameters, |value, name| value.get(name))
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::super::of;
    use super::*;
    use crate::floor::{Refusal, ScanError};
    use crate::said::Saying;

    fn german(said: &Said) -> (String, Option<&'static str>) {
        let Told { text, foreign } = of(Some("de"), None).tell(said);
        (text, foreign)
    }

    #[test]
    fn what_has_a_code_is_said_in_the_language_with_its_figures_and_causes() {
        let lane = "3".to_owned();
        let out = ScanError::Lane(Refusal::Out { lane, why: Saying::OutByPerson.into() });
        let told = "Platz 3 ist außer Betrieb: von einer Person stillgelegt; mit HR:IN wieder in Betrieb nehmen oder anderen Platz nehmen";
        assert_eq!(german(&Said::of(&out)), (told.to_owned(), None));
        let text =
            "lane 3 is out of service: taken out by a person; put it back with HR:IN, or take another lane";
        assert_eq!(of(None, None).tell(&Said::of(&out)).text, text);
        let seconds = Said::from(Saying::LaneSilent { seconds: 2.5 });
        assert_eq!(german(&seconds).0, "der Prozess des Platzes meldete 2,5 s lang nichts");
    }

    #[test]
    fn what_has_no_words_is_told_in_english_and_marked_so() {
        let new = Said { code: "of-tomorrow".to_owned(), ..Saying::OutByPerson.into() };
        assert_eq!(german(&new), ("taken out by a person".to_owned(), Some("en")));
        let cause = Said { message: "disk I/O error".to_owned(), code: "foreign-cause".to_owned(), ..new };
        let led = Said { causes: vec![cause], ..Saying::DeviceUnsaid.into() };
        assert_eq!(
            german(&led),
            ("die Platine nennt ihre Bausteinnummer nicht: disk I/O error".to_owned(), None)
        );
    }

    /// As the judge's reports write them: a finding within a finding, and a place with its parts.
    #[test]
    fn findings_within_findings_and_parts_of_a_figure_are_said_too() {
        let said = |code: &str, parameters: Value| Said {
            code: code.to_owned(),
            parameters: parameters.as_object().cloned().unwrap_or_default(),
            message: "in English".to_owned(),
            causes: Vec::new(),
        };
        let suspect = json!({ "code": "line-memory-data-stuck", "parameters": { "bit": 5, "value": 1 } });
        let differ = said(
            "samples-differ",
            json!({ "differences": 7, "samples": 99, "differing_frames": 1, "frames": 2, "suspect": suspect }),
        );
        let told = "7 von 99 Abtastwerten weichen ab, in 1 von 2 Bildern; Verdacht: Zeilenspeicher, Datenbit 5, hängt auf 1";
        assert_eq!(german(&differ).0, told);
        let asked = of(Some("de"), None).remedy(Some(&differ), "in English");
        assert!(asked.text.starts_with("Bitstream neu laden") && asked.foreign.is_none(), "{asked:?}");
        let missing = said("row-missing", json!({ "place": { "frame": 2, "row": 3 }, "attempts": 8 }));
        assert_eq!(german(&missing).0, "Zeile 3 von Bild 2 kam in 8 Versuchen nicht zurück");
        assert_eq!(of(Some("de"), None).remedy(None, "Look.").foreign, Some("en"));
    }
}
