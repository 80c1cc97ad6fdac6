//! Shared boards that cannot be judged where they are said to be, beside good ones of their kind.

use std::path::Path;

use halfrow_station::store::{Claim, Plant, SharedBoard, Wanted};

use super::{add, board, job, plan, settings, shared, states, worker};
use crate::common::{Did, did_in, folder};
use crate::plant::server::Server;

/// A plant with `shelf-0`, at an address that refuses, and `shelf-1`.
fn with_one_unreachable() -> (Server, Plant) {
    let (server, mut plant) = shared(2);
    let unreachable = SharedBoard { target: "tcp:127.0.0.1:9".to_owned(), ..board(0, "mock") };
    assert!(plant.share(&unreachable, "engel").unwrap());
    (server, plant)
}

/// Has the station in `folder` take all jobs that it can judge.
fn worked(server: &Server, folder: &Path) -> Did {
    settings(server, folder, "12");
    let did = did_in(folder, &["work", "--once"]);
    assert_eq!(did.code, Some(0), "{did:?}");
    did
}

/// The cable is not the job's fault.
#[test]
fn an_unreachable_board_ends_no_job_that_another_board_of_the_kind_can_do() {
    let (server, mut plant) = with_one_unreachable();
    let plan = plan();
    add(&mut plant, 6);
    plant.add_jobs(&job(&plan, &Wanted::Serial("CAT00000".to_owned())), 1).unwrap();
    worked(&server, folder().path());
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
    add(&mut plant, 1);
    worked(&server, folder().path());
    add(&mut plant, 2);
    let mut claim = || plant.claim(&worker("12")).unwrap();
    let board = |claim: Option<&Claim>| claim.map(|claim| claim.lease.board.clone());
    let first = claim();
    assert_eq!(board(first.as_ref()).as_deref(), Some("shelf-1"));
    assert_eq!(claim(), None, "the good board is in use");
    let ended = |minutes: u32| {
        let ms = "CAST(extract(epoch FROM clock_timestamp()) * 1000 AS BIGINT)";
        server.change(&format!("UPDATE run SET ended_ms = {ms} - {minutes} * 60000 WHERE verdict = 'ERROR'"));
    };
    ended(9);
    assert_eq!(claim(), None);
    server.change("UPDATE run SET cause = 'operator' WHERE verdict = 'ERROR'");
    let second = claim();
    assert_eq!(board(second.as_ref()).as_deref(), Some("shelf-0"), "a person ended it");
    server.change("UPDATE run SET cause = 'link' WHERE verdict = 'ERROR'");
    server.change("UPDATE job SET state = 'waiting' WHERE state = 'claimed'; UPDATE board SET until_ms = 0");
    ended(11);
    assert_eq!([claim(), claim()].map(|claim| board(claim.as_ref()).unwrap()), ["shelf-1", "shelf-0"]);
    server.change("UPDATE job SET state = 'waiting' WHERE state = 'claimed'; UPDATE board SET until_ms = 0");
    ended(0);
    server.change("UPDATE board SET out = 'lent' WHERE name = 'shelf-1'");
    assert_eq!(board(claim().as_ref()).as_deref(), Some("shelf-0"), "there is no other");
}

/// It could be judged by no number of claims, and its label is on another board.
#[test]
fn a_board_that_cannot_be_judged_as_it_is_shared_costs_no_attempt_and_is_named() {
    let named = "shelf-0 is shared under the serial number `S0078`, which is none of the plan CAM-T/quick; share it under";
    let wrong = [
        (SharedBoard { serial: "S0078".to_owned(), ..board(0, "mock") }, named),
        (
            SharedBoard { target: "mock,fault".to_owned(), ..board(0, "mock") },
            "shelf-0 is at mock,fault, which is no board",
        ),
    ];
    for (wrong, said) in wrong {
        let (server, mut plant) = shared(1);
        let folder = folder();
        assert!(plant.share(&wrong, "engel").unwrap());
        add(&mut plant, 2);
        let did = worked(&server, folder.path());
        assert_eq!(did.complained.matches(said).count(), 1, "{did:?}");
        assert_eq!(states(&server), [["waiting", "0"], ["waiting", "0"]]);
        assert_eq!(server.rows("SELECT count(*) FROM board WHERE holder IS NOT NULL"), [["0"]]);
        let told = server.rows("SELECT said FROM job ORDER BY id LIMIT 1").concat().concat();
        assert!(told.contains(said), "{told}");
        assert!(plant.share(&board(1, "mock"), "engel").unwrap());
        worked(&server, folder.path());
        assert_eq!(states(&server), [["done", "1"], ["done", "1"]]);
        assert!(plant.share(&board(0, "mock"), "engel").unwrap());
        add(&mut plant, 1);
        worked(&server, folder.path());
        assert_eq!(server.rows("SELECT lane FROM run ORDER BY id DESC LIMIT 1"), [["shelf-0"]]);
    }
}
