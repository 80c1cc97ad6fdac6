use super::super::{Deed, Snapshot};
use super::*;

/// Failed attempts at times that the test chooses, with the waits of the outbox itself.
#[test]
fn what_was_said_last_is_that_of_the_last_try() {
    let folder = tempfile::tempdir().unwrap();
    let mut store = Store::open(&Folder::new(folder.path())).unwrap();
    store.sends_to(vec!["mes".to_owned()]).unwrap();
    ["1", "2", "3"].into_iter().for_each(|number| {
        store.note(Deed { operator: "weber", act: "scan", subject: "1", detail: number }).unwrap();
    });
    let now_ms = clock::now_ms();
    let entries = store.folder().due("mes", now_ms, i64::MAX).unwrap();
    let mut said = |place: usize, tries: u32, at_ms: i64, said: &str| {
        for vain in 0..tries {
            // Only the last attempt still waits.
            let next_ms = at_ms + if vain + 1 < tries { 0 } else { 875 << vain };
            let again = Tried::Again { next_ms, said: Said::uncoded(said.to_owned()) };
            store.tried("mes", &[(entries[place].clone(), again)], at_ms).unwrap();
        }
    };
    said(0, 1, now_ms, "zone unknown");
    said(1, 8, now_ms - 60_000, "yesterday's answer");
    said(2, 2, now_ms + 10_000, "asked again later");
    let [unsent] = &Snapshot::take(&Folder::new(folder.path())).unwrap().unsent().unwrap()[..] else {
        panic!("there is one sink")
    };
    assert_eq!(unsent.said, Some(Said::uncoded("asked again later".to_owned())));
}

/// Entries that a sink refused stand before those that are due, and may be all that was kept for years.
#[test]
fn what_is_due_is_found_without_a_look_at_what_waits_for_a_person() {
    let folder = tempfile::tempdir().unwrap();
    let folder = Folder::new(folder.path());
    drop(Store::open(&folder).unwrap());
    let plan = folder.read("a plan", |from| {
        let text = format!("EXPLAIN QUERY PLAN {}", sql::OUTBOX_DUE);
        from.all(&text, values!["mes", 0_i64, 0_i64], |row| row.get::<String>(3))
    });
    assert_eq!(plan.unwrap(), ["SEARCH outbox USING INDEX outbox_due (sink=?)"]);
}

/// Kept as by an earlier program, without a code.
#[test]
fn what_was_said_to_an_earlier_program_is_told_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let folder = Folder::new(folder.path());
    let mut store = Store::open(&folder).unwrap();
    store.sends_to(vec!["mes".to_owned()]).unwrap();
    store.note(Deed { operator: "weber", act: "scan", subject: "1", detail: "1" }).unwrap();
    let database = rusqlite::Connection::open(folder.database()).unwrap();
    database.execute("UPDATE outbox SET attempts = 1, said = 'zone unknown'", []).unwrap();
    let unsent = Snapshot::take(&folder).unwrap().unsent().unwrap().remove(0);
    assert_eq!(serde_json::to_value(unsent).unwrap()["said"], "zone unknown");
}
