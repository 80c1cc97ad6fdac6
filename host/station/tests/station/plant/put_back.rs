//! A plant that has lost data, which its stations still have.

use halfrow_station::record::JobClaim;
use halfrow_station::store::Plant;

use super::checked::faults;
use super::cut::due;
use super::refused::did;
use super::sent::{forget, send};
use super::server::Server;
use super::tables::is_as;
use super::waiting::{await_sent, station};
use crate::common::{NO_AUDIT, SERIALS, change, logged, query};
use crate::history::made::{End, Made, Run};
use crate::history::released::history;
use crate::jobs::{add, board, worker};

/// Empties the plant's tables.
fn emptied(server: &Server) {
    let mut client = server.client("postgres");
    client.batch_execute("DROP DATABASE plant WITH (FORCE)").unwrap();
    client.batch_execute("CREATE DATABASE plant").unwrap();
    Plant::prepare(&server.address()).unwrap();
}

#[test]
fn a_record_that_the_plant_has_lost_comes_again_with_its_run() {
    let server = Server::prepared();
    let (made, _) = send(history(), server.address());
    server.change("DELETE FROM record");
    forget(&made);
    let (made, all) = send(made, server.address());
    assert_eq!((all.sent, all.failed), (10, 0));
    is_as(&server, &made);
}

#[test]
fn a_plant_that_is_put_back_has_all_again_when_its_stations_send_it_again() {
    let server = Server::prepared();
    let (mut made, _) = send(history(), server.address());
    let mut client = server.client("postgres");
    client.batch_execute("CREATE DATABASE kept TEMPLATE plant").unwrap();
    made.run(&Run { lane: "3".to_owned(), ..Run::of("S2", End::Pass).at_hour(30) });
    let (mut made, all) = send(made, server.address());
    assert_eq!(all.sent, 1);
    client.batch_execute("DROP DATABASE plant WITH (FORCE)").unwrap();
    client.batch_execute("ALTER DATABASE kept RENAME TO plant").unwrap();
    let lost = query(made.as_ref(), "SELECT max(id) FROM run WHERE state = 'final'").remove(0);
    // Once a later run is sent, nothing else would show the loss.
    made.run(&Run { lane: "3".to_owned(), ..Run::of("S3", End::Pass).at_hour(31) });
    let (folder, store) = made.parts();
    drop(store);
    let again = ["outbox", "again", "plant", "--reason", "its disk broke", "--operator", "engel"];
    // What cannot be entered in the audit is not done, and neither is anything for a sink that does not exist.
    change(folder.path(), NO_AUDIT);
    assert_eq!(did(folder.path(), &server, &again).code, Some(3));
    change(folder.path(), "DROP TRIGGER full");
    let unknown = did(
        folder.path(),
        &server,
        &["outbox", "again", "mes", "--reason", "it broke", "--operator", "engel"],
    );
    assert!(unknown.code == Some(2) && unknown.complained.contains("no sink mes"), "{unknown:?}");
    let sent = did(folder.path(), &server, &["outbox", "send", "--any-disk"]);
    assert_eq!(sent.code, Some(3), "{sent:?}");
    assert!(sent.said.starts_with("0 sent, 1 not") && sent.said.contains(&lost), "{sent:?}");
    assert!(sent.said.contains("halfrow-station outbox again plant"), "{sent:?}");
    let done = did(folder.path(), &server, &again);
    assert_eq!((done.code, done.said.as_str()), (Some(0), "11 of plant are sent again\n"), "{done:?}");
    // Together with the audit's lines about it, of which one says by which account.
    let sent = did(folder.path(), &server, &["outbox", "send", "--any-disk"]);
    assert!(sent.said.starts_with("14 sent, 0 not"), "{sent:?}");
    is_as(&server, &Made::at(folder));
    let told = server.rows("SELECT operator_id, subject, detail FROM audit WHERE act = 'send-again'");
    assert_eq!(told, [["engel", "plant", "its disk broke"]]);
}

/// Whoever gives up a station's folder asks by this whether all is at the plant.
#[test]
fn a_plant_that_was_put_back_is_found_though_nothing_waits_for_it() {
    let server = Server::prepared();
    let (made, _) = send(history(), server.address());
    let newest = query(made.as_ref(), "SELECT max(id) FROM run WHERE state = 'final'").remove(0);
    let (folder, store) = made.parts();
    drop(store);
    let sends = || did(folder.path(), &server, &["outbox", "send", "--any-disk"]);
    let sent = sends();
    assert_eq!((sent.code, sent.said.as_str()), (Some(0), "nothing is left to be sent\n"), "{sent:?}");
    emptied(&server);
    let sent = sends();
    assert!(sent.code == Some(3) && sent.said.contains(&newest), "{sent:?}");
    assert!(sent.said.contains("`halfrow-station outbox again plant`"), "{sent:?}");
    server.change("DROP TABLE run CASCADE");
    let sent = sends();
    assert!(sent.code == Some(3) && !sent.said.contains("nothing is left"), "{sent:?}");
}

