//! What a station was still to send when a newer program came.

use halfrow_station::store::{Folder, Store};

use super::released::{left, newest};
use crate::common::{change, query};

/// The first schema with an outbox. Those in `released` are empty.
const WITH_OUTBOX: usize = 3;

#[test]
fn what_was_sent_and_what_was_not_stays_so_through_an_upgrade() {
    let outbox = "SELECT concat_ws(' ', sink, kind, subject, attempts, next_ms, done_ms, '/', dead_ms, said) FROM outbox \
                  UNION ALL SELECT id FROM origin ORDER BY 1";
    let entered = "INSERT INTO origin VALUES ('01a19467-e800-7000-8001-000000000000'); \
        INSERT INTO outbox (sink, kind, subject, attempts, next_ms, done_ms, dead_ms, said) \
        SELECT 'share', 'run', id, 2, 5, iif(verdict = 'PASS', 6, NULL), iif(verdict = 'FAIL', 7, NULL), 'no' FROM run";
    for number in WITH_OUTBOX..=newest() {
        let data = left(number);
        change(data.path(), entered);
        let before = query(data.path(), outbox);
        assert!(
            before.iter().any(|row| row.contains(" 6 /")) && before.iter().any(|row| row.contains("/ 7 "))
        );
        drop(Store::open(&Folder::new(data.path())).unwrap());
        assert_eq!(query(data.path(), outbox), before, "schema {number}");
    }
}
