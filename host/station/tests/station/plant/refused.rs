//! What a plant refuses, and what is refused as a plant.

use std::path::Path;

use halfrow_station::outbox::{Sink as _, Undelivered};
use halfrow_station::store::{Plant, PlantError, StoreError};

use super::cut::due;
use super::sent::{send, sink};
use super::server::Server;
use super::tables::is_as;
use crate::common::{Did, LANE, NO_AUDIT, change, did_in, plant_settings, query, settings};
use crate::history::made::{End, Made, Run};
use crate::history::released::history;

/// Runs a command of the station in this folder, with settings that name the plant.
pub(super) fn did(folder: &Path, server: &Server, arguments: &[&str]) -> Did {
    settings(folder, "12", ".", &(plant_settings(&server.url()) + LANE));
    did_in(folder, arguments)
}

#[test]
fn a_run_that_the_plant_has_with_another_record_is_an_alarm_and_waits_for_a_person() {
    let server = Server::prepared();
    let (made, _) = send(history(), server.address());
    // A record was changed at the plant, and the station does not know that it had sent it.
    let changed = "UPDATE run SET record_sha256 = repeat('0', 64) WHERE id = (SELECT min(id) FROM run)";
    server.change(changed);
    let run = query(made.as_ref(), "SELECT min(id) FROM run").remove(0);
    made.change("UPDATE outbox SET done_ms = NULL");
    let (made, all) = send(made, server.address());
    // All the others are sent.
    assert_eq!((all.sent, all.failed, all.is_away), (9, 1, false));
    let unsent = made.now().unsent().unwrap();
    let [dead] = &made.now().dead(&unsent).unwrap()[..] else { panic!("nothing waits") };
    assert_eq!(dead.entry.subject, run);
    assert!(dead.said.to_string().contains("nothing was changed: keep both"), "{dead:?}");
    let at_plant = format!("SELECT record_sha256 FROM run WHERE id = '{run}'");
    assert_eq!(server.rows(&at_plant), [["0".repeat(64)]]);
    // It is not tried again by itself.
    let (made, none) = send(made, server.address());
    assert_eq!(none.sent + none.failed, 0);
    // A person looks into it, corrects the plant, and releases the entry.
    let ours = query(made.as_ref(), &format!("SELECT record_sha256 FROM run WHERE id = '{run}'")).remove(0);
    let right = format!("UPDATE run SET record_sha256 = '{ours}' WHERE id = '{run}'");
    server.change(&right);
    let release =
        ["outbox", "release", run.as_str(), "--reason", "it was changed by hand", "--operator", "engel"];
    let busy = did(made.as_ref(), &server, &release);
    assert_eq!(busy.code, Some(4), "{busy:?}");
    let (folder, store) = made.parts();
    drop(store);
    // What cannot be entered in the audit is not released.
    change(folder.path(), NO_AUDIT);
    let unnoted = did(folder.path(), &server, &release);
    assert_eq!(unnoted.code, Some(3), "{unnoted:?}");
    change(folder.path(), "DROP TRIGGER full");
    let released = did(folder.path(), &server, &release);
    assert_eq!((released.code, released.complained.as_str()), (Some(0), ""), "{released:?}");
    let again = did(folder.path(), &server, &release);
    assert_eq!(again.code, Some(2), "{again:?}");
    let sent = did(folder.path(), &server, &["outbox", "send", "--any-disk"]);
    // The run, its release, and the commands that were called: both, and the one that came to nothing.
    assert!(sent.said.starts_with("4 sent, 0 not"), "{sent:?}");
    let made = Made::at(folder);
    is_as(&server, &made);
    let told = query(made.as_ref(), "SELECT operator_id || ': ' || detail FROM audit WHERE act = 'release'");
    assert_eq!(told, ["engel: it was changed by hand"]);
}

/// What comes behind the entries of these subjects, which are not due yet, waits and is told of in these words; returns how many they
/// are.
fn waits_for_what_comes_first(subjects: &str, said: &str) -> usize {
    let server = Server::prepared();
    let mut made = history();
    made.store.sends_to(vec!["plant".to_owned()]).unwrap();
    let later =
        format!("UPDATE outbox SET next_ms = (unixepoch() + 240) * 1000 WHERE subject IN ({subjects})");
    let first = made.change(&later);
    let (made, _) = send(made, server.address());
    let [unsent] = &made.now().unsent().unwrap()[..] else { panic!("all was sent") };
    assert_eq!((unsent.entries as usize, unsent.dead), (first + 1, 0), "{unsent:?}");
    assert!(unsent.said.as_ref().unwrap().to_string().contains(said), "{unsent:?}");
    due(&made);
    let (made, rest) = send(made, server.address());
    assert_eq!((rest.sent, rest.failed), (first + 1, 0));
    is_as(&server, &made);
    first
}

