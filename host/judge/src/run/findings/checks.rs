//! The outcomes of a run's checks, and the time that each has taken.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use super::end::End;
use crate::result::{Check, CheckName, Finding, Outcome};

/// The checks that were made so far.
pub(crate) struct Checks {
    made: Vec<Check>,
    spent: BTreeMap<CheckName, Duration>,
    since: Instant,
}

impl Checks {
    pub(crate) fn new() -> Self {
        Self { made: Vec::new(), spent: BTreeMap::new(), since: Instant::now() }
    }

    pub(crate) fn passed(&mut self, name: CheckName, finding: Finding) {
        self.note(name, Outcome::Passed, finding);
    }

    pub(crate) fn skipped(&mut self, name: CheckName, finding: Finding) {
        self.note(name, Outcome::Skipped, finding);
    }

    /// Notes the check by which the run ends, or one that is wrong in addition to it. After an upload that failed, what was
    /// read back was of earlier tables.
    pub(crate) fn ended(&mut self, end: &End) {
        if end.check() == CheckName::Upload {
            self.made.retain(|check| check.name != CheckName::ReadBack);
        }
        self.note(end.check(), end.outcome(), end.finding().clone());
    }

    /// Notes the outcome of a check. If a check is made again, its last outcome stands, and its times add up.
    fn note(&mut self, name: CheckName, outcome: Outcome, finding: Finding) {
        self.lap(name);
        let seconds = self.spent.get(&name).map_or(0.0, Duration::as_secs_f64);
        self.made.retain(|earlier| earlier.name != name);
        self.made.push(Check { name, outcome, finding, seconds });
    }

    /// Adds the time since the last lap to a check.
    pub(crate) fn lap(&mut self, name: CheckName) {
        let now = Instant::now();
        *self.spent.entry(name).or_default() += now.duration_since(self.since);
        self.since = now;
    }

    /// Drops the time since the last lap, which is reported elsewhere.
    pub(crate) fn begin_lap(&mut self) {
        self.since = Instant::now();
    }

    /// Whether a check was made and passed.
    pub(crate) fn has_passed(&self, name: CheckName) -> bool {
        self.made.iter().any(|check| check.name == name && check.outcome == Outcome::Passed)
    }

    /// Forgets what was found of the open board.
    pub(crate) fn begin_again(&mut self) {
        self.made.retain(|check| matches!(check.name, CheckName::Judge | CheckName::Identity));
    }

    /// All checks in order; those that were not made are skipped with the finding of `left_out`.
    pub(crate) fn all(mut self, left_out: impl Fn(CheckName) -> Finding) -> Vec<Check> {
        for name in CheckName::ALL {
            if !self.made.iter().any(|check| check.name == name) {
                let finding = left_out(name);
                self.made.push(Check { name, outcome: Outcome::Skipped, finding, seconds: 0.0 });
            }
        }
        self.made.sort_by_key(|check| check.name);
        self.made
    }
}
