//! The text of every statement. It is the same for SQLite and PostgreSQL, except for [words](super::database::Engine::words).

/// The schemas, in order: numbered files that are never edited. The column `retest_of` of a run is not used: `nth` and the table
/// `retest` say what was judged again.
pub(super) const SCHEMAS: [&str; 8] = [
    include_str!("../../sql/schema-1.sql"),
    include_str!("../../sql/schema-2.sql"),
    include_str!("../../sql/schema-3.sql"),
    include_str!("../../sql/schema-4.sql"),
    include_str!("../../sql/schema-5.sql"),
    include_str!("../../sql/schema-6.sql"),
    include_str!("../../sql/schema-7.sql"),
    include_str!("../../sql/schema-8.sql"),
];

/// Words of a plant's statements about jobs and boards. Earlier ones use later ones.
pub(super) const OF_PLANT: [(&str, &str); 15] = [
    // How it stands with a job. The end of its lease is not written down before its next claim.
    (
        "{job_state}",
        "CASE WHEN {is_cancelled} THEN 'cancelled' WHEN {is_exhausted} THEN 'dead' WHEN {is_lapsed} THEN 'waiting' ELSE job.state END",
    ),
    // Why it was given up then.
    ("{exhausted}", "'it was claimed five times, and no run of it was judged'"),
    // Whether it was claimed for the last time, and never came back.
    ("{is_exhausted}", "({is_lapsed} AND {is_spent})"),
    // Whether a person gave it up; all others that are dead were claimed.
    ("{is_cancelled}", "(job.state = 'dead' AND job.attempts = 0)"),
    // Whether whoever claimed it last has lost it.
    ("{is_lapsed}", "(job.state = 'claimed' AND job.until_ms < {now_ms})"),
    // Whether it may not be claimed again.
    ("{is_spent}", "(job.attempts >= 5)"),
    // Whether a board is free.
    ("{free}", "(board.holder IS NULL OR board.until_ms < {now_ms})"),
    // Whether the last run of its unit was no ERROR of the last ten minutes.
    ("{is_well}", "coalesce({erred_ms} < {now_ms} - 600000, TRUE)"),
    // When that run ended, if it was an ERROR that nobody asked for.
    (
        "{erred_ms}",
        "(SELECT CASE WHEN run.verdict = 'ERROR' AND run.cause <> 'operator' THEN run.ended_ms END
           FROM run
           WHERE run.unit_id = (SELECT id FROM unit WHERE unit.product = board.product AND unit.serial = board.serial)
             AND run.nth > 0
           ORDER BY run.started_ms DESC, run.id DESC LIMIT 1)",
    ),
    // The pairing (`Claim::pairing`) of a job's plan with it.
    ("{pairing}", "concat_ws(' ', job.plan_sha256, board.target, board.serial)"),
    // The pair (`Worker::references`) of a job's plan with its unit.
    ("{reference}", "concat_ws(' ', job.plan_sha256, board.serial)"),
    // The last judgement of its unit by that plan.
    (
        "{last_verdict}",
        "(SELECT run.verdict FROM run JOIN unit ON unit.id = run.unit_id
           WHERE unit.product = board.product AND unit.serial = board.serial AND run.plan_sha256 = job.plan_sha256
             AND run.nth > 0 AND run.verdict IN ('PASS', 'FAIL')
           ORDER BY run.id DESC LIMIT 1)",
    ),
    // Whether somebody waits for it who reaches it.
    (
        "{waited_for}",
        "EXISTS (SELECT 1 FROM waiter WHERE waiter.kind = board.kind AND waiter.until_ms >= {now_ms}
           AND board.station IN ('', {waiter_station}))",
    ),
    // A waiter's station.
    ("{waiter_station}", "substring(waiter.holder FROM '^(.*) ')"),
    // The time by the plant's clock, in milliseconds since 1970, UTC.
    ("{now_ms}", "CAST(extract(epoch FROM clock_timestamp()) * 1000 AS BIGINT)"),
];

