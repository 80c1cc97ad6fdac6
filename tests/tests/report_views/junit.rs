use std::io::Write as _;
use std::process::{Command, Stdio};

use halfrow::report;
use halfrow::result::{Problem, Report};
use quick_junit::{NonSuccessKind, Report as Document, TestCase, TestCaseStatus, TestSuite};

use crate::made;

fn suite(report: &Report) -> TestSuite {
    let text = report::junit(report).unwrap();
    let document = Document::deserialize_from_str(&text).unwrap();
    let [suite] = document.test_suites.try_into().unwrap();
    suite
}

fn case<'a>(suite: &'a TestSuite, class: &str, name: &str) -> &'a TestCase {
    let wanted = |case: &&TestCase| {
        case.name.as_str() == name && case.classname.as_ref().is_some_and(|found| found.as_str() == class)
    };
    suite.test_cases.iter().find(wanted).unwrap()
}

fn property<'a>(suite: &'a TestSuite, name: &str) -> Option<&'a str> {
    let found = suite.properties.iter().find(|property| property.name.as_str() == name);
    found.map(|property| property.value.as_str())
}

fn kind(case: &TestCase) -> Option<NonSuccessKind> {
    match &case.status {
        TestCaseStatus::NonSuccess { kind, .. } => Some(*kind),
        _ => None,
    }
}

#[test]
fn a_pass_has_a_case_for_the_verdict_each_check_and_each_frame() {
    let suite = suite(&made::pass());
    assert_eq!(suite.name.as_str(), "halfrow verify");
    assert_eq!((suite.tests, suite.failures, suite.errors, suite.skipped), (5, 0, 0, 0));
    case(&suite, "halfrow.frame", "builtin:noise (frame 2, grbg, least blanking (0 clocks))");
}

#[test]
fn a_frame_through_the_decoy_s_tables_is_named_so() {
    let mut report = made::pass();
    report.frames[0].generation = 1;
    let name = "builtin:street, decoy tables (frame 1, grbg, least blanking (0 clocks))";
    case(&suite(&report), "halfrow.frame", name);
}

#[test]
fn the_suite_says_which_kind_of_board_it_was() {
    let suite = suite(&made::pass());
    let value = |name| property(&suite, name);
    assert_eq!(value("board.kind"), Some("mock"));
    assert_eq!(value("board.target"), Some("mock,fault=flip"));
    assert_eq!(value("cause"), Some("equal"));
    assert_eq!(value("not_exercised"), Some("not exercised: samples of 8 or 10 bits"));
}

/// Zeros on the wire are no number (protocol/WIRE.md).
#[test]
fn the_suite_has_the_code_and_a_number_only_of_a_board_that_has_one() {
    let mut report = made::pass();
    let with = suite(&report);
    for (name, value) in
        [("code", "all-right"), ("board.serial", "000000000000002a"), ("board.device", "000000000000002a")]
    {
        assert_eq!(property(&with, name), Some(value), "{name}");
    }
    report.board.identity.as_mut().unwrap().serial = "0".repeat(16);
    let without = suite(&report);
    assert_eq!((property(&without, "board.serial"), property(&without, "board.device")), (None, None));
}

#[test]
fn a_wrong_frame_is_a_failure_and_what_was_not_reached_is_skipped() {
    let suite = suite(&made::fail().0);
    assert_eq!((suite.failures, suite.errors, suite.skipped), (3, 0, 1));
    let wrong = "frames/<script>alert(1)</script>&.pgm (frame 2, grbg, least blanking (0 clocks))";
    let wrong = case(&suite, "halfrow.frame", wrong);
    let TestCaseStatus::NonSuccess { kind, message, description, .. } = &wrong.status else { panic!() };
    assert_eq!(*kind, NonSuccessKind::Failure);
    assert_eq!(message.as_ref().unwrap().as_str(), "5 of 2,560 samples differ");
    let first = "First at row 3, column 0: expected 193, found 209; largest difference 16.";
    assert_eq!(description.as_ref().unwrap().as_str(), first);
    assert!(matches!(case(&suite, "halfrow.check", "counters").status, TestCaseStatus::Skipped { .. }));
}

#[test]
fn differences_over_a_poor_link_are_errors_and_no_failures() {
    let (mut report, _) = made::fail();
    report.cause = halfrow::verdict::Cause::Station;
    report.checks.clear();
    let suite = suite(&report);
    assert_eq!((suite.failures, suite.errors), (0, 2));
}

#[test]
fn a_verdict_that_is_no_pass_is_never_green_even_when_no_check_says_so() {
    let mut report = made::error();
    report.checks.clear();
    let suite = suite(&report);
    assert_eq!(kind(case(&suite, "halfrow.verify", "verdict")), Some(NonSuccessKind::Error));
}

#[test]
fn a_frame_that_did_not_come_back_whole_is_no_success() {
    let mut report = made::pass();
    report.frames[0].rows = 1079;
    let suite = suite(&report);
    let cut = case(&suite, "halfrow.frame", "builtin:street (frame 1, grbg, least blanking (0 clocks))");
    assert_eq!(kind(cut), Some(NonSuccessKind::Error));
}

