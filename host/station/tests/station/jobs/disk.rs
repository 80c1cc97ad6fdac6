//! Stations that take jobs while their own disk accepts nothing.

use std::process::{Command, Stdio};

use halfrow::Verdict;
use halfrow_station::settings::Settings;
use tempfile::TempDir;

use super::{add, at_work, judged, settings, shared, with_a_job};
use crate::common::{Did, Killed, change, command, folder, program, query, until_found};
use crate::plant::server::Server;

/// A station in its own folder, whose database can be made to refuse changes.
struct Station {
    folder: TempDir,
}

impl Station {
    fn new(server: &Server) -> Self {
        let station = Self { folder: folder() };
        settings(server, station.folder.path(), "12");
        let did = Did::from(station.work(&["--once"]).output().unwrap());
        assert_eq!(did.code, Some(0), "there is nothing to do yet: {did:?}");
        station
    }

    fn work(&self, more: &[&str]) -> Command {
        let mut command = command(self.folder.path(), &[&["work"], more].concat());
        command.stdout(Stdio::null());
        command
    }

    /// Makes its database refuse this, as on a full disk.
    fn refuses(&self, what: &str) {
        self.change(&format!(
            "CREATE TRIGGER full BEFORE {what} ON run BEGIN SELECT RAISE(ABORT, 'full'); END"
        ));
    }

    fn is_well_again(&self) {
        self.change("DROP TRIGGER full");
    }

    fn change(&self, text: &str) {
        change(&self.folder.path().join("data"), text);
    }
}

/// Waits until this query of the plant has rows.
fn await_rows(server: &Server, text: &str) -> Vec<Vec<String>> {
    until_found(text, || {
        let rows = server.rows(text);
        if rows.is_empty() { Err(server.rows("SELECT * FROM job")) } else { Ok(rows) }
    })
}

/// A plant with a job and a board, and a station whose database refuses this.
fn one_job_and_no_disk_for(what: &str) -> (Server, Station) {
    let (server, mut plant) = shared(1);
    let station = Station::new(&server);
    add(&mut plant, 1);
    station.refuses(what);
    (server, station)
}

#[test]
fn a_job_that_a_full_disk_kept_from_beginning_costs_no_attempt() {
    let (server, station) = one_job_and_no_disk_for("INSERT");
    let did = Did::from(station.work(&["--once"]).output().unwrap());
    assert!(did.code == Some(3) && did.complained.contains("the board not touched"), "{did:?}");
    assert_eq!(server.rows("SELECT state, attempts, fence FROM job"), [["waiting", "0", "1"]]);
    assert_eq!(server.rows("SELECT count(*) FROM board WHERE holder IS NOT NULL"), [["0"]]);
    let worker = Killed(station.work(&[]).spawn().unwrap());
    await_rows(&server, "SELECT 1 FROM job WHERE fence >= 3");
    station.is_well_again();
    let ended = await_rows(&server, "SELECT state, attempts FROM job WHERE state IN ('done', 'dead')");
    assert_eq!(ended, [["done", "1"]]);
    worker.end();
}

/// Its run stays open until then, and nothing else begins on its board.
#[test]
fn what_a_worker_could_not_save_is_closed_before_it_takes_another_job() {
    let (server, station) = one_job_and_no_disk_for("UPDATE");
    let worker = Killed(station.work(&[]).spawn().unwrap());
    await_rows(&server, "SELECT 1 FROM job WHERE attempts = 1 AND state = 'waiting'");
    station.is_well_again();
    let ended = await_rows(&server, "SELECT state, attempts FROM job WHERE state IN ('done', 'dead')");
    assert_eq!(ended, [["done", "2"]]);
    worker.end();
    let verdicts = query(&station.folder.path().join("data"), "SELECT verdict FROM run ORDER BY id");
    assert_eq!(verdicts, ["ERROR", "PASS"]);
}

/// The table that would tell is gone.
#[test]
fn a_verdict_is_told_though_the_store_does_not_say_whether_the_plant_has_it() {
    let (server, ..) = with_a_job();
    let folder = folder();
    let settings = Settings::load_without_lanes(&settings(&server, folder.path(), "12")).unwrap();
    let work = at_work(&settings, program().to_owned());
    change(&folder.path().join("data"), "ALTER TABLE outbox RENAME TO elsewhere");
    let judged = judged(&work);
    assert_eq!(judged.saved.record.conclusion.verdict, Verdict::Pass);
    assert!(!judged.is_sent);
}
