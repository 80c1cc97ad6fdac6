use std::collections::BTreeSet;

use halfrow::report;
use halfrow::result::{CheckName, Finding, NotExercised, Problem, Reconnection, Report, Suspect, examples};
use serde_json::{Value, json};

use crate::made;

fn json(report: &Report) -> Value {
    serde_json::from_str(&report::json(report).unwrap()).unwrap()
}

/// Asserts that the report is the same after it was read back.
#[track_caller]
fn assert_same_when_read_back(report: &Report) {
    // Parsed by way of a JSON value: a second way to read a report would take long to compile.
    let again: Report = serde_json::from_value(json(report)).unwrap();
    assert_eq!(again, *report);
}

#[test]
fn a_report_reads_back_equal() {
    let mut away = made::error();
    let reason = Problem::of(&std::io::Error::from_raw_os_error(5));
    away.link.reconnections = vec![Reconnection { reason, seconds_away: 0.1 + 0.2, kept_tables: Some(true) }];
    let [pass, fail, error] = [made::pass(), made::fail().0, made::error()];
    for report in [pass, fail, error, away, made::soaked()] {
        assert_same_when_read_back(&report);
    }
}

/// As `verify --list` calls them: all but the first generation belong to the tables to judge with.
#[test]
fn a_frame_says_which_tables_made_it() {
    let mut report = made::pass();
    for (generation, tables) in [(1, "decoy"), (2, "judged"), (3, "judged")] {
        report.frames[0].generation = generation;
        let frame = &json(&report)["frames"][0];
        assert_eq!((&frame["generation"], &frame["tables"]), (&generation.into(), &tables.into()));
        assert_same_when_read_back(&report);
    }
}

#[test]
fn every_finding_and_every_suspect_reads_back_equal_with_a_sentence_of_its_own() {
    let mut said = BTreeSet::new();
    for finding in examples::findings() {
        let report = Report { finding: finding.clone(), ..made::fail().0 };
        assert_same_when_read_back(&report);
        assert_eq!(json(&report)["headline"], finding.sentence());
        assert!(!finding.sentence().is_empty() && said.insert(finding.sentence()), "{finding:?}");
    }
    for suspect in examples::suspects() {
        let report = Report { suspects: vec![suspect.clone()], ..made::fail().0 };
        assert_same_when_read_back(&report);
        let said = json(&report)["suspects"][0].clone();
        assert_eq!(
            (&said["place"], &said["evidence"]),
            (&suspect.place().into(), &suspect.evidence().into())
        );
        for sentence in [suspect.designer(), suspect.technician(), suspect.place(), suspect.evidence()] {
            assert!(!sentence.is_empty(), "{suspect:?}");
        }
    }
}

#[test]
fn everything_that_may_not_be_exercised_reads_back_equal_with_words_of_its_own() {
    let report = Report { not_exercised: examples::not_exercised(), ..made::pass() };
    assert_same_when_read_back(&report);
    let mut words = BTreeSet::new();
    for (part, said) in report.not_exercised.iter().zip(json(&report)["not_exercised"].as_array().unwrap()) {
        assert_eq!(said["words"], part.words());
        assert!(words.insert(part.words()), "{part:?}");
    }
    let known = codes_known::<NotExercised>();
    assert_eq!(known, examples::not_exercised().iter().map(|part| part.tagged().0).collect());
}

/// A report that is older than these keys.
#[test]
fn a_report_that_does_not_say_what_was_varied_is_read() {
    let mut old = json(&made::pass());
    old.as_object_mut().unwrap().remove("not_exercised").unwrap();
    for frame in old["frames"].as_array_mut().unwrap() {
        frame.as_object_mut().unwrap().remove("variation").unwrap();
    }
    let read: Report = serde_json::from_value(old).unwrap();
    assert_eq!(read, Report { not_exercised: Vec::new(), ..made::pass() });
}

