//! A run as the JSON that OpenHTF 1.6 writes of its own test records (`openhtf.output.callbacks.json_factory`): a try of
//! a step is a phase.

use std::time::Duration;

use serde_json::{Map, Value, json};

use crate::record::{Measured, MeasuredOutcome, Record, RunCause, StepOutcome, StepRecord};

pub(super) fn of(record: &Record) -> Value {
    let Record { run, plan, conclusion: ended, .. } = record;
    // OpenHTF has an outcome of its own for what the operator caused.
    let outcome = match ended.cause {
        RunCause::Operator => "ABORTED".to_owned(),
        _ => ended.verdict.to_string(),
    };
    let ended_ms = ended_ms(run.started_ms, record.took());
    let whole = (!record.measurements.is_empty()).then(|| {
        let times = (run.started_ms, ended_ms);
        phase(0, "run", times, worst(&record.measurements), record.marginal, &record.measurements)
    });
    let phases: Vec<_> = record.steps.iter().map(|step| of_step(record, step)).chain(whole).collect();
    json!({
        "dut_id": run.serial,
        "start_time_millis": run.started_ms,
        "end_time_millis": phases.iter().filter_map(|it| it["end_time_millis"].as_i64()).fold(ended_ms, i64::max),
        "outcome": outcome,
        "outcome_details": [{ "code": ended.cause, "description": ended.headline }],
        "marginal": record.marginal,
        "metadata": metadata(record),
        "phases": phases,
        "subtests": [],
        "branches": [],
        "diagnosers": [],
        "diagnoses": [],
        "log_records": [],
        "station_id": run.station,
        "code_info": code_info("halfrow-station", &plan.text),
    })
}

/// What OpenHTF has no member for.
fn metadata(record: &Record) -> Value {
    let Record { run, plan, board, conclusion, .. } = record;
    json!({
        "test_name": plan.name,
        "test_version": plan.version,
        "operator_name": run.operator,
        "run": run.id,
        "product": run.product,
        "variant": run.variant,
        "lane": run.lane,
        "plan_sha256": plan.sha256,
        "board_target": run.target,
        "board_kind": board.as_ref().map(|board| &board.kind),
        "board_device": board.as_ref().and_then(|board| board.device.as_ref()),
        "board_build": board.as_ref().map(|board| &board.build),
        "program": record.program,
        "production": record.production,
        // The code among the outcome's details is the cause.
        "finding_code": conclusion.finding.as_ref().map(|said| &said.code),
        "config": {},
    })
}

/// The end of what began at `started_ms`, never before it even if the clock was set back: readers of the format
/// subtract the two.
fn ended_ms(started_ms: i64, took: Option<Duration>) -> i64 {
    started_ms.saturating_add_unsigned(took.map_or(0, |took| took.as_millis() as u64))
}

/// The outcome by the limits of the run as a whole; those of a step are in the step's outcome.
fn worst(measured: &[Measured]) -> &'static str {
    match Measured::worst(measured).map(|(_, cause)| cause) {
        None => "PASS",
        Some(RunCause::Board) => "FAIL",
        Some(_) => "ERROR",
    }
}

fn of_step(record: &Record, step: &StepRecord) -> Value {
    let outcome = match step.outcome {
        StepOutcome::Passed => "PASS",
        StepOutcome::Failed => "FAIL",
        StepOutcome::Error => "ERROR",
        StepOutcome::Skipped => "SKIP",
    };
    let times = (step.started_ms, ended_ms(step.started_ms, record.took_for(step)));
    phase(step.seq, &step.name, times, outcome, step.attempt > 1, &step.measurements)
}

fn phase(
    number: u32,
    name: &str,
    (started_ms, ended_ms): (i64, i64),
    outcome: &str,
    marginal: bool,
    measured: &[Measured],
) -> Value {
    let measurements: Map<_, _> = measured.iter().map(|one| (one.name.clone(), measurement(one))).collect();
    json!({
        "measurements": measurements,
        "options": null,
        "diagnosers": [],
        "subtest_name": null,
        "start_time_millis": started_ms,
        "end_time_millis": ended_ms,
        "attachments": {},
        "diagnosis_results": [],
        "failure_diagnosis_results": [],
        "result": null,
        "outcome": outcome,
        "marginal": marginal,
        "descriptor_id": number,
        "name": name,
        "codeinfo": code_info(name, ""),
    })
}

fn code_info(name: &str, source: &str) -> Value {
    json!({ "name": name, "docstring": null, "sourcecode": source })
}

