//! A run as JUnit XML: its verdict, then the last try of every step, then every limit.

use std::time::Duration;

use halfrow::Verdict;
use halfrow::report::junit_document;
use halfrow::words::plain;
use jiff::Timestamp;
use quick_junit::{NonSuccessKind, Property, SerializeError, TestCase, TestCaseStatus as Status, TestSuite};

use crate::record::{
    Measured, MeasuredOutcome, Record, RunCause, StepOutcome, StepRecord, in_one_line, last_tries,
};

pub(super) fn render(record: &Record) -> Result<String, SerializeError> {
    let mut suite = TestSuite::new(plain(&format!("{} {}", record.plan.name, record.plan.version)));
    let started = Timestamp::from_millisecond(record.run.started_ms).ok();
    suite.timestamp = started.and_then(|started| started.to_string().parse().ok());
    suite.time = record.took();
    for (name, value) in properties(record) {
        suite.add_property(Property::new(name, plain(&value)));
    }
    suite.add_test_case(verdict(record));
    suite.add_test_cases(last_tries(&record.steps).map(|step| step_case(step, record.took_for(step))));
    for step in last_tries(&record.steps) {
        suite.add_test_cases(limits(&step.name, &step.measurements));
    }
    suite.add_test_cases(limits("run", &record.measurements));
    junit_document(suite)
}

fn properties(record: &Record) -> Vec<(&'static str, String)> {
    let run = &record.run;
    let mut list = vec![
        ("verdict", record.conclusion.verdict.to_string()),
        ("cause", record.conclusion.cause.to_string()),
        ("run", run.id.clone()),
        ("product", run.product.clone()),
        ("serial", run.serial.clone()),
        ("station", run.station.clone()),
        ("lane", run.lane.clone()),
        ("operator", run.operator.clone()),
        ("plan.sha256", record.plan.sha256.clone()),
        ("production", record.production.to_string()),
        ("board.target", run.target.clone()),
        ("halfrow.version", record.program.clone()),
    ];
    list.extend(record.conclusion.finding.iter().map(|said| ("code", said.code.clone())));
    if !run.variant.is_empty() {
        list.push(("variant", run.variant.clone()));
    }
    list.extend(
        record.not_exercised().iter().map(|(step, parts)| ("not_exercised", in_one_line(step, parts))),
    );
    if let Some(board) = &record.board {
        list.push(("board.kind", board.kind.clone()));
        list.push(("board.build", board.build.clone()));
        list.extend(board.device.iter().map(|device| ("board.device", device.clone())));
    }
    list
}

fn verdict(record: &Record) -> TestCase {
    let ended = &record.conclusion;
    let kind = match ended.verdict {
        Verdict::Pass => None,
        Verdict::Fail => Some(NonSuccessKind::Failure),
        Verdict::Error => Some(NonSuccessKind::Error),
    };
    let remedy = ended.remedy.as_deref().unwrap_or_default();
    case("run", "verdict", Some(Duration::ZERO), status(kind, &ended.headline, remedy))
}

fn step_case(step: &StepRecord, took: Option<Duration>) -> TestCase {
    let status = match step.outcome {
        StepOutcome::Passed => Status::success(),
        StepOutcome::Skipped => Status::skipped(),
        StepOutcome::Failed => status(Some(NonSuccessKind::Failure), &step.detail, ""),
        StepOutcome::Error => status(Some(NonSuccessKind::Error), &step.detail, ""),
    };
    // The number tells two steps of the same name apart.
    let name = format!("{} (step {}, try {})", step.name, step.seq, step.attempt);
    case("step", &name, took, status)
}

/// A case for each measurement that has a limit; a limit that blames nobody fails nothing.
fn limits(step: &str, measured: &[Measured]) -> Vec<TestCase> {
    let limited = measured.iter().filter(|one| one.outcome != MeasuredOutcome::NotJudged);
    let one = |one: &Measured| {
        let kind = one.fault().map(|cause| match cause {
            RunCause::Board => NonSuccessKind::Failure,
            _ => NonSuccessKind::Error,
        });
        let name = format!("{} ({step})", one.name);
        case("limit", &name, Some(Duration::ZERO), status(kind, &one.sentence(), ""))
    };
    limited.map(one).collect()
}

fn case(class: &str, name: &str, took: Option<Duration>, status: Status) -> TestCase {
    let mut case = TestCase::new(plain(name), status);
    case.time = took;
    case.set_classname(format!("halfrow-station.{class}"));
    case
}

