//! The report as JUnit XML, for CI systems and test stations.
//!
//! One suite: the verdict, then every check, then every frame. A verdict other than PASS is a failure or an error of its own,
//! so that no run turns green for lack of a failed check.

use std::time::Duration;

use quick_junit::{
    NonSuccessKind, Property, Report as Document, SerializeError, TestCase, TestCaseStatus as Status,
    TestSuite,
};

use super::wording;
use crate::result::{Check, FrameReport, Outcome, Report};
use crate::verdict::Verdict;
use crate::words::{count, differ_of, plain};

/// The report as an XML document.
///
/// # Errors
/// The XML writer's. No value that a [`Report`] can hold causes one.
pub fn render(report: &Report) -> Result<String, SerializeError> {
    let mut suite = TestSuite::new(format!("halfrow {}", report.command()));
    suite.timestamp = report.run.started.parse().ok();
    suite.time = Duration::try_from_secs_f64(report.run.seconds).ok();
    for (name, value) in properties(report) {
        suite.add_property(Property::new(name, plain(&value)));
    }
    suite.set_system_out(wording::summary(report));
    suite.add_test_case(verdict_case(report));
    suite.add_test_cases(report.checks.iter().map(check_case));
    suite.add_test_cases(report.frames.iter().map(|frame| frame_case(report, frame)));
    document(suite)
}

/// The document of one suite, valid by Jenkins' schema.
///
/// # Errors
/// The XML writer's, for characters that XML does not allow; [`plain`](crate::words::plain) escapes them.
pub fn document(suite: TestSuite) -> Result<String, SerializeError> {
    let mut document = Document::new(suite.name.as_str());
    document.time = suite.time;
    document.add_test_suite(suite);
    Ok(without_skipped(&document.to_string()?))
}

/// The document without the count of skipped cases in its root, where Jenkins' schema does not allow it; the suite keeps it.
fn without_skipped(document: &str) -> String {
    let Some((head, rest)) = document.split_once("<testsuites ") else { return document.to_owned() };
    let (root, rest) = rest.split_once('>').unwrap_or((rest, ""));
    let kept: Vec<_> = match root.split_once(" skipped=\"") {
        Some((before, after)) => vec![before, after.split_once('"').map_or("", |(_, after)| after)],
        None => vec![root],
    };
    format!("{head}<testsuites {}>{rest}", kept.concat())
}

/// The properties of the run, by name.
fn properties(report: &Report) -> Vec<(&'static str, String)> {
    let mut list = vec![
        ("verdict", report.verdict().to_string()),
        ("cause", report.cause.to_string()),
        ("code", report.finding.code()),
        ("board.kind", report.board.kind.to_string()),
        ("board.target", report.board.target.clone()),
        ("halfrow.version", report.run.version.clone()),
        ("halfrow.commit", report.run.commit.clone()),
        ("seed", report.run.seed.to_string()),
    ];
    list.extend(report.run.operator.clone().map(|name| ("operator", name)));
    list.extend(wording::not_exercised(report).map(|parts| ("not_exercised", parts)));
    list.extend(wording::coverage(report).map(|share| ("coverage", share)));
    if let Some(identity) = &report.board.identity {
        list.push(("board.name", identity.name.clone()));
        if identity.serial.bytes().any(|digit| digit != b'0') {
            // A station's name for it, whose `serial` is the unit's.
            list.extend(["board.serial", "board.device"].map(|name| (name, identity.serial.clone())));
        }
        list.push(("board.build", identity.build.clone()));
    }
    list
}

fn verdict_case(report: &Report) -> TestCase {
    let outcome = match report.verdict() {
        Verdict::Pass => Outcome::Passed,
        Verdict::Fail => Outcome::Failed,
        Verdict::Error => Outcome::Error,
    };
    let advice = wording::advice(report).join("\n");
    case(report.command(), "verdict", 0.0, status(outcome, &report.headline(), &advice))
}

fn check_case(check: &Check) -> TestCase {
    case("check", check.name.name(), check.seconds, status(check.outcome, &check.detail(), ""))
}

fn frame_case(report: &Report, frame: &FrameReport) -> TestCase {
    let comparison = &frame.comparison;
    let message = match comparison.differences {
        0 => format!("{} of {} came back", frame.rows, count(frame.height(), "row")),
        some => differ_of(some, comparison.samples, "sample"),
    };
    let first = comparison.first.map_or_else(String::new, |first| {
        format!(
            "First at row {}, column {}: expected {}, found {}; largest difference {}.",
            first.row, first.column, first.expected, first.found, comparison.largest
        )
    });
    // The number tells frames of the same name apart.
    let name =
        format!("{} (frame {}, {}, {})", wording::frame_name(frame), frame.number, frame.phase, frame.timing);
    case("frame", &name, frame.seconds, status(wording::frame_outcome(report, frame), &message, &first))
}

/// A test case that took `seconds`.
fn case(class: &str, name: &str, seconds: f64, status: Status) -> TestCase {
    let mut case = TestCase::new(plain(name), status);
    case.time = Duration::try_from_secs_f64(seconds).ok();
    case.set_classname(format!("halfrow.{class}"));
    case
}

fn status(outcome: Outcome, message: &str, description: &str) -> Status {
    let mut status = match outcome {
        Outcome::Passed => return Status::success(),
        Outcome::Failed => Status::non_success(NonSuccessKind::Failure),
        Outcome::Error => Status::non_success(NonSuccessKind::Error),
        Outcome::Skipped => Status::skipped(),
    };
    status.set_message(plain(message));
    if outcome != Outcome::Skipped {
        status.set_type(wording::mark(outcome));
    }
    if !description.is_empty() {
        status.set_description(description);
    }
    status
}
