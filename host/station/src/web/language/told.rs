//! What has a code, in the words of a language.

mod parameters;

use serde_json::Value;

use super::{Words, filled};
use crate::said::Said;
use parameters::late;

/// The language of what was told.
const ENGLISH: &str = "en";
/// Parameters that say what a finding is about: what is to be done is asked of them first.
const ABOUT: [&str; 4] = ["suspect", "defect", "found", "reason"];
/// The parameter of a finding that may come from the link.
const DOUBT: &str = "doubt";
/// The code of rows that are late, and the key of what it asks for where they come and go.
pub(super) const LATE: &str = "latency-wrong";
pub(super) const LATE_AT_TIMES: &str = "latency-wrong-at-times";

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
        let (sentences, foreign) = self.sentences(said);
        Told { text: sentences.join(": "), foreign }
    }

    /// What was said without what it asks for, and that: `recorded`, which is in English, or what stands behind a semicolon.
    pub(in crate::web) fn parted(&self, said: &Said, recorded: Option<&str>) -> (Told, Option<Told>) {
        let is_asked = |one: &Said| {
            parts(&one.message)
                .is_some_and(|(_, asked)| recorded.is_none_or(|known| written(known) == written(asked)))
        };
        let place = all(said).position(is_asked);
        let (mut sentences, foreign) = self.sentences(said);
        let parted = place.and_then(|place| sentences.get_mut(place)).and_then(|sentence| {
            let (why, asked) = parts(sentence).map(|(why, asked)| (why.to_owned(), written(asked)))?;
            *sentence = why;
            Some(Told { text: asked, foreign })
        });
        let asked = parted.or_else(|| {
            let Told { text, foreign } = self.remedy(Some(said), recorded?);
            Some(Told { text: written(&text), foreign })
        });
        (Told { text: sentences.join(": "), foreign }, asked)
    }

    /// What was said and each of its causes, and whether that is in another language.
    fn sentences(&self, said: &Said) -> (Vec<String>, Option<&'static str>) {
        let english = |said: &Said| said.message.clone();
        let own = |one: &Said| self.sentence(&one.code, &one.parameters.clone().into());
        if self.code == ENGLISH {
            return (all(said).map(english).collect(), None);
        }
        match (all(said).map(own).collect::<Option<Vec<_>>>(), own(said)) {
            (Some(own), _) => (own, None),
            // A cause that is the system's or a library's own has no words here.
            (None, Some(first)) => {
                ([first].into_iter().chain(said.causes.iter().map(english)).collect(), None)
            }
            (None, None) => (all(said).map(english).collect(), Some(ENGLISH)),
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
        Some(filled(words, &|name| self.named(name, parameters)))
    }

    fn asked(&self, code: &str, parameters: &Value) -> Option<String> {
        // What may come from the link asks for nothing of the board.
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

/// It and its causes.
fn all(said: &Said) -> impl Iterator<Item = &Said> {
    [said].into_iter().chain(&said.causes)
}

/// What is wrong and what to do about it: sentences of this program have that behind their last semicolon.
fn parts(sentence: &str) -> Option<(&str, &str)> {
    sentence.rsplit_once("; ").or_else(|| sentence.rsplit_once('；'))
}

/// What to do as a line of its own has it.
fn written(asked: &str) -> String {
    let mut letters = asked.trim().trim_end_matches(['.', '。']).chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// The key of what a code asks for.
fn asked_by<'a>(code: &'a str, parameters: &Value) -> &'a str {
    if code == LATE && late(parameters).is_some_and(|late| late.come_and_go()) { LATE_AT_TIMES } else { code }
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
        let told = "Platz 3 ist gesperrt: durch eine Person; mit HR:IN entsperren oder anderen Platz nehmen";
        assert_eq!(german(&Said::of(&out)), (told.to_owned(), None));
        let text =
            "lane 3 is out of service: taken out by a person; put it back with HR:IN, or take another lane";
        assert_eq!(of(None, None).tell(&Said::of(&out)).text, text);
        let seconds = Said::from(Saying::LaneSilent { seconds: 2.5 });
        assert_eq!(german(&seconds).0, "der Prozess des Platzes meldete 2,5 s lang nichts");
    }

    /// In every language what to do is told apart, and a finding's figures stay whole.
    #[test]
    fn what_is_asked_for_is_told_apart_from_why() {
        let text = |told: Option<Told>| told.map(|told| (told.text, told.foreign));
        let due = Said::from(Saying::MockDue { barcode: "HR:MOCK".to_owned() });
        for (language, asked) in
            [("en", "Scan HR:MOCK"), ("de", "Scannen Sie HR:MOCK"), ("zh", "请扫描 HR:MOCK")]
        {
            let (why, told) = of(Some(language), None).parted(&due, None);
            assert_eq!(text(told), Some((asked.to_owned(), None)));
            assert!(!why.text.contains("HR:MOCK") && !why.text.ends_with([';', '；', ' ']), "{why:?}");
        }
        let (why, told) = of(None, None).parted(&Saying::OutByPerson.into(), None);
        assert_eq!((why.text.as_str(), told), ("taken out by a person", None));
        let said = |code: &str, message: &str, parameters: Value| Said {
            code: code.to_owned(),
            parameters: parameters.as_object().cloned().unwrap_or_default(),
            message: message.to_owned(),
            causes: Vec::new(),
        };
        let cause = said(
            "link-closed",
            "it was closed; check the cable",
            json!({ "link": "usb:1", "at": 11.069_952 }),
        );
        let broke = Said { causes: vec![cause], ..said("link-broke", "the link broke", json!({})) };
        let (why, told) = of(Some("de"), None).parted(&broke, Some("Check the cable."));
        assert_eq!(why.text, "die Verbindung brach ab: usb:1 wurde nach 11,1 s geschlossen");
        let asked = "Kabel und Stromversorgung der Platine prüfen, dann noch einmal";
        assert_eq!(text(told), Some((asked.to_owned(), None)));
        let lost = said("row-lost-once", "a row was lost; it is row 3", json!({}));
        let (why, told) = of(None, None).parted(&lost, Some("Check the cable."));
        assert_eq!(
            (why.text.as_str(), told.unwrap().text.as_str()),
            ("a row was lost; it is row 3", "Check the cable")
        );
        let (_, told) = of(Some("de"), None).parted(&lost, Some("Check the cable."));
        assert_eq!(
            text(told),
            Some(("Kabel und Verbindung prüfen, dann die Platine noch einmal prüfen".to_owned(), None))
        );
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
        let doubted = said(
            "wrong-over-doubtful-link",
            json!({
                "found": { "code": "table-crc-wrong", "parameters": {} },
                "doubt": { "of": "requests-twice", "requests": 1 },
            }),
        );
        let link = "Kabel und Verbindung prüfen, dann die Platine noch einmal prüfen";
        assert_eq!(of(Some("de"), None).remedy(Some(&doubted), "in English").text, format!("{link}."));
        let doubted = Said { message: "it may be; check the link, and run again".to_owned(), ..doubted };
        let (why, asked) = of(Some("de"), None).parted(&doubted, Some("Check the link, and run again."));
        assert!(why.text.ends_with("das kann von der Verbindung kommen"), "{why:?}");
        assert_eq!(asked.unwrap().text, link);
        let missing = said("row-missing", json!({ "place": { "frame": 2, "row": 3 }, "attempts": 8 }));
        assert_eq!(german(&missing).0, "Zeile 3 von Bild 2 kam in 8 Versuchen nicht zurück");
        assert_eq!(of(Some("de"), None).remedy(None, "Look.").foreign, Some("en"));
    }

    fn judged(code: &str, parameters: &Value) -> Said {
        let parameters = parameters.as_object().cloned().unwrap_or_default();
        Said { code: code.to_owned(), parameters, message: "in English".to_owned(), causes: Vec::new() }
    }

    /// A bit that is one of several alike, and a suspect that is one of several; records of earlier programs say of neither.
    #[test]
    fn what_is_one_of_several_is_not_told_as_the_fact_in_any_language() {
        let told = |language, said: &Said| of(Some(language), None).tell(said).text;
        let bit = |reading: Value| {
            judged("row-factor-bit-wrong", &json!({ "row": 3, "bit": 6, "reading": reading }))
        };
        let several = bit(json!({ "alike": [9, 5] }));
        assert_eq!(told("de", &several), "Zeilenfaktor 3, Bit 5, 6 oder 9");
        assert_eq!(told("zh", &several), "行系数 3，第 5, 6 或 9 位");
        assert_eq!(told("de", &bit(json!({}))), "Zeilenfaktor 3, Bit 6");
        let suspect = json!({ "code": "output-data-stuck", "parameters": { "bit": 9, "value": 1 } });
        for code in ["samples-differ", "differs-at-speed"] {
            for (others, german, chinese) in [
                (
                    json!(1),
                    "auf 1, oder ein anderer Fehler, der dasselbe ergibt",
                    "为 1，或另一个结果相同的缺陷",
                ),
                (
                    json!(3),
                    "auf 1, oder einer von 3 anderen, die dasselbe ergeben",
                    "为 1，或另外 3 个结果相同的缺陷之一",
                ),
                (json!(0), "hängt auf 1", "固定为 1"),
                (Value::Null, "hängt auf 1", "固定为 1"),
            ] {
                let mut said = judged(code, &json!({ "suspect": suspect, "others": others }));
                said.parameters.retain(|_, value| !value.is_null());
                for (language, end) in [("de", german), ("zh", chinese)] {
                    assert!(told(language, &said).ends_with(end), "{}", told(language, &said));
                }
            }
        }
    }

    #[test]
    fn one_late_row_is_told_as_one_and_rows_that_are_late_now_and_then_ask_for_a_look_at_the_timing() {
        let late = |rows: usize, of_rows: usize, is_one_row: bool| {
            let mut late =
                json!({ "rows": rows, "row": 3, "frame": 0, "first": 973, "last": 974, "claimed": 972 });
            if of_rows > 0 {
                (late["of_rows"], late["is_one_row"]) = (of_rows.into(), is_one_row.into());
            }
            judged("latency-wrong", &late)
        };
        let begins = |said: &Said| german(said).0.split_once(": ").unwrap().0.to_owned();
        let claims = "Zeilen haben eine andere Verzögerung, als die Platine angibt";
        assert_eq!(begins(&late(16, 96, true)), format!("16 von 96 {claims}, jedes Mal Zeile 3"));
        assert_eq!(begins(&late(7, 96, false)), format!("7 von 96 {claims}"));
        assert_eq!(begins(&late(7, 0, false)), format!("7 {claims}"));
        let asked = |language, said: &Said| of(Some(language), None).remedy(Some(said), "in English").text;
        for language in ["de", "zh"] {
            let [always, at_times] = ["latency-miscounted", "generation-wrong"]
                .map(|code| asked(language, &judged(code, &json!({}))));
            assert!(always != at_times);
            for said in [late(96, 96, false), late(9, 0, false), late(16, 96, true)] {
                assert_eq!(asked(language, &said), always);
            }
            for said in [late(1, 96, true), late(7, 96, false)] {
                assert_eq!(asked(language, &said), at_times);
            }
        }
    }
}
