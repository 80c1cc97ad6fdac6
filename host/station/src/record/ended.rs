//! The record of a run that has just ended.

use super::{BoardSeen, Conclusion, DeviceSeen, PlanRecord, Record, RunHead, SCHEMA, StepRecord};
use crate::clock;

impl Record {
    /// The record of a run that is over now, without what only a lane that reported to its end has. `counts` says whether the run
    /// counts as production if its board is hardware.
    #[must_use]
    pub(crate) fn of(
        run: RunHead,
        plan: PlanRecord,
        steps: Vec<StepRecord>,
        conclusion: Conclusion,
        counts: bool,
    ) -> Self {
        let board = steps.iter().find_map(|step| step.board.clone());
        Self {
            schema: SCHEMA,
            // The clock may have been set back meanwhile.
            ended_ms: clock::now_ms().max(run.started_ms),
            run,
            seconds: None,
            conclusion,
            plan,
            // A board that never identified itself may be a product.
            production: counts && board.as_ref().is_none_or(BoardSeen::is_hardware),
            marginal: steps.iter().any(|step| step.attempt > 1),
            board,
            device: DeviceSeen::NotChecked,
            steps,
            measurements: Vec::new(),
            suspects: Vec::new(),
            attachments: Vec::new(),
            program: halfrow::VERSION.to_owned(),
        }
    }
}
