//! Stations that take jobs: real processes, and real runs on mock boards.

use std::cell::{Cell, RefCell};
use std::fs::{self, File};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use halfrow::verdict::StoppedBy;
use halfrow_station::run::RunError;
use halfrow_station::store::{SINK_OF_PLANT, Store};
use halfrow_station::work::WorkError;
use nix::sys::signal::Signal;
use serde_json::Value;

use super::{add, job, plan, run_out, settings, shared};
use crate::common::{Did, HANG, command, did_in, engel, program, query, reason, signal, until};
use crate::plant::clocks::FAST;
use crate::plant::server::Server;

fn work(server: &Server, name: &str) -> (tempfile::TempDir, Command) {
    let folder = crate::common::folder();
    settings(server, folder.path(), name);
    let mut command = command(folder.path(), &["work", "--once", "--json"]);
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    (folder, command)
}

/// Waits until somebody has claimed a job.
fn until_claimed(server: &Server) {
    until("a claim", || !server.rows("SELECT 1 FROM job WHERE state = 'claimed'").is_empty());
}

/// Waits until the station with this folder has claimed a job and begun its run.
fn until_begun(server: &Server, folder: &Path) {
    until_claimed(server);
    let data = folder.join("data");
    until("a run", || !query(&data, "SELECT 1 FROM run WHERE state = 'open'").is_empty());
}

#[test]
fn jobs_are_judged_by_whoever_is_free_and_each_once() {
    let (server, mut plant) = shared(2);
    let broken = halfrow_station::store::SharedBoard {
        target: "mock,fault=stuck-data".to_owned(),
        ..super::board(5, "mock")
    };
    plant.share(&broken, "engel").unwrap();
    let plan = plan();
    let wanted = halfrow_station::store::Wanted::Serial("CAT00005".to_owned());
    add(&mut plant, 4);
    let unit = plant.add_jobs(&job(&plan, &wanted), 1).unwrap();
    let mut stations = ["12", "13"].map(|name| work(&server, name));
    let running: Vec<_> = stations.iter_mut().map(|(_, command)| command.spawn().unwrap()).collect();
    let mut judged = Vec::<Value>::new();
    for process in running {
        let did = Did::from(process.wait_with_output().unwrap());
        assert_eq!(did.code, Some(0), "{did:?}");
        judged.extend(did.said.lines().map(|line| serde_json::from_str::<Value>(line).unwrap()));
    }
    assert_eq!(judged.len(), 5, "{judged:?}");
    for one in &judged {
        assert_eq!((&one["counts"], &one["at_plant"]), (&true.into(), &true.into()), "{one}");
        let is_broken = one["board"] == "shelf-5";
        assert_eq!(one["verdict"], if is_broken { "FAIL" } else { "PASS" }, "{one}");
        assert!(is_broken || one["job"] != unit[0].as_str());
    }
    assert_eq!(
        server.rows("SELECT count(*), count(DISTINCT run_id) FROM job WHERE state = 'done'"),
        [["5", "5"]]
    );
    assert_eq!(server.rows("SELECT count(*) FROM board WHERE holder IS NOT NULL"), [["0"]]);
    let lanes = server.rows("SELECT DISTINCT lane FROM run JOIN job ON job.run_id = run.id ORDER BY lane");
    assert!(lanes.iter().all(|lane| lane[0].starts_with("shelf-")), "{lanes:?}");
}

/// A worker whose log is on a full disk would otherwise take no more jobs.
#[test]
fn a_station_whose_stdout_takes_nothing_goes_on_with_the_next_job() {
    let (server, mut plant) = shared(1);
    add(&mut plant, 2);
    let (_folder, mut command) = work(&server, "12");
    let full = File::options().write(true).open("/dev/full").unwrap();
    let did = Did::from(command.stdout(full).output().unwrap());
    assert!(did.code == Some(0) && did.complained.contains("the exit code stands"), "{did:?}");
    assert_eq!(server.rows("SELECT state FROM job"), [["done"], ["done"]]);
}