fn status(kind: Option<NonSuccessKind>, message: &str, description: &str) -> Status {
    let Some(kind) = kind else { return Status::success() };
    let mut status = Status::non_success(kind);
    status.set_message(plain(message));
    status.set_type(if kind == NonSuccessKind::Failure { "FAIL" } else { "ERROR" });
    if !description.is_empty() {
        status.set_description(plain(description));
    }
    status
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::limits::{Blame, Limit, Maker, Measurement};
    use crate::record::judged;
    use crate::record::tests::{pass, step, steps};

    /// The element of this tag whose head contains `name`, up to its end.
    fn element(document: &str, tag: &str, name: &str) -> String {
        let head = format!("<{tag} ");
        let heads = document.match_indices(&head).map(|(at, _)| &document[at..]);
        let mut named = heads.filter(|from| from.split('>').next().unwrap().contains(name));
        let from = named.next().unwrap_or_else(|| panic!("no {name} in {document}"));
        let end = if from.split('>').next().unwrap().ends_with('/') { "/>" } else { "</testcase>" };
        from[..from.find(end).unwrap()].to_owned()
    }

    #[test]
    fn the_last_try_of_each_step_is_a_case_and_each_limit_with_what_to_do_behind_a_fail() {
        let limit = Limit {
            measurement: Measurement::named("run.seconds").unwrap(),
            least: None,
            most: Some(60.0),
            blames: Blame::Board,
        };
        let measurements = judged(Maker::Run, &[("run.seconds", Some(1.5))], &[limit]);
        let mut record = Record { steps: steps(), measurements, ..pass() };
        (record.conclusion.verdict, record.conclusion.cause) = (Verdict::Fail, RunCause::Board);
        record.conclusion.remedy = Some("Put the board aside.".to_owned());
        let document = render(&record).unwrap();
        assert!(document.contains("tests=\"5\"") && document.contains("skipped=\"1\""), "{document}");
        assert!(document.contains("failures=\"2\" errors=\"0\""), "{document}");
        assert!(!document.contains("step 1, try 1"), "{document}");
        assert!(element(&document, "testcase", "\"step 3 (step 3, try 1)\"").contains("<skipped"));
        assert!(element(&document, "testcase", "\"verdict\"").contains("Put the board aside."));
        element(&document, "testcase", "\"run.seconds (run)\"");
        for (name, value) in [
            ("product", "CAM-A"),
            ("serial", "CA1"),
            ("station", "12"),
            ("operator", "weber"),
            ("production", "true"),
        ] {
            let property = format!("<property name=\"{name}\" value=\"{value}\"");
            assert!(document.contains(&property), "{property}: {document}");
        }
        // A measurement without a limit is not a case.
        let none = judged(Maker::Run, &[("run.seconds", Some(1.5))], &[]);
        assert!(!render(&Record { measurements: none, ..record }).unwrap().contains("run.seconds (run)"));
    }

    #[test]
    fn a_run_is_as_long_as_it_was_although_its_computer_was_set() {
        let began = pass().run.started_ms;
        let step = step(1, 1, StepOutcome::Passed, RunCause::None);
        let set = |seconds, ended_ms, step_ended_ms| {
            let step = StepRecord { started_ms: began, ended_ms: step_ended_ms, ..step.clone() };
            let document = render(&Record { seconds, ended_ms, steps: vec![step], ..pass() }).unwrap();
            let times = |tag: &str| {
                let from = document.find(tag).unwrap();
                let head = &document[from..from + document[from..].find('>').unwrap()];
                head.split_once(" time=\"").map(|(_, time)| time.split('"').next().unwrap().to_owned())
            };
            ["<testsuite ", "<testcase name=\"step 1 ("].map(times)
        };
        let some = |time: &str| Some(time.to_owned());
        assert_eq!(set(Some(0.5), began + 500, began + 250), [some("0.500"), some("0.250")]);
        assert_eq!(set(Some(0.5), began - 7000, began - 7250), [some("0.500"), None]);
        assert_eq!(set(Some(0.5), began + 90_000, began + 89_000), [some("0.500"), None]);
        assert_eq!(set(None, began + 500, began + 250), [some("0.500"), some("0.250")]);
        assert_eq!(set(None, began - 500, began - 250), [None, None]);
    }
}
