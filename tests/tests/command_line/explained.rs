//! `halfrow explain`, and where users meet the codes that it explains.

use std::collections::BTreeSet;

use halfrow::result::{
    Answer, BrokenOff, BurstCount, Corner, Counter, Doubt, Finding, NumberedRow, PlacedRow, Problem,
    RepeatedRow, RowsTried, Rule,
};
use halfrow_tests::program::{Folder, error_sentence, halfrow};

use crate::small;

/// The page of the station's codes.
const STATION: &str = include_str!("../../../docs/STATION-CODES.md");

/// The explanation of each of `codes` as JSON.
fn explained(codes: &[&str]) -> Vec<serde_json::Value> {
    let said = halfrow(["explain", "--json"].into_iter().chain(codes.iter().copied())).json();
    assert!(said["error"].is_null(), "{}", error_sentence(&said));
    said["codes"].as_array().cloned().unwrap_or_default()
}

#[test]
fn every_code_is_explained() {
    let all = halfrow(["codes", "--json"]).json();
    let own = all["codes"].as_array().unwrap().iter().map(|it| it["code"].as_str().unwrap());
    let of_station = STATION.lines().filter_map(|line| line.strip_prefix("* `")?.split('`').next());
    let codes: Vec<_> = own.chain(of_station).collect();
    assert!(codes.len() > 600, "{}", codes.len());
    let is_code = |it: &serde_json::Value| {
        !["verdict", "check", "rule", "line", "fault"].contains(&it["of"].as_str().unwrap())
    };
    let told: Vec<_> = explained(&codes).into_iter().filter(is_code).collect();
    assert_eq!(told.len(), codes.len());
    for (code, it) in codes.iter().zip(told) {
        assert_eq!(it["code"], *code);
        assert!(it["meaning"].as_str().unwrap().ends_with('.'), "{it}");
        assert!(
            !it["fault"].as_str().unwrap().is_empty() && !it["where"].as_str().unwrap().is_empty(),
            "{it}"
        );
    }
}

/// Verdicts and remedies are those that runs on broken boards show.
#[test]
fn an_explanation_is_that_of_the_run_that_had_the_code() {
    let run = halfrow(small("verify", &["--json", "--board", "mock,fault=stuck-data,bit=5,value=1"])).json();
    let finding = run["finding"]["code"].as_str().unwrap();
    let defect = run["suspects"][0]["defect"]["code"].as_str().unwrap();
    let told = explained(&[finding, defect, "no-answer", "input-bits"]);
    assert_eq!((&told[0]["verdict"], &told[0]["fault"]), (&run["verdict"], &"the board's".into()));
    assert_eq!(told[1]["of"], "defect");
    let bench = told[1]["do"][0].as_str().unwrap().strip_prefix("At the bench: ").unwrap();
    assert_eq!(bench, run["suspects"][0]["technician"].as_str().unwrap());
    assert!(told[2]["fault"].as_str().unwrap().starts_with("no verdict on the board"), "{}", told[2]);
    assert_eq!(told[3]["verdict"], "PASS");
}

/// docs/running.md says of each what leaves it open: of these, no frame that is streamed.
#[test]
fn nobody_is_sent_to_stream_frames_for_what_no_streamed_frame_tests() {
    let codes = [
        "full-speed",
        "named-clock",
        "unseen-clock",
        "table-change-at-speed",
        "rules",
        "further-records",
        "counters-of-poor-links",
        "same-board",
        "idle-time",
        "camera-pins",
    ];
    let told = explained(&codes).into_iter().filter(|it| it["of"] == "not-exercised");
    let told: Vec<_> = told.collect();
    assert_eq!(told.len(), codes.len());
    for it in told {
        let act = it["do"][0].as_str().unwrap_or_default();
        assert!(act.ends_with('.') && !act.contains("built-in frames"), "{it}");
        assert!(!it["fault"].as_str().unwrap().contains("frames"), "{it}");
    }
    let bits = &explained(&["input-bits"])[0]["do"][0];
    assert!(bits.as_str().is_some_and(|act| act.contains("built-in frames")), "{bits}");
}