#[test]
fn a_worker_that_is_killed_leaves_a_job_that_another_one_does() {
    let (server, mut plant) = shared(1);
    plant.share(&endless(0), "engel").unwrap();
    add(&mut plant, 1);
    let (folder, mut command) = work(&server, "12");
    let mut first = command.spawn().unwrap();
    until_begun(&server, folder.path());
    first.kill().unwrap();
    first.wait().unwrap();
    let (_other, mut command) = work(&server, "13");
    // The lease of the first is still valid.
    let none = Did::from(command.output().unwrap());
    assert_eq!((none.code, none.said.as_str()), (Some(0), ""), "{none:?}");
    run_out(&server);
    plant.share(&super::board(0, "mock"), "engel").unwrap();
    server.change("UPDATE board SET target = 'mock', holder = NULL");
    let did = Did::from(command.output().unwrap());
    assert!(did.said.contains("\"verdict\":\"PASS\""), "{did:?}");
    assert_eq!(server.rows("SELECT state, fence FROM job"), [["done", "2"]]);
    // The run that the first one had begun is closed when it starts again, and does not count for the job.
    let again = did_in(folder.path(), &["work", "--once"]);
    assert_eq!(again.code, Some(0), "{again:?}");
    let claims = "SELECT text::json #>> '{run,job,fence}' FROM record, run WHERE sha256 = record_sha256 AND cause = 'crash'";
    let claims = server.rows(claims);
    assert_eq!(claims, [["1"]]);
    // A station without a lane also tells what it has not sent.
    let unsent = did_in(folder.path(), &["outbox", "list"]);
    assert_eq!(unsent.code, Some(0), "{unsent:?}");
    assert!(fs::exists(folder.path().join("data/station.db")).unwrap());
    assert_eq!(server.rows("SELECT count(*) FROM run WHERE verdict = 'PASS'"), [["1"]]);
}

/// A board whose judging takes as long as the test needs.
fn endless(number: usize) -> halfrow_station::store::SharedBoard {
    halfrow_station::store::SharedBoard {
        target: "mock,pace=real,speed=20000".to_owned(),
        ..super::board(number, "mock")
    }
}

/// A station takes as many jobs at a time as its settings say, and gives all of them back when told to end.
#[test]
fn a_station_judges_so_many_jobs_at_once_and_ends_all_of_them_when_it_is_told_to() {
    let (server, mut plant) = shared(0);
    for number in 0..3 {
        plant.share(&endless(number), "engel").unwrap();
    }
    add(&mut plant, 3);
    drop(plant);
    let folder = crate::common::folder();
    let path = settings(&server, folder.path(), "12");
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, text.clone() + "at_once = 2\n").unwrap();
    let mut command = command(folder.path(), &["work", "--json", "--any-disk"]);
    let mut worker = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let open = || query(&folder.path().join("data"), "SELECT lane FROM run WHERE state = 'open'");
    let both = "SELECT 1 FROM job WHERE state = 'claimed' HAVING count(*) = 2";
    until("two runs of two jobs", || {
        assert_eq!(worker.try_wait().unwrap(), None, "it ends");
        !server.rows(both).is_empty() && open().len() == 2
    });
    // Both places are taken: the third board is free, and its job waits.
    assert_eq!(
        server.rows("SELECT state, count(*) FROM job GROUP BY state ORDER BY state"),
        [["claimed", "2"], ["waiting", "1"]]
    );
    let connections = "SELECT count(*) FROM pg_stat_activity WHERE application_name = 'halfrow-station'";
    // What each run holds is asked over one connection, and renewed over another; what is sent has one more.
    let connections: u32 = server.rows(connections)[0][0].parse().unwrap();
    assert!((2..=5).contains(&connections), "{connections}");
    signal(worker.id(), Signal::SIGTERM);
    let did = Did::from(worker.wait_with_output().unwrap());
    assert_eq!(did.code, Some(143), "{did:?}");
    assert_eq!(server.rows("SELECT count(*) FROM board WHERE holder IS NOT NULL"), [["0"]]);
    assert_eq!(open(), [""; 0]);
    fs::write(&path, text + "at_once = 0\n").unwrap();
    let refused = Did::from(command.output().unwrap());
    assert!(refused.code == Some(2) && refused.complained.contains("give 1 to 64"), "{refused:?}");
}