/// OpenHTF has no limit that blames nobody: such a measurement passes there, and its limit is in words.
fn measurement(one: &Measured) -> Value {
    let outcome = match one.outcome {
        MeasuredOutcome::Unset => "UNSET",
        MeasuredOutcome::Failed if one.fault().is_some() => "FAIL",
        _ if one.value.is_none() => "UNSET",
        _ => "PASS",
    };
    let mut fields = Map::new();
    fields.insert("name".to_owned(), one.name.clone().into());
    fields.insert("outcome".to_owned(), outcome.into());
    if let Some(range) = range(one) {
        fields.insert("validators".to_owned(), json!([range]));
    }
    fields.insert("docstring".to_owned(), format!("in {}, blames {}", one.unit, one.blames).into());
    if let Some(value) = one.value {
        fields.insert("measured_value".to_owned(), value.into());
    }
    Value::Object(fields)
}

/// A limit as `openhtf.util.validators.InRange` writes it.
fn range(one: &Measured) -> Option<String> {
    let (low, high) = (one.low, one.high);
    match (low, high) {
        (None, None) => None,
        (Some(low), None) => Some(format!("{low:?} <= x")),
        (None, Some(high)) => Some(format!("x <= {high:?}")),
        (Some(low), Some(high)) if low == high => Some(format!("x == {low:?}")),
        (Some(low), Some(high)) => Some(format!("{low:?} <= x <= {high:?}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::limits::{Blame, Limit, Maker, Measurement};
    use crate::record::judged;
    use crate::record::tests::{pass, steps};

    /// The names are those of `test_record.Outcome` and `PhaseOutcome` of OpenHTF 1.6.
    #[test]
    fn a_run_and_its_tries_end_as_openhtf_calls_it() {
        let mut record =
            Record { steps: steps(), measurements: Vec::new(), marginal: true, seconds: Some(2.5), ..pass() };
        record.conclusion.cause = RunCause::Operator;
        let told = of(&record);
        let phases: Vec<_> = told["phases"].as_array().unwrap().iter().collect();
        let ended: Vec<_> = phases.iter().map(|phase| (&phase["outcome"], &phase["marginal"])).collect();
        let expected = [("ERROR", false), ("PASS", true), ("FAIL", false), ("SKIP", false)]
            .map(|(outcome, marginal)| (json!(outcome), json!(marginal)));
        assert_eq!(ended, expected.each_ref().map(|(outcome, marginal)| (outcome, marginal)));
        assert_eq!((&told["outcome"], &told["marginal"]), (&json!("ABORTED"), &json!(true)));
        assert_eq!((&told["start_time_millis"], &told["end_time_millis"]), (&json!(1), &json!(2501)));
        record.conclusion.cause = RunCause::None;
        assert_eq!(of(&record)["outcome"], "PASS");
    }

    /// The sentences are those of `validators.InRange.__str__` of OpenHTF 1.6.
    #[test]
    fn a_measurement_has_its_value_and_its_limit_in_openhtf_s_words() {
        let measured = |value, least, most, blames| {
            let measurement = Measurement::named("run.seconds").unwrap();
            judged(Maker::Run, &[("run.seconds", value)], &[Limit { measurement, least, most, blames }])
                .remove(0)
        };
        for (value, least, most, outcome, told) in [
            (Some(1.5), Some(1.0), None, "PASS", "1.0 <= x"),
            (Some(1.5), None, Some(1.0), "FAIL", "x <= 1.0"),
            (Some(1.5), Some(1.0), Some(2.0), "PASS", "1.0 <= x <= 2.0"),
            (Some(1.5), Some(1.5), Some(1.5), "PASS", "x == 1.5"),
            (None, Some(1.0), None, "UNSET", "1.0 <= x"),
        ] {
            let one = measurement(&measured(value, least, most, Blame::Board));
            assert_eq!((&one["outcome"], &one["validators"]), (&json!(outcome), &json!([told])));
            assert_eq!(one.get("measured_value"), value.map(|value| json!(value)).as_ref());
        }
        // What was not measured has not passed, even if nobody is blamed or nobody asks.
        assert_eq!(measurement(&measured(None, Some(1.0), None, Blame::Nobody))["outcome"], "UNSET");
        let unlimited = judged(Maker::Run, &[], &[]).remove(0);
        assert_eq!(measurement(&unlimited)["outcome"], "UNSET");
        // A station's fault is never FAIL.
        let of = |blames| measured(Some(1.5), Some(2.0), None, blames);
        assert_eq!(worst(&[of(Blame::Board), of(Blame::Station)]), "ERROR");
        assert_eq!(worst(&[of(Blame::Nobody), of(Blame::Board)]), "FAIL");
        assert_eq!(worst(&[of(Blame::Nobody)]), "PASS");
    }
}