#[test]
fn a_waiver_waits_for_its_run() {
    assert_eq!(waits_for_what_comes_first("SELECT run_id FROM waiver", "which comes first"), 1);
}

#[test]
fn a_rebinding_waits_for_the_runs_of_its_unit() {
    let runs = "SELECT run.id FROM run JOIN audit ON audit.subject = run.unit_id WHERE act = 'rebind'";
    assert!(waits_for_what_comes_first(runs, "the run of CAM-T S2 yet") > 0);
}

#[test]
fn tables_that_are_not_there_or_of_another_version_are_no_plant() {
    let server = Server::start();
    let refused = |server: &Server| Plant::connect(&server.address()).unwrap_err();
    let none = refused(&server);
    assert!(matches!(none, StoreError::Older { found: 0, .. }), "{none:?}");
    let (folder, store) = history().parts();
    drop(store);
    let prepared = did(folder.path(), &server, &["plant", "prepare"]);
    assert_eq!(prepared.said, format!("the plant {} has version 8\n", server.url()));
    let (_, all) = send(Made::at(folder), server.address());
    assert_eq!((all.sent, all.failed), (10, 0));
    server.change("INSERT INTO schema_version VALUES (99, 'x', 1)");
    let newer = refused(&server);
    assert!(matches!(newer, StoreError::Newer { found: 99, .. }), "{newer:?}");
    let newer = Plant::prepare(&server.address()).unwrap_err();
    assert!(matches!(newer, PlantError::Store(StoreError::Newer { found: 99, .. })), "{newer:?}");
}

/// The tables of a program with schema 2, and a unit in them.
fn older(server: &Server) {
    let words = |text: &str| {
        text.replace("{int}", "BIGINT").replace("{real}", "DOUBLE PRECISION").replace("{strict}", "")
    };
    let mut client = server.client("plant");
    let schemas = [include_str!("../../../sql/schema-1.sql"), include_str!("../../../sql/schema-2.sql")];
    client.batch_execute(&words(include_str!("../../../sql/schema-version.sql"))).unwrap();
    for (schema, number) in schemas.iter().zip(1..) {
        client.batch_execute(&words(schema)).unwrap();
        let hash = halfrow::result::sha256([schema]);
        client.execute("INSERT INTO schema_version VALUES ($1, $2, 0)", &[&(number as i64), &hash]).unwrap();
    }
    client.batch_execute("INSERT INTO unit VALUES (repeat('u', 36), 'CAM-T', 'S1', 7)").unwrap();
}

/// A plant of an earlier program is copied before it is brought up to date, both in one transaction.
#[test]
fn an_older_plant_is_copied_and_brought_up_to_date() {
    let server = Server::start();
    older(&server);
    let refused = Plant::connect(&server.address()).unwrap_err();
    assert!(matches!(refused, StoreError::Older { found: 2, known: 8, .. }), "{refused:?}");
    assert_eq!(Plant::prepare(&server.address()).unwrap(), 8);
    assert_eq!(server.rows("SELECT serial FROM before_3.unit"), [["S1"]]);
    assert_eq!(server.rows("SELECT serial FROM unit"), [["S1"]]);
    assert_eq!(server.rows("SELECT max(n) FROM schema_version"), [["8"]]);
    Plant::connect(&server.address()).unwrap();
}

/// Who went back to the tables from before an upgrade brings them up to date again, and loses neither copy.
#[test]
fn a_plant_that_went_back_is_brought_up_to_date_beside_the_copy_of_the_first_time() {
    let server = Server::start();
    older(&server);
    assert_eq!(Plant::prepare(&server.address()).unwrap(), 8);
    for copy in ["before_3_2", "before_3_3"] {
        server.change("DROP SCHEMA public CASCADE; CREATE SCHEMA public");
        older(&server);
        let changed = format!("UPDATE unit SET serial = '{copy}'");
        server.change(&changed);
        assert_eq!(Plant::prepare(&server.address()).unwrap(), 8);
        assert_eq!(server.rows(&format!("SELECT serial FROM {copy}.unit")), [[copy]]);
    }
    assert_eq!(server.rows("SELECT serial FROM before_3.unit"), [["S1"]]);
    assert_eq!(server.rows("SELECT serial FROM before_3_2.unit"), [["before_3_2"]]);
}