/// A report of a version that counted neither wrong counts nor bursts with a difference.
#[test]
fn a_soak_that_counts_less_is_read() {
    let mut old = json(&made::soaked());
    let soak = old["soak"].as_object_mut().unwrap();
    let new = ["miscounted", "differing_bursts"].map(|key| soak.remove(key).unwrap());
    assert_eq!(new, [0, 2]);
    let interval = soak["chart"]["intervals"][0].as_object_mut().unwrap();
    assert_eq!(interval.remove("miscounted").unwrap(), 0);
    let read = serde_json::from_value::<Report>(old).unwrap().soak.unwrap();
    // Two differences are listed.
    assert_eq!((read.unlisted(1), read.unlisted(2), read.miscounted), (1, 0, 0));
}

/// A report of a version in which row factors were the only tables.
#[test]
fn a_report_with_the_earlier_names_of_tables_is_read() {
    let uploaded = Finding::TablesUploaded { entries: 1080, nodes: 65, generation: 2 };
    let now = Report { finding: uploaded, ..made::pass() };
    let mut old = json(&now);
    for (place, name, earlier) in
        [("/tables", "tables_crc32", "steps_crc32"), ("/finding/parameters", "entries", "rows")]
    {
        let of = old.pointer_mut(place).unwrap().as_object_mut().unwrap();
        let value = of.remove(name).unwrap();
        of.insert(earlier.to_owned(), value);
    }
    assert_eq!(serde_json::from_value::<Report>(old).unwrap(), now);
}

/// The codes that serde lists when it refuses one that does not exist.
fn codes_known<T: serde::de::DeserializeOwned + std::fmt::Debug>() -> BTreeSet<String> {
    let refused = serde_json::from_value::<T>(json!({ "code": "none", "parameters": {} })).unwrap_err();
    let refused = refused.to_string();
    let (_, known) = refused.split_once("expected one of ").unwrap();
    known.split('`').skip(1).step_by(2).map(str::to_owned).collect()
}

#[test]
fn no_defect_is_without_an_example() {
    let examples: Vec<_> = examples::suspects().iter().map(|suspect| suspect.defect.tagged().0).collect();
    assert_eq!(examples.iter().cloned().collect::<BTreeSet<_>>(), codes_known::<halfrow::result::Defect>());
    assert_eq!(examples.iter().collect::<BTreeSet<_>>().len(), examples.len());
}

#[test]
fn a_check_that_does_not_exist_and_another_schema_are_not_read() {
    let mut other = json(&made::pass());
    other["checks"][0]["name"] = "jugde".into();
    assert!(serde_json::from_value::<Report>(other).unwrap_err().to_string().contains("jugde"));
    let mut other = json(&made::pass());
    other["schema"] = 2.into();
    let refused = serde_json::from_value::<Report>(other).unwrap_err().to_string();
    assert!(refused.contains("schema 2 is not the one that this program reads, 1"), "{refused}");
}

#[test]
fn a_verdict_that_its_cause_contradicts_is_not_read() {
    let mut other = json(&made::fail().0);
    other["verdict"] = "PASS".into();
    let refused = serde_json::from_value::<Report>(other).unwrap_err().to_string();
    assert!(refused.contains("the verdict PASS is not that of the cause `different`, FAIL"), "{refused}");
}

#[test]
fn checks_have_the_names_that_their_json_has() {
    for check in CheckName::ALL {
        assert_eq!(json!(check), check.name());
    }
}

#[test]
fn a_code_and_its_parameters_are_what_is_read_and_sentences_are_made() {
    let mut told = json(&made::fail().0);
    told["suspects"][0]["place"] = "somewhere else".into();
    told["suspects"][0]["defect"]["parameters"]["bit"] = 5.into();
    let report: Report = serde_json::from_value(told).unwrap();
    let [Suspect { .. }] = &report.suspects[..] else { panic!() };
    assert_eq!(report.suspects[0].place(), "row 3's factor, bit 5");
}

#[test]
fn an_error_has_one_shape_wherever_it_stands() {
    let told = json(&made::error());
    assert_eq!(told["error"]["code"], "no-answer");
    assert_eq!(told["error"]["remedy"], "Check cable and power.");
    assert_eq!(told["error"], told["finding"]);
    let unjudged = Report { finding: Finding::NothingJudged {}, ..made::error() };
    assert_eq!(json(&unjudged)["error"]["code"], "nothing-judged");
    assert!(json(&made::fail().0)["error"].is_null());
}
