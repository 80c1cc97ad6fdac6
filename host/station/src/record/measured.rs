//! What was measured, against its limits.

use std::iter;

use serde::{Deserialize, Serialize};
use strum::{AsRefStr, Display};

use super::RunCause;
use crate::plan::limits::{Blame, Limit, MEASUREMENTS, Maker, Measurement};
use crate::said::{Said, Saying};

/// A measurement, with its limit if it has one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// Its name.
    pub name: String,
    /// Its value; none if it could not be measured.
    pub value: Option<f64>,
    /// Its unit.
    pub unit: String,
    /// The lowest value that is right.
    pub low: Option<f64>,
    /// The highest value that is right.
    pub high: Option<f64>,
    /// Who is to blame for a value outside these limits.
    pub blames: Blame,
    /// Its outcome.
    pub outcome: MeasuredOutcome,
}

/// The outcome of a measurement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, AsRefStr, Display)]
#[serde(rename_all = "lowercase")]
#[strum(serialize_all = "lowercase")]
pub enum MeasuredOutcome {
    /// Within its limit.
    Passed,
    /// Outside its limit.
    Failed,
    /// It has a limit and no value.
    Unset,
    /// It has no limit.
    #[serde(rename = "not judged")]
    #[strum(serialize = "not judged")]
    NotJudged,
}

impl Measured {
    fn of(measurement: Measurement, value: Option<f64>, limit: Option<&Limit>) -> Self {
        let outcome = match (limit, value) {
            (None, _) => MeasuredOutcome::NotJudged,
            (Some(_), None) => MeasuredOutcome::Unset,
            (Some(limit), Some(value)) if limit.allows(value) => MeasuredOutcome::Passed,
            (Some(_), Some(_)) => MeasuredOutcome::Failed,
        };
        Self {
            name: measurement.name.to_owned(),
            value,
            unit: measurement.unit.to_owned(),
            low: limit.and_then(|limit| limit.least),
            high: limit.and_then(|limit| limit.most),
            blames: limit.map_or(measurement.blames, |limit| limit.blames),
            outcome,
        }
    }

    /// The cause of an ERROR or FAIL, if the value is outside a limit that blames somebody, or could not be measured.
    #[must_use]
    pub fn fault(&self) -> Option<RunCause> {
        match (self.outcome, self.blames) {
            (_, Blame::Nobody) | (MeasuredOutcome::Passed | MeasuredOutcome::NotJudged, _) => None,
            (MeasuredOutcome::Unset, _) => Some(RunCause::Refused),
            (MeasuredOutcome::Failed, Blame::Board) => Some(RunCause::Board),
            (MeasuredOutcome::Failed, Blame::Station) => Some(RunCause::Station),
        }
    }

    /// The one of `all` that counts, and its fault: a fault that is not the board's is worse, as the board was not judged
    /// correctly then, and of two equally bad ones the first counts.
    #[must_use]
    pub(crate) fn worst(all: &[Self]) -> Option<(&Self, RunCause)> {
        let mut faults = all.iter().filter_map(|one| Some((one, one.fault()?)));
        let first = faults.next()?;
        Some(iter::once(first).chain(faults).find(|(_, cause)| *cause != RunCause::Board).unwrap_or(first))
    }

    /// The statement that the value is outside its limit, or missing.
    #[must_use]
    pub fn said(&self) -> Said {
        let (sentence, low, high) = (self.sentence(), self.low, self.high);
        let (name, unit) = (self.name.clone(), self.unit.clone());
        match self.value {
            Some(value) => Saying::BeyondLimit { sentence, name, value, unit, low, high }.into(),
            None => Saying::NotMeasured { sentence, name, unit, low, high }.into(),
        }
    }

    /// The value and its limit in one sentence.
    #[must_use]
    pub fn sentence(&self) -> String {
        // Rounded to a millionth.
        let told = |value: f64| (value * 1e6).round() / 1e6;
        let side = |word: &str, bound: Option<f64>| bound.map(|bound| format!("{word} {}", told(bound)));
        let sides = [side("at least", self.low), side("at most", self.high)];
        let limit = sides.into_iter().flatten().collect::<Vec<_>>().join(" and ");
        let name = &self.name;
        let unit = if self.unit == "1" { String::new() } else { format!(" {}", self.unit) };
        match self.value {
            Some(value) => format!("{name} is {}{unit}, and {limit} is right", told(value)),
            None => format!("{name} could not be measured, and {limit} is asked for"),
        }
    }
}

/// All measurements that `made_by` makes, judged against `limits`; `values` has their values by name.
#[must_use]
pub fn judged(made_by: Maker, values: &[(&str, Option<f64>)], limits: &[Limit]) -> Vec<Measured> {
    let made = MEASUREMENTS.into_iter().filter(|measurement| measurement.made_by == made_by);
    let one = |measurement: Measurement| {
        let value = values.iter().find(|(name, _)| *name == measurement.name).and_then(|(_, value)| *value);
        let limit = limits.iter().find(|limit| limit.measurement == measurement);
        Measured::of(measurement, value, limit)
    };
    made.map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn limited(value: Option<f64>, least: Option<f64>, most: Option<f64>, blames: Blame) -> Measured {
        let measurement = Measurement::named("link.together").unwrap();
        Measured::of(measurement, value, Some(&Limit { measurement, least, most, blames }))
    }

    #[test]
    fn a_limit_says_whose_fault_it_is() {
        let of = |value, blames| limited(value, Some(10.0), Some(20.0), blames).fault();
        for right in [10.0, 15.0, 20.0] {
            assert_eq!(of(Some(right), Blame::Board), None);
        }
        for wrong in [9.9, 20.1] {
            assert_eq!(of(Some(wrong), Blame::Board), Some(RunCause::Board));
            assert_eq!(of(Some(wrong), Blame::Station), Some(RunCause::Station));
            assert_eq!(of(Some(wrong), Blame::Nobody), None);
        }
        assert_eq!(
            of(None, Blame::Board),
            Some(RunCause::Refused),
            "what nobody measured is no PASS and no FAIL"
        );
        assert_eq!(of(None, Blame::Nobody), None);
    }

    #[test]
    fn every_measurement_of_a_step_is_there_with_a_limit_or_without() {
        let measurement = Measurement::named("latency.clocks").unwrap();
        let limit = Limit { measurement, least: None, most: Some(40.0), blames: Blame::Board };
        let all =
            judged(Maker::Verify, &[("latency.clocks", Some(41.0)), ("verify.seconds", Some(2.0))], &[limit]);
        let outcomes: Vec<_> = all.iter().map(|one| (one.name.as_str(), one.outcome.as_ref())).collect();
        let expected = [
            ("latency.clocks", "failed"),
            ("latency.microseconds", "not judged"),
            ("verify.retries", "not judged"),
            ("verify.seconds", "not judged"),
            ("frames.samples_differing", "not judged"),
        ];
        assert_eq!(outcomes, expected);
        assert_eq!(all[0].sentence(), "latency.clocks is 41 clocks, and at most 40 is right");
    }
}
