//! Shared boards that cannot be judged where they are said to be, beside good ones of their kind.

use std::process::Command;

use halfrow_station::store::{Claim, Plant, SharedBoard, Wanted};

use super::{any, board, job, plan, settings, shared, worker};
use crate::common::{Did, folder, program};
use crate::plant::server::Server;

/// A plant with `shelf-0`, at an address that refuses, and `shelf-1`.
fn with_one_unreachable() -> (Server, Plant) {
    let (server, mut plant) = shared(2);
    let unreachable = SharedBoard { target: "tcp:127.0.0.1:9".to_owned(), ..board(0, "mock") };
    assert!(plant.share(&unreachable, "engel").unwrap());
    (server, plant)
}

/// Has a station take all jobs that it can judge.
fn worked(server: &Server) -> Did {
    let folder = folder();
    let path = settings(server, folder.path(), "12");
    let did =
        Did::from(Command::new(program()).args(["work", "--once", "--settings"]).arg(path).output().unwrap());
    assert_eq!(did.code, Some(0), "{did:?}");
    did
}

/// The state of each job and how often it was claimed, in the order in which they were added.
fn states(server: &Server) -> Vec<Vec<String>> {
    server.rows("SELECT state, attempts FROM job ORDER BY id")
}

/// The cable is not the job's fault.
#[test]
fn an_unreachable_board_ends_no_job_that_another_board_of_the_kind_can_do() {
    let (server, mut plant) = with_one_unreachable();
    let (plan, any) = (plan(), any());
    plant.add_jobs(&job(&plan, &any), 6).unwrap();
    plant.add_jobs(&job(&plan, &Wanted::Serial("CAT00000".to_owned())), 1).unwrap();
    worked(&server);
    let first = ["done", "2"];
    let other = ["done", "1"];
    // Whoever means the unreachable board itself gets no other.
    assert_eq!(states(&server), [first, other, other, other, other, other, ["dead", "5"]]);
    let judged = "SELECT lane, verdict, count(*) FROM run GROUP BY lane, verdict ORDER BY lane";
    assert_eq!(server.rows(judged), [["shelf-0", "ERROR", "6"], ["shelf-1", "PASS", "6"]]);
}

#[test]
fn a_board_that_ended_in_an_error_is_tried_again_when_no_other_would_do_or_after_ten_minutes() {
    let (server, mut plant) = with_one_unreachable();
    let (plan, any) = (plan(), any());
    plant.add_jobs(&job(&plan, &any), 1).unwrap();
    worked(&server);
    plant.add_jobs(&job(&plan, &any), 2).unwrap();
    let mut claim = || plant.claim(&worker("12")).unwrap();
    let board = |claim: Option<&Claim>| claim.map(|claim| claim.lease.board.clone());
    let first = claim();
    assert_eq!(board(first.as_ref()).as_deref(), Some("shelf-1"));
    assert_eq!(claim(), None, "the good board is in use");
    let change = |text: &str| server.client("plant").batch_execute(text).unwrap();
    let ended = |minutes: u32| {
        let ms = "CAST(extract(epoch FROM clock_timestamp()) * 1000 AS BIGINT)";
        change(&format!("UPDATE run SET ended_ms = {ms} - {minutes} * 60000 WHERE verdict = 'ERROR'"));
    };
    ended(9);
    assert_eq!(claim(), None);
    change("UPDATE run SET cause = 'operator' WHERE verdict = 'ERROR'");
    let second = claim();
    assert_eq!(board(second.as_ref()).as_deref(), Some("shelf-0"), "a person ended it");
    change("UPDATE run SET cause = 'link' WHERE verdict = 'ERROR'");
    change("UPDATE job SET state = 'waiting' WHERE state = 'claimed'; UPDATE board SET until_ms = 0");
    ended(11);
    assert_eq!([claim(), claim()].map(|claim| board(claim.as_ref()).unwrap()), ["shelf-1", "shelf-0"]);
    change("UPDATE job SET state = 'waiting' WHERE state = 'claimed'; UPDATE board SET until_ms = 0");
    ended(0);
    change("UPDATE board SET out = 'lent' WHERE name = 'shelf-1'");
    assert_eq!(board(claim().as_ref()).as_deref(), Some("shelf-0"), "there is no other");
}