/// The other words of a report, each as the list of its kind has it.
#[test]
fn verdicts_checks_and_faults_are_explained_too() {
    let run = halfrow(small("verify", &["--json"])).json();
    let checks: Vec<_> =
        run["checks"].as_array().unwrap().iter().map(|it| it["name"].as_str().unwrap()).collect();
    let faults = halfrow(["faults", "--json"]).json();
    let faults: Vec<_> =
        faults["faults"].as_array().unwrap().iter().map(|it| it["name"].as_str().unwrap()).collect();
    for (of, words) in [("verdict", vec!["PASS", "FAIL", "ERROR"]), ("check", checks), ("fault", faults)] {
        // A code may have the same name: the defect `tap-offset`, and `rules` as a part that is left out.
        let (own, alike): (Vec<_>, Vec<_>) = explained(&words).into_iter().partition(|it| it["of"] == of);
        let codes: Vec<_> = own.iter().map(|it| it["code"].as_str().unwrap()).collect();
        assert_eq!(codes, words);
        assert!(alike.iter().all(|it| words.contains(&it["code"].as_str().unwrap())), "{alike:?}");
        assert!(own.iter().all(|it| it["meaning"].as_str().unwrap().ends_with('.')), "{own:?}");
    }
    assert_eq!(explained(&["fail"])[0]["code"], "FAIL");
    assert_eq!(explained(&["NO-ANSWER"])[0]["code"], "no-answer");
    let told = &explained(&["stuck-data"])[0]["meaning"];
    assert_eq!(told, "A data line of the line memory is stuck (bit=5, value=1).");
    for it in explained(&["PASS", "FAIL", "ERROR", "link", "frames"]) {
        assert!(it["do"][0].as_str().is_some_and(|act| act.ends_with('.')), "{it}");
    }
}

/// The words of `rule`, which stored reports have.
const RULES: &str = "payload kind skipped configuration span entry address damage once unanswered session held new-session \
    refusal-session closed commit-crc generation shape no-grid commit-frame pending forgotten row-place window credit inside rows \
    samples again banks wide row-number burst under-way records ended cut repeated trap not-ready power-up";

#[test]
fn each_rule_that_a_finding_names_is_explained() {
    let words: Vec<_> = RULES.split_whitespace().collect();
    assert_eq!(words.len(), Rule::ALL.len());
    let told = explained(&words).into_iter().filter(|it| it["of"] == "rule");
    let codes: Vec<_> = told.map(|it| it["code"].as_str().unwrap().to_owned()).collect();
    assert_eq!(codes, words);
    let run = halfrow(small("verify", &["--json", "--board", "mock,fault=any-session"])).json();
    let told = explained(&[run["finding"]["parameters"]["rule"].as_str().unwrap()]);
    let told = told.iter().find(|it| it["of"] == "rule").unwrap();
    assert_eq!(told["meaning"], "A packet of another session must have no effect.");
}

/// The words at the left of a PASS with limits, of a FAIL, of a soak and of a simulated board.
#[test]
fn every_word_at_the_left_of_a_result_is_explained() {
    let runs = [
        small("verify", &["--at-speed", "0", "--operator", "Ann"]),
        vec!["verify", "--frame", "builtin:street", "--width", "640", "--height", "480", "--radius", "400"],
        small("verify", &["--within", "3"]),
        small("verify", &["--board", "mock,fault=stuck-data,bit=5,value=1"]),
        small("verify", &["--board", "mock,fault=wrong-latency-claim"]),
        small("verify", &["--board", "sim"]),
        small("soak", &["--frames", "200", "--board", "mock,fault=slow-path,one-in=20000"]),
    ];
    let words: BTreeSet<_> =
        runs.into_iter().flat_map(|run| words_at_the_left(&halfrow(run).stdout)).collect();
    for word in ["limits", "within", "coverage", "street", "skipped", "soak", "differs", "do", "explain"] {
        assert!(words.contains(word), "{word}: {words:?}");
    }
    let words: Vec<_> = words.iter().map(String::as_str).collect();
    let told = explained(&words);
    for word in words {
        let at_the_left =
            |it: &serde_json::Value| it["code"] == word && (it["of"] == "line" || it["of"] == "verdict");
        assert!(told.iter().any(at_the_left), "{word}");
    }
}

