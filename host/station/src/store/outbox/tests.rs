use super::super::database::Value;
use super::super::{Deed, Snapshot};
use super::*;

/// How the database answers `text`.
fn plan(folder: &Folder, text: &str, of: &[Value<'_>]) -> Vec<String> {
    let plan = folder.read("a plan", |from| {
        from.all(&format!("EXPLAIN QUERY PLAN {text}"), of, |row| row.get::<String>(3))
    });
    plan.unwrap()
}

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
    let due = plan(&folder, sql::OUTBOX_DUE, values!["mes", 0_i64, 0_i64]);
    assert_eq!(due, ["SEARCH outbox USING INDEX outbox_due (sink=?)"]);
    assert_eq!(plan(&folder, sql::OUTBOX_NEXT, values!["mes"]), due);
}

/// Before every run, on the engine's only thread; another sink may have been away for a year.
#[test]
fn what_one_sink_does_not_have_is_counted_without_a_look_at_the_others() {
    let folder = tempfile::tempdir().unwrap();
    let mut store = Store::open(&Folder::new(folder.path())).unwrap();
    store.sends_to(["mes", "share"].map(str::to_owned).to_vec()).unwrap();
    for number in ["1", "2", "3"] {
        store.note(Deed { operator: "weber", act: "scan", subject: "1", detail: number }).unwrap();
    }
    let said = || Said::uncoded("no".to_owned());
    let mut of_mes = store.folder().due("mes", clock::now_ms(), i64::MAX).unwrap();
    let next_ms = clock::now_ms() + 1_000;
    let tried = [
        (of_mes.remove(0), Tried::Dead { said: said() }),
        (of_mes.remove(0), Tried::Again { next_ms, said: said() }),
    ];
    store.tried("mes", &tried, clock::now_ms()).unwrap();
    let now = Snapshot::take(&Folder::new(folder.path())).unwrap();
    let of = |entries, dead, was_tried| Backlog { entries, results: 0, dead, was_tried };
    assert_eq!(now.backlog("mes").unwrap(), of(3, 1, true));
    assert_eq!(now.backlog("share").unwrap(), of(3, 0, false));
    assert_eq!(now.backlog("nobody").unwrap(), Backlog::default());
    let asked = plan(store.folder(), sql::OUTBOX_LEFT, values!["mes"]);
    assert_eq!(asked, ["SEARCH outbox USING INDEX outbox_open (sink=?)"]);
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