/// A constant for each statement, and a list of all for the tests.
macro_rules! statements {
    ($($sight:vis $name:ident = $file:literal;)*) => {
        $($sight const $name: &str = include_str!(concat!("../../sql/", $file));)*

        #[cfg(test)]
        const ALL: &[&str] = &[$($name),*];
    };
}

statements! {
    pub(super) SCHEMA_VERSION = "schema-version.sql";
    pub(super) ADD_PLAN = "add-plan.sql";
    pub(super) ADD_UNIT = "add-unit.sql";
    pub(super) UNIT_OF = "unit-of.sql";
    pub(super) PLAN_OF_VERSION = "plan-of-version.sql";
    pub(super) PLAN_TEXTS = "plan-texts.sql";
    pub(super) UNCOUNT_UNIT = "uncount-unit.sql";
    pub(super) PLAN_EARLIER = "plan-earlier.sql";
    pub(super) UNIT_EARLIER = "unit-earlier.sql";
    pub(super) OPEN_RUN = "open-run.sql";
    pub(super) FINISH_RUN = "finish-run.sql";
    pub(super) ADD_STEP = "add-step.sql";
    pub(super) ADD_MEASUREMENT = "add-measurement.sql";
    pub(super) ADD_SUSPECT = "add-suspect.sql";
    pub(super) ADD_ATTACHMENT = "add-attachment.sql";
    pub(super) ADD_DAY_COUNT = "add-day-count.sql";
    pub(super) ADD_RETEST = "add-retest.sql";
    pub(super) ADD_FAILURES = "add-failures.sql";
    pub(super) VERDICT_OF = "verdict-of.sql";
    pub(super) OPEN_RUNS = "open-runs.sql";
    pub(super) FINAL_RUNS = "final-runs.sql";
    pub(super) ADD_WAIVER = "add-waiver.sql";
    pub(super) ADD_AUDIT = "add-audit.sql";
    pub(super) WAIVER_OF = "waiver-of.sql";
    pub(super) PRUNED = "pruned.sql";
    pub(super) PRUNED_OF_RUN = "pruned-of-run.sql";
    pub(super) OLD_EVIDENCE = "old-evidence.sql";
    pub(super) NAMED_EVIDENCE = "named-evidence.sql";
    pub(super) ATTACHMENTS = "attachments.sql";
    pub(crate) RUNS = "runs.sql";
    pub(crate) PLANS = "plans.sql";
    pub(crate) UNITS_OF_SERIAL = "units-of-serial.sql";
    pub(crate) UNIT_RUNS = "unit-runs.sql";
    pub(crate) UNIT_STEPS = "unit-steps.sql";
    pub(crate) UNIT_SUSPECTS = "unit-suspects.sql";
    pub(crate) UNIT_ATTACHMENTS = "unit-attachments.sql";
    pub(crate) UNIT_BINDINGS = "unit-bindings.sql";
    pub(crate) UNIT_WAIVERS = "unit-waivers.sql";
    pub(crate) YIELD_DAYS = "yield-days.sql";
    pub(crate) YIELD_HOURS = "yield-hours.sql";
    pub(crate) DAY_RUNS = "day-runs.sql";
    pub(crate) COUNTS = "counts.sql";
    pub(crate) FAILED_RUNS = "failed-runs.sql";
    pub(crate) RETESTS = "retests.sql";
    pub(crate) WAIVED = "waived.sql";
    pub(crate) FAILURES = "failures.sql";
    pub(super) ADD_BINDING = "add-binding.sql";
    pub(super) END_BINDINGS = "end-bindings.sql";
    pub(super) UNIT_OF_DEVICE = "unit-of-device.sql";
    pub(super) DEVICE_OF_UNIT = "device-of-unit.sql";
    pub(super) UNBOUND_SINCE = "unbound-since.sql";
    pub(super) AUDIT_OF_ACT = "audit-of-act.sql";
    pub(super) WAIVERS_UNLIKE_AUDIT = "waivers-unlike-audit.sql";
    pub(super) LAST_JUDGEMENT = "last-judgement.sql";
    pub(super) PASSED = "passed.sql";
    pub(super) OPEN_RUN_OF_UNIT = "open-run-of-unit.sql";
    pub(super) NEWEST_ID = "newest-id.sql";
    pub(super) NEWEST_RUN = "newest-run.sql";
    pub(super) ADD_TO_OUTBOX = "add-to-outbox.sql";
    pub(super) UNENTERED = "unentered.sql";
    pub(super) ALL_TO_OUTBOX = "all-to-outbox.sql";
    pub(super) OUTBOX_DUE = "outbox-due.sql";
    pub(super) OUTBOX_NEXT = "outbox-next.sql";
    pub(super) OUTBOX_LEFT = "outbox-left.sql";
    pub(super) OUTBOX_AT_ONCE = "outbox-at-once.sql";
    pub(super) OUTBOX_STATE = "outbox-state.sql";
    pub(super) OUTBOX_SINCE = "outbox-since.sql";
    pub(super) OUTBOX_DONE = "outbox-done.sql";
    pub(super) OUTBOX_FAILED = "outbox-failed.sql";
    pub(super) OUTBOX_DEAD = "outbox-dead.sql";
    pub(super) OUTBOX_ALL_RELEASED = "outbox-all-released.sql";
    pub(super) FORGET_UNSENT = "forget-unsent.sql";
    pub(super) FORGET_SINK = "forget-sink.sql";
    pub(super) OUTBOX_AGAIN = "outbox-again.sql";
    pub(super) OUTBOX_LOST = "outbox-lost.sql";
    pub(super) OUTBOX_RELEASED = "outbox-released.sql";
    pub(super) OUTBOX_NEWEST_SENT = "outbox-newest-sent.sql";
    pub(super) OUTBOX_ENTRY = "outbox-entry.sql";
    pub(super) WAIVER_BY_ID = "waiver-by-id.sql";
    pub(super) AUDIT_BY_ID = "audit-by-id.sql";
    pub(super) ADD_ORIGIN = "add-origin.sql";
    pub(super) ORIGIN = "origin.sql";
    pub(super) NOW = "plant/now.sql";
    pub(super) SEEN = "plant/seen.sql";
    pub(super) FORGET_STATION = "plant/forget-station.sql";
    pub(crate) STATIONS = "plant/stations.sql";
    pub(crate) PLANS_OF_ONE_VERSION = "plant/plans-of-one-version.sql";
    pub(super) LOCK_UNIT = "plant/lock-unit.sql";
    pub(super) ADD_RECORD = "plant/add-record.sql";
    pub(super) RECORD = "plant/record.sql";
    pub(super) ADD_RUN = "plant/add-run.sql";
    pub(super) HASH_OF = "plant/hash-of.sql";
    pub(super) IS_LATE = "plant/is-late.sql";
    pub(super) UNCOUNT_FIRST = "plant/uncount-first.sql";
    pub(super) COUNT_ON = "plant/count-on.sql";
    pub(super) FORGET_RETEST = "plant/forget-retest.sql";
    pub(super) LAST_JUDGED = "plant/last-judged.sql";
    pub(super) ADD_BINDING_UNLESS = "plant/add-binding.sql";
    pub(super) ADD_REBINDING = "plant/add-rebinding.sql";
    pub(super) END_BINDINGS_THEN = "plant/end-bindings.sql";
    pub(super) ADD_WAIVER_UNLESS = "plant/add-waiver.sql";
    pub(super) ADD_AUDIT_UNLESS = "plant/add-audit.sql";
    pub(super) ADD_BOARD = "plant/add-board.sql";
    pub(super) OTHER_OF_UNIT = "plant/other-of-unit.sql";
    pub(super) BOARD_OUT = "plant/board-out.sql";
    pub(super) FORGET_BOARD = "plant/forget-board.sql";
    pub(super) BOARDS = "plant/boards.sql";
    pub(super) SHORTEN = "plant/shorten.sql";
    pub(super) WAITERS = "plant/waiters.sql";
    pub(super) WAIT = "plant/wait.sql";
    pub(super) QUEUE = "plant/queue.sql";
    pub(super) REACHABLE = "plant/reachable.sql";
    pub(super) FORGET_WAITERS = "plant/forget-waiters.sql";
    pub(super) FREE_BOARD = "plant/free-board.sql";
    pub(super) HOLD_BOARD = "plant/hold-board.sql";
    pub(super) RENEW_BOARD = "plant/renew-board.sql";
    pub(super) RETURN_BOARD = "plant/return-board.sql";
    pub(super) ADD_JOB = "plant/add-job.sql";
    pub(super) CLAIMABLE_JOB = "plant/claimable-job.sql";
    pub(super) BOARD_OF_JOB = "plant/board-of-job.sql";
    pub(super) CLAIM_JOB = "plant/claim-job.sql";
    pub(super) RENEW_JOB = "plant/renew-job.sql";
    pub(super) RETURN_JOB = "plant/return-job.sql";
    pub(super) EXHAUSTED_JOBS = "plant/exhausted-jobs.sql";
    pub(super) JOB_DONE = "plant/job-done.sql";
    pub(super) JOB_BACK = "plant/job-back.sql";
    pub(super) REFUSE_JOB = "plant/refuse-job.sql";
    pub(super) RUN_OF_JOB = "plant/run-of-job.sql";
    pub(super) NTH_OF = "plant/nth-of.sql";
    pub(super) SUPERSEDING_JOB = "plant/superseding-job.sql";
    pub(super) CANCEL_JOB = "plant/cancel-job.sql";
    pub(super) RETRY_JOB = "plant/retry-job.sql";
    pub(super) JOBS = "plant/jobs.sql";
    pub(super) OPEN_JOBS = "plant/open-jobs.sql";
    pub(super) COUNTED_JOBS = "plant/counted-jobs.sql";
    pub(super) SEEN_UNITS = "plant/seen-units.sql";
    pub(super) ADD_BUNDLE = "plant/add-bundle.sql";
    pub(super) BUNDLE = "plant/bundle.sql";
    pub(super) PUBLISH = "plant/publish.sql";
    pub(super) PUBLICATION = "plant/publication.sql";
    pub(super) PUBLISHED_VERSION = "plant/published-version.sql";
    pub(super) PUBLICATIONS = "plant/publications.sql";
    pub(super) ADD_MISMATCH = "plant/add-mismatch.sql";
    pub(crate) MISMATCHES = "mismatches.sql";
    pub(super) KEPT_RUNS = "plant/kept-runs.sql";
    pub(super) UNNAMED_RECORDS = "plant/unnamed-records.sql";
    pub(super) CONTRADICTED_WAIVERS = "plant/contradicted-waivers.sql";
    pub(super) JOBS_WITHOUT_RUNS = "plant/jobs-without-runs.sql";
    pub(super) PLANS_OF_JOBS = "plant/plans-of-jobs.sql";
    pub(super) OTHER_MISMATCHES = "plant/other-mismatches.sql";
    pub(super) NEXT_RUNS = "plant/next-runs.sql";
    pub(super) PRUNE_STEPS = "plant/prune-steps.sql";
    pub(super) PRUNE_MEASUREMENTS = "plant/prune-measurements.sql";
    pub(super) PRUNED_ROWS = "plant/pruned-rows.sql";
}

#[cfg(test)]
mod tests {
    use super::super::database::Engine;
    use super::*;

    /// SQLite numbers `$1` by its first place in the text, PostgreSQL by its digits.
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
    fn what_a_word_stands_for_is_written_nowhere_else() {
        // Wherever its lines are broken.
        let squeezed = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
        let all: Vec<_> = ALL.iter().map(|text| squeezed(text)).collect();
        for (word, meaning) in OF_PLANT {
            assert!(all.iter().any(|text| text.contains(word)), "{word}");
            assert!(!all.iter().any(|text| text.contains(&squeezed(meaning))), "{meaning}");
        }
    }

    #[test]
    fn nothing_is_left_of_what_the_engines_call_differently() {
        for text in SCHEMAS.iter().chain(ALL) {
            for engine in [Engine::Sqlite, Engine::Postgres] {
                let text = ["{filters}", "{limit}", "{of}"]
                    .iter()
                    .fold(engine.words(text), |text, name| text.replace(name, "1"));
                assert!(!text.contains(['{', '}']), "{text}");
            }
        }
    }
}
