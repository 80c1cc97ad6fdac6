//! Runs that others ended, or whose board others had: they say nothing of the job.

use std::io::{Read as _, Write as _};
use std::net::TcpListener;
use std::thread;

use halfrow_station::record::RunCause;
use halfrow_station::store::{Claim, Parcel, SharedBoard};

use super::claims::{run_of, with_record};
use super::{add, settings, shared, states, with_a_job, worker};
use crate::common::did_in;
use crate::history::made::End;

/// signal(7): SIGHUP is 1, SIGINT 2, SIGTERM 15; docs/verify.md: exit code 4 is a board that somebody else has.
#[test]
fn a_run_that_was_ended_from_outside_or_whose_board_was_in_use_costs_its_job_no_claim() {
    let (server, mut plant, _) = with_a_job();
    for (number, code) in (1..).zip([4, 128 + 1, 128 + 2, 128 + 15, 4, 4]) {
        let claim = plant.claim(&worker("12")).unwrap().unwrap();
        plant.take(&ended_with(&claim, number, code)).unwrap();
        plant.give_back(&claim.lease).unwrap();
        assert_eq!(states(&server), [["waiting", "0"]], "{code}");
    }
    let claim = plant.claim(&worker("12")).unwrap().unwrap();
    plant.take(&run_of(&claim, 9, End::Error(RunCause::Link))).unwrap();
    assert_eq!(states(&server), [["waiting", "1"]]);
}

/// An ERROR of a claim, with this exit code.
fn ended_with(claim: &Claim, number: u32, code: u8) -> Parcel {
    let error = run_of(claim, number, End::Error(RunCause::Station));
    with_record(error, |record| record.conclusion.exit_code = code)
}

/// A plant that was put back has forgotten the claim, and never counted it.
#[test]
fn a_claim_that_was_forgotten_gives_back_no_claim_that_was_counted() {
    let (server, mut plant, _) = with_a_job();
    let claim = plant.claim(&worker("12")).unwrap().unwrap();
    plant.take(&run_of(&claim, 1, End::Error(RunCause::Link))).unwrap();
    let forgotten = Claim { fence: claim.fence + 1, ..claim };
    plant.take(&ended_with(&forgotten, 2, 4)).unwrap();
    assert_eq!(states(&server), [["waiting", "1"]]);
}

/// As ser2net turns a second host away.
#[test]
fn a_board_that_another_host_uses_is_left_alone_for_a_while_and_its_jobs_wait() {
    let (server, mut plant) = shared(0);
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let target = format!("tcp:{}", listener.local_addr().unwrap());
    thread::spawn(move || {
        for client in listener.incoming() {
            let mut client = client.unwrap();
            let _ = client.write_all(b"Port already in use\r\n");
            let _ = client.shutdown(std::net::Shutdown::Write);
            let _ = client.read_to_end(&mut Vec::new());
        }
    });
    plant.share(&SharedBoard { target, ..super::board(0, "mock") }, "engel").unwrap();
    add(&mut plant, 2);
    let folder = crate::common::folder();
    settings(&server, folder.path(), "12");
    for _ in 0..2 {
        let did = did_in(folder.path(), &["work", "--once"]);
        assert_eq!(did.code, Some(0), "{did:?}");
        assert_eq!(server.rows("SELECT exit_code FROM run"), [["4"]], "{did:?}");
        assert_eq!(states(&server), [["waiting", "0"], ["waiting", "0"]]);
    }
    // When its lease has run out it is taken again.
    super::run_out(&server);
    did_in(folder.path(), &["work", "--once"]);
    assert_eq!(server.rows("SELECT count(*) FROM run"), [["2"]]);
}
