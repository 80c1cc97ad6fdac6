//! The text of every statement. SQLite and PostgreSQL have the same, but for three words.

/// The schemas, in order: numbered files that are never edited.
pub(super) const SCHEMAS: [&str; 6] = [
    include_str!("../../sql/schema-1.sql"),
    include_str!("../../sql/schema-2.sql"),
    include_str!("../../sql/schema-3.sql"),
    include_str!("../../sql/schema-4.sql"),
    include_str!("../../sql/schema-5.sql"),
    include_str!("../../sql/schema-6.sql"),
];

pub(super) const SCHEMA_VERSION: &str = include_str!("../../sql/schema-version.sql");
pub(super) const ADD_PLAN: &str = include_str!("../../sql/add-plan.sql");
pub(super) const ADD_UNIT: &str = include_str!("../../sql/add-unit.sql");
pub(super) const UNIT_OF: &str = include_str!("../../sql/unit-of.sql");
pub(super) const PLAN_EARLIER: &str = include_str!("../../sql/plan-earlier.sql");
pub(super) const UNIT_EARLIER: &str = include_str!("../../sql/unit-earlier.sql");
pub(super) const OPEN_RUN: &str = include_str!("../../sql/open-run.sql");
pub(super) const FINISH_RUN: &str = include_str!("../../sql/finish-run.sql");
pub(super) const ADD_STEP: &str = include_str!("../../sql/add-step.sql");
pub(super) const ADD_MEASUREMENT: &str = include_str!("../../sql/add-measurement.sql");
pub(super) const ADD_SUSPECT: &str = include_str!("../../sql/add-suspect.sql");
pub(super) const ADD_ATTACHMENT: &str = include_str!("../../sql/add-attachment.sql");
pub(super) const ADD_DAY_COUNT: &str = include_str!("../../sql/add-day-count.sql");
pub(super) const ADD_RETEST: &str = include_str!("../../sql/add-retest.sql");
pub(super) const ADD_FAILURES: &str = include_str!("../../sql/add-failures.sql");
pub(super) const VERDICT_OF: &str = include_str!("../../sql/verdict-of.sql");
pub(super) const OPEN_RUNS: &str = include_str!("../../sql/open-runs.sql");
pub(super) const FINAL_RUNS: &str = include_str!("../../sql/final-runs.sql");
pub(super) const ADD_WAIVER: &str = include_str!("../../sql/add-waiver.sql");
pub(super) const ADD_AUDIT: &str = include_str!("../../sql/add-audit.sql");
pub(super) const WAIVER_OF: &str = include_str!("../../sql/waiver-of.sql");
pub(super) const ATTACHMENTS: &str = include_str!("../../sql/attachments.sql");
pub(super) const PRUNED: &str = include_str!("../../sql/pruned.sql");
pub(super) const OLD_EVIDENCE: &str = include_str!("../../sql/old-evidence.sql");
pub(super) const NAMED_EVIDENCE: &str = include_str!("../../sql/named-evidence.sql");
pub(crate) const RUNS: &str = include_str!("../../sql/runs.sql");
pub(crate) const PLANS: &str = include_str!("../../sql/plans.sql");
pub(crate) const UNITS_OF_SERIAL: &str = include_str!("../../sql/units-of-serial.sql");
pub(crate) const UNIT_RUNS: &str = include_str!("../../sql/unit-runs.sql");
pub(crate) const UNIT_STEPS: &str = include_str!("../../sql/unit-steps.sql");
pub(crate) const UNIT_SUSPECTS: &str = include_str!("../../sql/unit-suspects.sql");
pub(crate) const UNIT_ATTACHMENTS: &str = include_str!("../../sql/unit-attachments.sql");
pub(crate) const UNIT_BINDINGS: &str = include_str!("../../sql/unit-bindings.sql");
pub(crate) const UNIT_WAIVERS: &str = include_str!("../../sql/unit-waivers.sql");
pub(crate) const YIELD_DAYS: &str = include_str!("../../sql/yield-days.sql");
pub(crate) const YIELD_HOURS: &str = include_str!("../../sql/yield-hours.sql");
pub(crate) const DAY_RUNS: &str = include_str!("../../sql/day-runs.sql");
pub(crate) const COUNTS: &str = include_str!("../../sql/counts.sql");
pub(crate) const FAILED_RUNS: &str = include_str!("../../sql/failed-runs.sql");
pub(crate) const RETESTS: &str = include_str!("../../sql/retests.sql");
pub(crate) const SERIAL_OF: &str = include_str!("../../sql/serial-of.sql");
pub(crate) const WAIVED: &str = include_str!("../../sql/waived.sql");
pub(crate) const FAILURES: &str = include_str!("../../sql/failures.sql");
pub(super) const ADD_BINDING: &str = include_str!("../../sql/add-binding.sql");
pub(super) const END_BINDINGS: &str = include_str!("../../sql/end-bindings.sql");
pub(super) const UNIT_OF_DEVICE: &str = include_str!("../../sql/unit-of-device.sql");
pub(super) const DEVICE_OF_UNIT: &str = include_str!("../../sql/device-of-unit.sql");
pub(super) const AUDIT_OF_ACT: &str = include_str!("../../sql/audit-of-act.sql");
pub(super) const LAST_JUDGEMENT: &str = include_str!("../../sql/last-judgement.sql");
pub(super) const PASSED: &str = include_str!("../../sql/passed.sql");
pub(super) const OPEN_RUN_OF_UNIT: &str = include_str!("../../sql/open-run-of-unit.sql");
pub(super) const NEWEST_ID: &str = include_str!("../../sql/newest-id.sql");
pub(super) const ADD_TO_OUTBOX: &str = include_str!("../../sql/add-to-outbox.sql");
pub(super) const ALL_TO_OUTBOX: &str = include_str!("../../sql/all-to-outbox.sql");
pub(super) const OUTBOX_DUE: &str = include_str!("../../sql/outbox-due.sql");
pub(super) const OUTBOX_STATE: &str = include_str!("../../sql/outbox-state.sql");
pub(super) const OUTBOX_DONE: &str = include_str!("../../sql/outbox-done.sql");
pub(super) const OUTBOX_FAILED: &str = include_str!("../../sql/outbox-failed.sql");
pub(super) const OUTBOX_DEAD: &str = include_str!("../../sql/outbox-dead.sql");
pub(super) const OUTBOX_ALL_RELEASED: &str = include_str!("../../sql/outbox-all-released.sql");
pub(super) const FORGET_UNSENT: &str = include_str!("../../sql/forget-unsent.sql");
pub(super) const FORGET_SINK: &str = include_str!("../../sql/forget-sink.sql");
pub(super) const OUTBOX_RELEASED: &str = include_str!("../../sql/outbox-released.sql");
pub(super) const OUTBOX_ENTRY: &str = include_str!("../../sql/outbox-entry.sql");
pub(super) const WAIVER_BY_ID: &str = include_str!("../../sql/waiver-by-id.sql");
pub(super) const AUDIT_BY_ID: &str = include_str!("../../sql/audit-by-id.sql");
pub(super) const ADD_ORIGIN: &str = include_str!("../../sql/add-origin.sql");
pub(super) const ORIGIN: &str = include_str!("../../sql/origin.sql");
pub(super) const SEEN: &str = include_str!("../../sql/plant/seen.sql");
pub(super) const FORGET_STATION: &str = include_str!("../../sql/plant/forget-station.sql");
pub(crate) const STATIONS: &str = include_str!("../../sql/plant/stations.sql");
pub(super) const LOCK_UNIT: &str = include_str!("../../sql/plant/lock-unit.sql");
pub(super) const ADD_RECORD: &str = include_str!("../../sql/plant/add-record.sql");
pub(super) const RECORD: &str = include_str!("../../sql/plant/record.sql");
pub(super) const ADD_RUN: &str = include_str!("../../sql/plant/add-run.sql");
pub(super) const HASH_OF: &str = include_str!("../../sql/plant/hash-of.sql");
pub(super) const IS_LATE: &str = include_str!("../../sql/plant/is-late.sql");
pub(super) const UNCOUNT_FIRST: &str = include_str!("../../sql/plant/uncount-first.sql");
pub(super) const COUNT_ON: &str = include_str!("../../sql/plant/count-on.sql");
pub(super) const FORGET_RETEST: &str = include_str!("../../sql/plant/forget-retest.sql");
pub(super) const LAST_JUDGED: &str = include_str!("../../sql/plant/last-judged.sql");
pub(super) const ADD_BINDING_UNLESS: &str = include_str!("../../sql/plant/add-binding.sql");
pub(super) const ADD_WAIVER_UNLESS: &str = include_str!("../../sql/plant/add-waiver.sql");
pub(super) const ADD_AUDIT_UNLESS: &str = include_str!("../../sql/plant/add-audit.sql");
pub(super) const ADD_BOARD: &str = include_str!("../../sql/plant/add-board.sql");
pub(super) const BOARD_OUT: &str = include_str!("../../sql/plant/board-out.sql");
pub(super) const FORGET_BOARD: &str = include_str!("../../sql/plant/forget-board.sql");
pub(super) const BOARDS: &str = include_str!("../../sql/plant/boards.sql");
pub(super) const WAITERS: &str = include_str!("../../sql/plant/waiters.sql");
pub(super) const WAIT: &str = include_str!("../../sql/plant/wait.sql");
pub(super) const PLACE: &str = include_str!("../../sql/plant/place.sql");
pub(super) const REACHABLE: &str = include_str!("../../sql/plant/reachable.sql");
pub(super) const FORGET_WAITERS: &str = include_str!("../../sql/plant/forget-waiters.sql");
pub(super) const FREE_BOARD: &str = include_str!("../../sql/plant/free-board.sql");
pub(super) const HOLD_BOARD: &str = include_str!("../../sql/plant/hold-board.sql");
pub(super) const RENEW_BOARD: &str = include_str!("../../sql/plant/renew-board.sql");
pub(super) const RETURN_BOARD: &str = include_str!("../../sql/plant/return-board.sql");
pub(super) const ADD_JOB: &str = include_str!("../../sql/plant/add-job.sql");
pub(super) const CLAIMABLE_JOB: &str = include_str!("../../sql/plant/claimable-job.sql");
pub(super) const BOARD_OF_JOB: &str = include_str!("../../sql/plant/board-of-job.sql");
pub(super) const CLAIM_JOB: &str = include_str!("../../sql/plant/claim-job.sql");
pub(super) const RENEW_JOB: &str = include_str!("../../sql/plant/renew-job.sql");
pub(super) const RETURN_JOB: &str = include_str!("../../sql/plant/return-job.sql");
pub(super) const EXHAUSTED_JOBS: &str = include_str!("../../sql/plant/exhausted-jobs.sql");
pub(super) const JOB_DONE: &str = include_str!("../../sql/plant/job-done.sql");
pub(super) const JOB_BACK: &str = include_str!("../../sql/plant/job-back.sql");
pub(super) const RUN_OF_JOB: &str = include_str!("../../sql/plant/run-of-job.sql");
pub(super) const CANCEL_JOB: &str = include_str!("../../sql/plant/cancel-job.sql");
pub(super) const RETRY_JOB: &str = include_str!("../../sql/plant/retry-job.sql");
pub(super) const JOBS: &str = include_str!("../../sql/plant/jobs.sql");
pub(super) const ADD_BUNDLE: &str = include_str!("../../sql/plant/add-bundle.sql");
pub(super) const BUNDLE: &str = include_str!("../../sql/plant/bundle.sql");
pub(super) const PUBLISH: &str = include_str!("../../sql/plant/publish.sql");
pub(super) const PUBLICATION: &str = include_str!("../../sql/plant/publication.sql");
pub(super) const HASH_OF_VERSION: &str = include_str!("../../sql/plant/hash-of-version.sql");
pub(super) const PUBLICATIONS: &str = include_str!("../../sql/plant/publications.sql");
pub(super) const ADD_MISMATCH: &str = include_str!("../../sql/plant/add-mismatch.sql");
pub(crate) const MISMATCHES: &str = include_str!("../../sql/mismatches.sql");
pub(super) const KEPT_RUNS: &str = include_str!("../../sql/plant/kept-runs.sql");
pub(super) const UNNAMED_RECORDS: &str = include_str!("../../sql/plant/unnamed-records.sql");
pub(super) const JOBS_WITHOUT_RUNS: &str = include_str!("../../sql/plant/jobs-without-runs.sql");
pub(super) const PLANS_OF_JOBS: &str = include_str!("../../sql/plant/plans-of-jobs.sql");
pub(super) const OTHER_MISMATCHES: &str = include_str!("../../sql/plant/other-mismatches.sql");
pub(super) const NEXT_RUNS: &str = include_str!("../../sql/plant/next-runs.sql");
pub(super) const PRUNE_STEPS: &str = include_str!("../../sql/plant/prune-steps.sql");
pub(super) const PRUNE_MEASUREMENTS: &str = include_str!("../../sql/plant/prune-measurements.sql");
pub(super) const PRUNED_ROWS: &str = include_str!("../../sql/plant/pruned-rows.sql");