/// The copy of the plant does not have the claim: its job waits to be claimed for the first time.
#[test]
fn a_job_that_was_judged_after_the_copy_of_its_plant_is_done_by_the_run_that_is_sent_again() {
    let server = Server::prepared();
    let mut plant = Plant::connect(&server.address()).unwrap();
    assert!(plant.share(&board(0, "mock"), "engel").unwrap());
    add(&mut plant, 1);
    drop(plant);
    let mut client = server.client("postgres");
    client.batch_execute("CREATE DATABASE kept TEMPLATE plant").unwrap();
    let mut plant = Plant::connect(&server.address()).unwrap();
    let claim = plant.claim(&worker("station 7")).unwrap().unwrap();
    drop(plant);
    let mut made = Made::new();
    let of_job = Some(JobClaim { id: claim.job.clone(), fence: claim.fence });
    let run = made.run(&Run { job: of_job, ..Run::of(claim.serial(), End::Pass) });
    let (made, _) = send(made, server.address());
    let done = "SELECT job.state, job.fence, run.id, run.nth FROM job JOIN run ON run.id = job.run_id";
    let is_done = [["done", "1", &run, "1"]];
    assert_eq!(server.rows(done), is_done);
    client.batch_execute("DROP DATABASE plant WITH (FORCE)").unwrap();
    client.batch_execute("ALTER DATABASE kept RENAME TO plant").unwrap();
    assert_eq!(server.rows("SELECT state, fence FROM job"), [["waiting", "0"]]);
    forget(&made);
    send(made, server.address());
    assert_eq!(server.rows(done), is_done);
    assert_eq!(faults(&server, "plant"), Vec::<String>::new());
}

/// Its connections end before it is another one, so that this is never the first reason.
#[test]
fn a_station_at_work_says_what_to_do_about_a_plant_that_is_put_back() {
    let server = Server::prepared();
    let station = station(&server, "12", "green = \"plant\"");
    let (mut running, log) = station.start_logging();
    running.scan(SERIALS[0]);
    running.state("1", "PASS");
    await_sent(&station);
    let [mut outside, mut inside] = ["postgres", "plant"].map(|database| server.client(database));
    outside.batch_execute("ALTER DATABASE plant ALLOW_CONNECTIONS false").unwrap();
    let others = "SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE datname = 'plant' AND pid <> pg_backend_pid()";
    inside.batch_execute(others).unwrap();
    running.scan(SERIALS[1]);
    let unsaved = running.state("1", "UNSAVED");
    assert!(unsaved["note"].as_str().unwrap().ends_with("; the lane waits for the plant"), "{unsaved}");
    let told = "WARN the plant takes nothing, and all waits for it: ";
    logged(&log, 1, told);
    inside.batch_execute("TRUNCATE run CASCADE").unwrap();
    outside.batch_execute("ALTER DATABASE plant ALLOW_CONNECTIONS true").unwrap();
    logged(&log, 1, &format!("{told}the plant has lost the run "));
    running.wait("why the lane waits in vain", |news| {
        let note = news["note"].as_str().unwrap_or_default();
        note.contains("not at the plant yet") && note.ends_with("by `halfrow-station outbox again plant`")
    });
    assert_eq!(running.end().0, Some(0));
    logged(&log, 2, told);
}

/// The plant gets this run, and nothing else that the station has.
fn sent_alone(made: Made, run: &str, server: &Server) -> Made {
    let database = rusqlite::Connection::open(made.folder().database()).unwrap();
    let one = "UPDATE outbox SET done_ms = NULL, next_ms = 0, dead_ms = CASE WHEN subject = ?1 THEN NULL ELSE 1 END";
    database.execute(one, [run]).unwrap();
    let (made, all) = send(made, server.address());
    assert_eq!(all.sent, 1);
    made
}

/// A person need not know which runs a plant has lost when something that belongs to one of them comes later.
#[test]
fn runs_that_a_waiver_or_a_rebinding_misses_at_the_plant_are_sent_again() {
    let server = Server::prepared();
    let (mut made, _) = send(history(), server.address());
    let later = [
        ("kind = 'waiver'", "SELECT run_id FROM waiver"),
        (
            "kind = 'audit' AND subject IN (SELECT id FROM audit WHERE act = 'rebind')",
            "SELECT run.id FROM run JOIN audit ON audit.subject = run.unit_id WHERE act = 'rebind' AND state = 'final' ORDER BY 1",
        ),
    ];
    for (entry, missed) in later {
        emptied(&server);
        let mut missed = query(made.as_ref(), missed);
        assert!(!missed.is_empty());
        let newest = query(made.as_ref(), "SELECT max(subject) FROM outbox WHERE kind = 'run'").remove(0);
        made = sent_alone(made, &newest, &server);
        missed.push(newest);
        missed.sort();
        missed.dedup();
        made.change("UPDATE outbox SET done_ms = 1, dead_ms = NULL");
        let unsent = format!("UPDATE outbox SET done_ms = NULL, next_ms = 0 WHERE {entry}");
        assert_eq!(made.change(&unsent), 1);
        let all;
        (made, all) = send(made, server.address());
        assert_eq!((all.sent, all.failed), (0, 1));
        due(&made);
        (made, _) = send(made, server.address());
        assert_eq!(server.rows("SELECT id FROM run ORDER BY id").concat(), missed);
        assert!(made.now().unsent().unwrap().is_empty());
    }
}
