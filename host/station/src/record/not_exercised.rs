//! What a PASS does not cover.

use halfrow::Verdict;
use serde_json::Value;

use super::{Record, StepOutcome, StepRecord};
use crate::said::Said;

impl Record {
    /// What no frame exercised in the steps of a PASS that judged, by the name of the step; a fault there would have gone unseen.
    #[must_use]
    pub fn not_exercised(&self) -> Vec<(&str, Vec<Said>)> {
        let is_pass = self.conclusion.verdict == Verdict::Pass;
        let steps = self.steps.iter().filter(|step| is_pass && step.outcome == StepOutcome::Passed);
        steps.map(|step| (step.name.as_str(), of_step(step))).filter(|(_, parts)| !parts.is_empty()).collect()
    }
}

fn of_step(step: &StepRecord) -> Vec<Said> {
    let parts = step.evidence.as_ref().and_then(|evidence| evidence.get("not_exercised"));
    let all = parts.and_then(Value::as_array).into_iter().flatten();
    all.filter_map(part).collect()
}

/// A part in the words of the judge, with its code.
fn part(of: &Value) -> Option<Said> {
    Said::reported(of, of.get("words")?.as_str()?)
}

/// The parts of a step in one line, with the step's name.
pub(crate) fn in_one_line(step: &str, parts: &[Said]) -> String {
    let words: Vec<_> = parts.iter().map(|part| part.message.as_str()).collect();
    format!("{step}: {}", words.join("; "))
}