#[cfg(test)]
mod tests {
    use super::super::database::Engine;
    use super::*;

    const ALL: [&str; 126] = [
        ADD_PLAN,
        ADD_UNIT,
        UNIT_OF,
        OPEN_RUN,
        FINISH_RUN,
        ADD_STEP,
        ADD_MEASUREMENT,
        ADD_SUSPECT,
        ADD_ATTACHMENT,
        ADD_DAY_COUNT,
        ADD_RETEST,
        ADD_FAILURES,
        VERDICT_OF,
        OPEN_RUNS,
        FINAL_RUNS,
        ADD_WAIVER,
        ADD_AUDIT,
        WAIVER_OF,
        ATTACHMENTS,
        PRUNED,
        OLD_EVIDENCE,
        NAMED_EVIDENCE,
        RUNS,
        PLANS,
        UNITS_OF_SERIAL,
        UNIT_RUNS,
        UNIT_STEPS,
        UNIT_SUSPECTS,
        UNIT_ATTACHMENTS,
        UNIT_BINDINGS,
        UNIT_WAIVERS,
        YIELD_DAYS,
        YIELD_HOURS,
        DAY_RUNS,
        COUNTS,
        FAILED_RUNS,
        RETESTS,
        SERIAL_OF,
        WAIVED,
        FAILURES,
        ADD_BINDING,
        END_BINDINGS,
        UNIT_OF_DEVICE,
        DEVICE_OF_UNIT,
        AUDIT_OF_ACT,
        OPEN_RUN_OF_UNIT,
        PASSED,
        LAST_JUDGEMENT,
        NEWEST_ID,
        ADD_TO_OUTBOX,
        ALL_TO_OUTBOX,
        OUTBOX_DUE,
        OUTBOX_STATE,
        OUTBOX_DONE,
        OUTBOX_FAILED,
        OUTBOX_DEAD,
        OUTBOX_ALL_RELEASED,
        FORGET_UNSENT,
        FORGET_SINK,
        OUTBOX_RELEASED,
        OUTBOX_ENTRY,
        WAIVER_BY_ID,
        AUDIT_BY_ID,
        ADD_ORIGIN,
        ORIGIN,
        SEEN,
        FORGET_STATION,
        STATIONS,
        LOCK_UNIT,
        ADD_RECORD,
        RECORD,
        ADD_RUN,
        HASH_OF,
        IS_LATE,
        UNCOUNT_FIRST,
        PLAN_EARLIER,
        UNIT_EARLIER,
        COUNT_ON,
        FORGET_RETEST,
        LAST_JUDGED,
        ADD_BINDING_UNLESS,
        ADD_WAIVER_UNLESS,
        ADD_AUDIT_UNLESS,
        ADD_BOARD,
        BOARD_OUT,
        FORGET_BOARD,
        BOARDS,
        WAITERS,
        WAIT,
        PLACE,
        REACHABLE,
        FORGET_WAITERS,
        FREE_BOARD,
        HOLD_BOARD,
        RENEW_BOARD,
        RETURN_BOARD,
        ADD_JOB,
        CLAIMABLE_JOB,
        BOARD_OF_JOB,
        CLAIM_JOB,
        RENEW_JOB,
        RETURN_JOB,
        EXHAUSTED_JOBS,
        JOB_DONE,
        JOB_BACK,
        RUN_OF_JOB,
        CANCEL_JOB,
        RETRY_JOB,
        JOBS,
        ADD_BUNDLE,
        BUNDLE,
        PUBLISH,
        PUBLICATION,
        HASH_OF_VERSION,
        PUBLICATIONS,
        ADD_MISMATCH,
        MISMATCHES,
        KEPT_RUNS,
        UNNAMED_RECORDS,
        JOBS_WITHOUT_RUNS,
        PLANS_OF_JOBS,
        OTHER_MISMATCHES,
        NEXT_RUNS,
        PRUNE_STEPS,
        PRUNE_MEASUREMENTS,
        PRUNED_ROWS,
    ];

    /// SQLite numbers `$1` by where it first stands, PostgreSQL by its digits.
    #[test]
    fn parameters_are_numbered_in_the_order_of_their_first_use() {
        for text in ALL {
            let mut most = 0;
            for piece in text.split('$').skip(1) {
                let digits: String = piece.chars().take_while(char::is_ascii_digit).collect();
                let number: u32 = digits.parse().unwrap();
                assert!(number <= most + 1, "${number} stands before ${} in\n{text}", most + 1);
                most = most.max(number);
            }
        }
    }

    #[test]
    fn nothing_is_left_of_what_the_engines_call_differently() {
        for text in SCHEMAS.into_iter().chain(ALL).chain([SCHEMA_VERSION]) {
            for engine in [Engine::Sqlite, Engine::Postgres] {
                let text = ["{filters}", "{limit}", "{of}"]
                    .iter()
                    .fold(engine.words(text), |text, name| text.replace(name, "1"));
                assert!(!text.contains(['{', '}']), "{text}");
            }
        }
    }
}