/// The plant is there, and does not take the run: as if it could not be sent any more.
#[test]
fn a_station_that_is_told_to_end_gives_the_job_of_its_run_back() {
    let (server, mut plant) = shared(0);
    plant.share(&endless(0), "engel").unwrap();
    add(&mut plant, 1);
    server.never_holds("run");
    let (folder, mut command) = work(&server, "12");
    let worker = command.spawn().unwrap();
    until_begun(&server, folder.path());
    signal(worker.id(), Signal::SIGTERM);
    let did = Did::from(worker.wait_with_output().unwrap());
    assert_eq!(did.code, Some(143), "{did:?}");
    assert_eq!(server.rows("SELECT state, attempts, holder FROM job"), [["waiting", "0", "NULL"]], "{did:?}");
    assert_eq!(server.rows("SELECT count(*) FROM board WHERE holder IS NOT NULL"), [["0"]]);
}

/// It would take fewer at a time for as long as it runs, and nobody would know.
#[test]
fn a_station_without_a_thread_for_each_of_its_jobs_ends_and_says_so() {
    let (server, _plant) = shared(0);
    let folder = crate::common::folder();
    let path = settings(&server, folder.path(), "12");
    fs::write(&path, fs::read_to_string(&path).unwrap() + "at_once = 8\n").unwrap();
    let mut traced = Command::new("timeout");
    traced.arg(HANG.as_secs().to_string());
    // Of the threads that the first one starts, the fourth and all later ones fail.
    traced.args(["strace", "-f", "-b", "execve", "-qq", "-o"]).arg(folder.path().join("calls"));
    traced.args(["-e", "trace=clone3", "-e", "signal=none", "-e", "inject=clone3:error=EAGAIN:when=4+"]);
    traced.arg(program()).args(["work", "--any-disk", "--settings"]).arg(&path);
    let did = Did::from(traced.output().unwrap());
    assert!(did.code == Some(3) && did.complained.contains("temporarily unavailable"), "{did:?}");
}

/// Whoever finds the run open after a power cut has its row, which is on the disk, too.
#[test]
fn the_claim_of_a_run_and_its_name_are_on_the_disk_before_its_board_is_touched() {
    let (server, _plant, _) = super::with_a_job();
    let folder = crate::common::folder();
    let path = settings(&server, folder.path(), "12");
    let trace = folder.path().join("calls");
    let mut traced = Command::new("strace");
    traced.args(["-f", "-y", "-qq", "-e", "trace=fsync,execve", "-e", "signal=none", "-o"]).arg(&trace);
    traced.arg(program()).args(["work", "--once", "--settings"]).arg(path);
    let did = Did::from(traced.output().unwrap());
    assert_eq!(did.code, Some(0), "{did:?}");
    let calls = fs::read_to_string(trace).unwrap();
    let (before, _) = calls.split_once("\"lane\"").unwrap();
    let run = &server.rows("SELECT id FROM run")[0][0];
    for synced in ["/data/spool>".to_owned(), format!("/spool/{run}>"), format!("/spool/{run}/claim.json>")] {
        let is_synced = |line: &str| line.contains("fsync(") && line.contains(&synced);
        assert!(before.lines().any(is_synced), "{synced}: {before}");
    }
}