#[test]
fn characters_that_xml_forbids_are_spelt_out() {
    let mut report = made::error();
    report.finding = Problem::new("odd", "\u{0}\u{1b}[1m\u{ffff}]]>").into();
    let text = report::junit(&report).unwrap();
    assert!(text.contains("\\u{0}\\u{1b}[1m\\u{ffff}]]&gt;"), "{text}");
    assert!(!text.contains(['\u{0}', '\u{1b}', '\u{ffff}']));
}

/// Validates a document against the schema with xmllint; the error is what xmllint prints.
fn lint(document: &str) -> Result<(), String> {
    let schema = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/report_views/junit.xsd");
    let mut lint = Command::new("xmllint");
    lint.args(["--noout", "--nonet", "--schema", schema, "-"]).stdin(Stdio::piped()).stderr(Stdio::piped());
    let mut lint =
        lint.spawn().unwrap_or_else(|error| panic!("xmllint: {error}; apt-get install libxml2-utils"));
    lint.stdin.take().unwrap().write_all(document.as_bytes()).unwrap();
    let output = lint.wait_with_output().unwrap();
    if output.status.success() { Ok(()) } else { Err(String::from_utf8_lossy(&output.stderr).into_owned()) }
}

#[test]
fn every_document_is_one_that_jenkins_takes() {
    for report in [made::pass(), made::fail().0, made::error()] {
        assert_eq!(lint(&report::junit(&report).unwrap()), Ok(()));
    }
}

/// The first three are what quick-junit writes by itself; Jenkins refuses all of them.
#[test]
fn the_schema_refuses_what_jenkins_does() {
    let document = report::junit(&made::fail().0).unwrap();
    for (ours, theirs) in [
        ("<testsuites ", "<testsuites skipped=\"1\" "),
        ("<testsuites ", "<testsuites timestamp=\"2026-11-21T02:03:04.000+00:00\" "),
        ("<testcase ", "<testcase timestamp=\"2026-11-21T02:03:04.000+00:00\" "),
        (" time=\"0.125\"", ""),
        ("<failure ", "<fault "),
    ] {
        assert!(document.contains(ours), "{document}");
        assert!(lint(&document.replacen(ours, theirs, 1)).is_err(), "{theirs}");
    }
}

#[test]
fn every_case_has_its_time_and_all_of_them_fit_into_the_run() {
    let mut report = made::pass();
    report.run.seconds = 2.0;
    let suite = suite(&report);
    let times: Vec<_> = suite.test_cases.iter().map(|case| case.time.unwrap().as_secs_f64()).collect();
    assert_eq!(times, [0.0, 0.125, 0.125, 0.75, 0.75]);
    assert!(times.iter().sum::<f64>() <= suite.time.unwrap().as_secs_f64());
    assert!(suite.timestamp.is_some());
}

/// What `ci/junit.py` makes of a report, which GitHub shows.
fn shown(report: &Report) -> String {
    let folder = halfrow_tests::program::Folder::new();
    folder.write("report.xml", report::junit(report).unwrap());
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/../ci/junit.py");
    let ended = Command::new("python3").arg(script).arg(folder.path().join("report.xml")).output().unwrap();
    assert!(ended.status.success(), "{}", String::from_utf8_lossy(&ended.stderr));
    String::from_utf8(ended.stdout).unwrap()
}

#[test]
fn the_table_for_a_ci_stands_below_the_verdict_its_limits_and_what_to_do() {
    // A backslash before a mark shows the mark.
    let shown = |report: &Report| shown(report).replace('\\', "");
    let pass = shown(&made::pass());
    let (head, table) = pass.split_once("| check |").unwrap_or_else(|| panic!("{pass}"));
    assert!(head.contains("PASS (mock board: no hardware was tested)"), "{pass}");
    assert!(head.contains("not exercised: samples of 8 or 10 bits"), "{pass}");
    assert!(table.contains("| frames | passed |"), "{pass}");
    let fail = shown(&made::fail().0);
    let (head, _) = fail.split_once("| check |").unwrap_or_else(|| panic!("{fail}"));
    assert!(head.starts_with("**FAIL: 5 of 2,076,160 samples differ"), "{fail}");
    assert!(
        head.contains("- At the bench: Reload the bitstream") && head.contains("- Next: Check entry 3"),
        "{fail}"
    );
}

/// A backslash before each mark of ASCII is CommonMark's (0.31.2, example 12).
#[test]
fn a_frame_s_name_is_no_markup_in_the_table_for_a_ci() {
    let mut report = made::pass();
    report.frames[0].name = r"[a](b) `*_~|<&\".into();
    let shown = shown(&report);
    assert!(shown.contains(r"| \[a\]\(b\) \`\*\_\~\|&lt;&amp;\\ \(frame 1\,"), "{shown}");
}

#[test]
fn what_could_not_be_written_or_kept_is_said() {
    let (mut report, evidence) = made::fail();
    let causes = vec![Problem::new("io", "no space left on device")];
    report.lacks =
        vec![Problem { causes, ..Problem::new("recording-lost", "the recording could not be written") }];
    report.evidence.left_out = 8;
    let page = report::html(&report, &evidence).unwrap();
    let lost = "the recording could not be written: no space left on device";
    for words in [lost, "And 8 more frames for which there was no room in memory."] {
        assert!(page.contains(words), "{words}");
    }
    assert!(report::wording::summary(&report).lines().any(|line| line.contains(lost)));
    assert!(report::junit(&report).unwrap().contains(lost));
}
