//! How long the station waits for a lane.

use std::time::Duration;

use halfrow::link_test;

use crate::lane::supervisor::Patience;
use crate::plan::{Selected, Step, StepKind};

/// The patience with a lane that carries out `selected` and may be silent for `silence` in addition to its link tests.
pub(super) fn of(silence: Duration, selected: &Selected) -> Patience {
    let tries = selected.steps.iter().map(|step| step.retries as usize + 1).sum();
    Patience { silence: silence.saturating_add(longest_link_test(selected)), whole: whole(selected), tries }
}

/// How long the longest link test is silent when all is well: each of its parts takes the time that the plan gives.
fn longest_link_test(selected: &Selected) -> Duration {
    let parts = |step: &Step| match step.kind {
        StepKind::Link { each } => each.saturating_mul(link_test::PARTS),
        StepKind::Identity | StepKind::Verify(_) => Duration::ZERO,
    };
    selected.steps.iter().map(parts).max().unwrap_or_default()
}

/// The longest that a run may take: the timeouts of all tries of all steps, and the longest timeout once more for the
/// rest.
fn whole(selected: &Selected) -> Duration {
    let tries = selected.steps.iter().map(|step| step.timeout.saturating_mul(step.retries + 1));
    let longest = selected.steps.iter().map(|step| step.timeout).max().unwrap_or_default();
    tries.fold(longest, Duration::saturating_add)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lane_may_be_silent_for_all_parts_of_its_longest_link_test() {
        let step = |seconds, retries, kind| Step {
            name: "a step".to_owned(),
            timeout: Duration::from_secs(seconds),
            retries,
            kind,
        };
        let link = |seconds| StepKind::Link { each: Duration::from_secs(seconds) };
        let patience = |steps| of(Duration::from_secs(5), &Selected { steps, limits: Vec::new() });
        let tested =
            patience(vec![step(1, 0, StepKind::Identity), step(20, 2, link(3)), step(30, 0, link(2))]);
        assert_eq!(tested.silence, Duration::from_secs(5 + u64::from(link_test::PARTS) * 3));
        assert_eq!(tested.whole, Duration::from_secs(1 + 3 * 20 + 30 + 30));
        assert_eq!(tested.tries, 1 + 3 + 1);
        assert_eq!(patience(vec![step(1, 0, StepKind::Identity)]).silence, Duration::from_secs(5));
    }
}