#[test]
fn a_run_that_was_ended_since_its_job_was_cancelled_says_so_and_blames_nobody() {
    let (server, mut plant) = shared(0);
    plant.share(&endless(0), "engel").unwrap();
    let id = add(&mut plant, 1).remove(0);
    let (folder, mut command) = work(&server, "12");
    let worker = command.spawn().unwrap();
    until_claimed(&server);
    assert!(plant.cancel_job(&id, engel(&reason("a mistake"))).unwrap());
    let did = Did::from(worker.wait_with_output().unwrap());
    let ended: Value = serde_json::from_str(&did.said).unwrap();
    let headline = ended["headline"].as_str().unwrap();
    assert!(headline.contains("the board shelf-0 is not ours any more"), "{did:?}");
    assert_eq!(server.rows("SELECT count(*) FROM board WHERE holder IS NOT NULL"), [["0"]]);
    let data = folder.path().join("data");
    assert_eq!(query(&data, "SELECT verdict FROM run"), ["ERROR"]);
    assert_eq!(query(&data, "SELECT cause FROM run"), ["station"]);
    assert_eq!(query(&data, "SELECT headline FROM run"), [headline]);
}

/// The other one came first.
#[test]
fn a_station_takes_no_job_while_another_one_has_its_name() {
    let (server, mut plant) = shared(1);
    let (_first, mut command) = work(&server, "12");
    assert_eq!(Did::from(command.output().unwrap()).code, Some(0), "there is no job yet");
    add(&mut plant, 1);
    let (_second, mut command) = work(&server, "12");
    let mut second = command.spawn().unwrap();
    until("the end of the second one", || {
        if !server.rows("SELECT 1 FROM job WHERE fence > 0").is_empty() {
            second.kill().unwrap();
            second.wait().unwrap();
            panic!("it has taken the job");
        }
        second.try_wait().unwrap().is_some()
    });
    let did = Did::from(second.wait_with_output().unwrap());
    assert!(
        did.code == Some(3) && did.complained.contains("another station of this plant is called 12"),
        "{did:?}"
    );
    assert_eq!(server.rows("SELECT state, fence FROM job"), [["waiting", "0"]]);
}

/// Not only once the outbox, which is at work beside, has heard the plant's.
#[test]
fn a_worker_compares_the_clocks_before_its_first_run() {
    let (server, _plant, _) = super::with_a_job();
    server.change(FAST);
    let folder = crate::common::folder();
    let path = settings(&server, folder.path(), "12");
    let settings = halfrow_station::settings::Settings::load_without_lanes(&path).unwrap();
    let work = super::at_work(&settings, program().to_owned());
    work.store.with(|store| store.sends_to(vec![SINK_OF_PLANT.to_owned()])).unwrap();
    let origin = work.store.with(Store::origin).unwrap();
    work.introduce(&settings.introduction(origin), false, &|| None).unwrap();
    // Nothing sends the run if there is one.
    let begun = Instant::now();
    let stop = || (begun.elapsed() > Duration::from_secs(20)).then_some(StoppedBy::Person);
    let refused = work.judge(work.claim().unwrap().unwrap(), &stop, &stop, &mut |_| ()).unwrap_err();
    assert!(
        matches!(&refused, WorkError::Run(RunError::NotBegun(why)) if why.to_string().contains("60 min apart"))
    );
    assert_eq!(server.rows("SELECT state, attempts FROM job"), [["waiting", "0"]]);
}

/// A standby that takes over is read-only until it has done so (PostgreSQL, appendix A: 25006).
#[test]
fn a_worker_waits_for_a_plant_that_refuses_for_a_while() {
    let (server, _plant, id) = super::with_a_job();
    let folder = crate::common::folder();
    let path = settings(&server, folder.path(), "12");
    let settings = halfrow_station::settings::Settings::load_without_lanes(&path).unwrap();
    let work = super::at_work(&settings, program().to_owned());
    let mut client = server.client("postgres");
    client.batch_execute("ALTER DATABASE plant SET default_transaction_read_only = on").unwrap();
    let (client, asked) = (RefCell::new(client), Cell::new(0));
    // Who waits asks first before it claims, and again before it claims once more.
    let stop = || {
        asked.set(asked.get() + 1);
        if asked.get() == 2 {
            let reset = "ALTER DATABASE plant RESET default_transaction_read_only";
            client.borrow_mut().batch_execute(reset).unwrap();
        }
        None
    };
    assert_eq!(work.next(&stop).unwrap().unwrap().job, id);
    assert!(asked.get() > 1);
}