/// The first words of a result's lines, without its head, its table of frames and continued lines.
fn words_at_the_left(text: &str) -> Vec<String> {
    let labelled = text.lines().skip(1).filter(|line| !line.starts_with(' '));
    labelled
        .filter_map(|line| Some(line.split([' ', ':']).next()?.to_owned()))
        .filter(|it| !it.is_empty())
        .collect()
}

#[test]
fn a_pass_names_the_codes_of_what_it_leaves_open() {
    let passed = halfrow(small("verify", &["--at-speed", "0"]));
    let line = passed.stdout.lines().find_map(|line| line.strip_prefix("explain  halfrow explain "));
    let codes: Vec<_> = line.unwrap_or_else(|| panic!("{}", passed.stdout)).split(' ').collect();
    assert!(explained(&codes).iter().any(|it| it["of"] == "not-exercised"), "{codes:?}");
}

/// A finding with another suspect has another remedy.
#[test]
fn what_an_example_s_suspect_asks_for_is_said_to_be_the_example_s() {
    for it in explained(&["samples-differ", "table-reads-wrong", "differs-at-speed"]) {
        let act = it["do"][0].as_str().unwrap();
        assert!(act.starts_with("See the code of its suspect. In this example: Check "), "{act}");
    }
}

/// Findings of one code that ask for something else each.
#[test]
fn what_depends_on_what_was_found_is_said_to_be_the_example_s() {
    let corner = Corner { width: 64, height: 8, bits: 8, centre2: 63, grid: false };
    let timed = Finding::MiscountedAtSpeed { frame: 1, count: BurstCount::MostLatency, counted: 9, right: 8 };
    let reason =
        Problem { remedy: Some("Plug it in.".to_owned()), ..Problem::new("link-unplugged", "it is gone") };
    let found = [
        Finding::TablesChanged { found: Box::new(timed.clone()) },
        Finding::InCorner { corner, found: Box::new(Finding::CommitCrcWrong {}) },
        with_rule(),
        Finding::RuleBroken {
            rule: Rule::NewSession,
            request: "RECORDS".to_owned(),
            right: Answer::Burst { ended: true, records: 2 },
            found: Answer::OtherSignatures { frames: 2, first: 0 },
            asked: None,
        },
        timed,
        Finding::BoardStayedAway { reason: Box::new(reason.clone()), seconds: 1.0 },
        Finding::WrongOverDoubtfulLink {
            found: Box::new(Finding::EchoWrong {}),
            doubt: Doubt::AnswerLost {},
        },
        Finding::SecondLookBrokenOff(Box::new(BrokenOff {
            found: Finding::EchoWrong {},
            doubt: Doubt::AnswerLost {},
            reason: reason.into(),
        })),
    ];
    for finding in found {
        let it = &explained(&[&finding.code()])[0];
        let acts: Vec<_> = it["do"].as_array().unwrap().iter().filter_map(|act| act.as_str()).collect();
        let others = [finding.remedy(), finding.technician()].into_iter().flatten();
        let others: Vec<_> = others.filter(|other| !acts.iter().any(|act| act.contains(other))).collect();
        assert!(!others.is_empty(), "{finding:?}");
        let next = acts.last().unwrap();
        assert!(next.contains(". In this example: ") && next.len() > 30, "{acts:?}");
    }
}

fn with_rule() -> Finding {
    Finding::CounterWrong { counter: Counter::RowsOut, counted: 1, right: 2, rule: Some(Rule::Window) }
}