/// What an earlier program has read in a transaction holds until that is over.
#[test]
fn a_plant_is_brought_up_to_date_after_what_an_earlier_program_has_under_way() {
    let server = Server::start();
    older(&server);
    let mut busy = server.client("plant");
    busy.batch_execute("BEGIN; SELECT max(n) FROM schema_version").unwrap();
    server.change("ALTER DATABASE plant SET lock_timeout = 100");
    let waits = Plant::prepare(&server.address()).unwrap_err();
    let PlantError::Store(StoreError::Plant { source, .. }) = &waits else { panic!("{waits:?}") };
    assert!(format!("{source:?}").contains("lock timeout"), "{source:?}");
    assert_eq!(server.rows("SELECT max(n) FROM schema_version"), [["2"]]);
    busy.batch_execute("COMMIT; ALTER DATABASE plant RESET lock_timeout").unwrap();
    assert_eq!(Plant::prepare(&server.address()).unwrap(), 8);
}

/// Also over a connection that it already had: what it does not know would be missing for ever.
#[test]
fn a_program_that_is_older_than_the_tables_writes_nothing_into_them() {
    let server = Server::prepared();
    let mut made = history();
    made.store.sends_to(vec!["plant".to_owned()]).unwrap();
    let due = made.folder().due("plant", 1, i64::MAX).unwrap();
    let parcels: Vec<_> = due.iter().map(|entry| made.folder().parcel(entry).unwrap()).collect();
    assert_eq!(parcels.len(), 10);
    let mut sink = sink("station 7", &mut made.store, server.address());
    let mut client = server.client("plant");
    for parcel in &parcels {
        sink.take(&parcels[0]).unwrap();
        client.batch_execute("INSERT INTO schema_version VALUES (99, 'x', 1)").unwrap();
        let taken = sink.take(parcel);
        let Err(Undelivered::Away(said)) = taken else { panic!("{taken:?}") };
        assert!(said.to_string().contains("has version 99"), "{said}");
        client.batch_execute("DELETE FROM schema_version WHERE n = 99").unwrap();
    }
    let had =
        "SELECT (SELECT count(*) FROM run), (SELECT count(*) FROM waiver), (SELECT count(*) FROM audit)";
    assert_eq!(server.rows(had), [["1", "0", "0"]]);
    parcels.iter().for_each(|parcel| sink.take(parcel).unwrap());
    is_as(&server, &made);
}

#[test]
fn a_database_that_sorts_otherwise_than_a_station_is_refused() {
    let server = Server::start();
    let other = "CREATE DATABASE other TEMPLATE template0 ENCODING 'SQL_ASCII' LOCALE 'C'";
    server.client("postgres").batch_execute(other).unwrap();
    let url = server.url().replace("/plant", "/other");
    let address = halfrow_station::store::PlantAddress::new(&url, None, None).unwrap();
    let refused = Plant::prepare(&address).unwrap_err();
    assert!(
        matches!(&refused, PlantError::Collation { encoding, .. } if encoding == "SQL_ASCII"),
        "{refused:?}"
    );
    assert!(refused.to_string().contains("createdb --template template0 --encoding UTF8"), "{refused}");
}

/// A station whose folder was lost and made anew counts as another one, until a person says that it is the same.
#[test]
fn a_station_with_another_folder_is_taken_for_itself_when_a_person_says_so() {
    let server = Server::prepared();
    let (_, all) = send(history(), server.address());
    assert_eq!(all.sent, 10);
    let (made, refused) = send(Made::new(), server.address());
    assert_eq!((refused.sent, refused.failed), (0, 0), "there is nothing to send");
    let mut made = made;
    made.run(&Run::of("S9", End::Pass).at_hour(40));
    let (made, refused) = send(made, server.address());
    assert_eq!((refused.sent, refused.is_away), (0, true));
    let [unsent] = &made.now().unsent().unwrap()[..] else { panic!("all was sent") };
    assert!(
        unsent
            .said
            .as_ref()
            .unwrap()
            .to_string()
            .contains("another station of this plant is called station 7"),
        "{unsent:?}"
    );
    let forget = ["plant", "forget", "station 7", "--reason", "its disk broke", "--operator", "engel"];
    let folder = crate::common::folder();
    let done = did(folder.path(), &server, &forget);
    assert_eq!((done.code, done.complained.as_str()), (Some(0), ""), "{done:?}");
    assert_eq!(did(folder.path(), &server, &forget).code, Some(2));
    due(&made);
    let (_, all) = send(made, server.address());
    assert_eq!((all.sent, all.failed), (1, 0));
    let told = server.rows("SELECT operator_id, subject, detail FROM audit WHERE act = 'forget station'");
    assert_eq!(told, [["engel", "station 7", "its disk broke"]]);
}