/// Also with those that few findings of their code have.
#[test]
fn every_parameter_that_a_report_may_have_is_listed() {
    let differ = Finding::SamplesDiffer {
        differences: 1,
        samples: 64,
        differing_frames: 1,
        frames: 1,
        tried: Some(Box::new(RowsTried { width: 64, height: 1 })),
        suspect: None,
        others: 0,
        short: None,
    };
    let all = halfrow(["codes", "--json"]).json();
    let placed = PlacedRow { row: 3, frame: 2, rules: true };
    let misconduct = [
        Finding::RowCopyDiffers(placed),
        Finding::RowNeverSent { row: 3, frame: 2, sequence: 35, rules: true },
        Finding::RowNumberedTwice(NumberedRow { row: 3, frame: 2, number: 7, rules: true }),
        Finding::RowRepeatsStand(RepeatedRow { row: 3, frame: 2, repeats: 0, rules: true }),
        Finding::RowOutOfOrder(placed),
    ];
    for finding in misconduct.into_iter().chain([with_rule(), differ]) {
        let Problem { code, parameters, .. } = finding.as_problem();
        let it = all["codes"].as_array().unwrap().iter().find(|it| it["code"] == *code).unwrap();
        let told: BTreeSet<_> =
            it["parameters"].as_array().unwrap().iter().filter_map(|it| it.as_str()).collect();
        assert_eq!(told, parameters.keys().map(String::as_str).collect());
    }
}

#[test]
fn people_read_it_in_80_columns() {
    let told = halfrow(["explain", "samples-differ", "frame-file-unreadable"]).succeeded();
    assert!(told.stdout.lines().all(|line| line.chars().count() <= 80), "{}", told.stdout);
    for line in ["samples-differ (finding)", "verdict  FAIL", "fault    the board's", "values   path"] {
        assert!(told.stdout.lines().any(|it| it == line), "{line}: {}", told.stdout);
    }
}

#[test]
fn an_unknown_code_is_answered_with_those_that_are_like_it() {
    for (asked, like) in [
        ("sample-difer", "samples-differ"),
        ("SAMPLES_DIFFER", "samples-differ"),
        ("png-damage", "png-damaged"),
    ] {
        let ended = halfrow(["explain", asked]);
        let sentence = format!("there is no code `{asked}`; try {like}");
        assert!(ended.code == Some(2) && ended.stderr.contains(&sentence), "{}", ended.stderr);
    }
    let ended = halfrow(["explain", "zzz"]);
    assert!(ended.code == Some(2) && ended.stderr.contains("`halfrow codes` lists all"), "{}", ended.stderr);
    assert!(ended.stderr.contains("docs/glossary.md"), "{}", ended.stderr);
    assert_eq!(halfrow(["explain"]).code, Some(2));
}

#[test]
fn an_unknown_code_takes_nothing_from_those_that_are_known() {
    let ended = halfrow(["explain", "judge", "strawberry"]);
    assert_eq!(ended.code, Some(2));
    assert!(ended.stdout.starts_with("judge (check)\n"), "{}", ended.stdout);
    assert!(ended.stderr.contains("there is no code `strawberry`"), "{}", ended.stderr);
}

/// Fish's completions have no values for positional arguments.
#[test]
fn completions_know_the_codes() {
    for shell in ["bash", "zsh"] {
        assert!(halfrow(["completions", shell]).stdout.contains("line-memory-data-stuck"), "{shell}");
    }
    assert!(!halfrow(["explain", "--help"]).stdout.contains("line-memory-data-stuck"));
}

#[test]
fn errors_and_reports_say_what_to_ask_for() {
    let folder = Folder::new();
    let ended = folder.halfrow(small("verify", &["--frame", "none.pgm"]));
    assert!(ended.stderr.ends_with("\nsee `halfrow explain frame-file-unreadable`\n"), "{}", ended.stderr);
    let failed = folder.halfrow(small("verify", &["--board", "mock,fault=stuck-data,bit=5,value=1"]));
    let line = "\nexplain  halfrow explain samples-differ line-memory-data-stuck\n\nFAIL: ";
    assert!(failed.stdout.contains(line), "{}", failed.stdout);
    assert!(!folder.halfrow(small("verify", &[])).stdout.contains("halfrow explain"));
}
