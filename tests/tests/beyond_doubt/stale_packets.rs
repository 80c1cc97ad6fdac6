//! Links that deliver a second copy of a request late, behind newer ones: a sound board is never FAIL for it, and a broken one
//! never PASS.

use std::collections::VecDeque;
use std::time::Duration;

use halfrow::board::{Board, OpenOptions};
use halfrow::link_test;
use halfrow::progress::Silent;
use halfrow::result::{CheckName, Outcome, Report};
use halfrow::run::{Circumstances, Draws, RunOptions, verify};
use halfrow::verdict::Verdict;
use halfrow_protocol::message::{Refusal, RefusalCode, Status};
use halfrow_protocol::{Kind, Reply};
use halfrow_tests::altered::{Altered, Passing, Toward, judge};
use halfrow_tests::system::System;

/// A link that delivers the request number `which` of a kind once more, in front of the request number `before` of another, and
/// may lose the answer to that copy.
fn late_copy(which: (Kind, usize), before: (Kind, usize), answered: bool) -> Report {
    let (mut seen, mut waited) = (0, 0);
    let mut copy: Option<Passing> = None;
    // The answers to be lost, which come in the order of the requests.
    let mut to_lose = VecDeque::new();
    let alter = move |toward, packet: Passing| {
        if toward == Toward::Host {
            let is_answer = to_lose.front() == Some(&(packet.header.kind, packet.header.sequence));
            return if is_answer && to_lose.pop_front().is_some() { Vec::new() } else { vec![packet] };
        }
        let mut passed = Vec::new();
        waited += usize::from(packet.is(before.0) && copy.is_some());
        if waited > before.1
            && let Some(late) = copy.take()
        {
            if !answered {
                to_lose.push_back((late.header.kind, late.header.sequence));
            }
            waited = 0;
            passed.push(late);
        }
        seen += usize::from(packet.is(which.0));
        if packet.is(which.0) && seen == which.1 + 1 {
            copy = Some(packet.clone());
        }
        passed.push(packet);
        passed
    };
    System::TINY.judge_candidate(Altered::new(&halfrow_mock::Options::default(), alter).candidate())
}

#[test]
fn an_old_copy_of_a_request_makes_no_sound_board_fail() {
    let requests = [Kind::Status, Kind::Reset, Kind::TableWrite, Kind::Commit, Kind::Configure];
    let others = [Kind::TableCrc, Kind::Commit, Kind::RowIn, Kind::Status];
    let mut ends = Vec::new();
    for which in requests.into_iter().flat_map(|kind| (0..3).map(move |number| (kind, number))) {
        for before in others.into_iter().flat_map(|kind| [0, 3, 40].map(|number| (kind, number))) {
            for answered in [true, false] {
                let report = late_copy(which, before, answered);
                let what =
                    format!("{which:?} before {before:?}, answered: {answered}: {}", report.headline());
                assert_ne!(report.verdict, Verdict::Fail, "{what}");
                ends.push(report.verdict);
            }
        }
    }
    // Most of them do no harm, and some would have.
    let errors = ends.iter().filter(|&&verdict| verdict == Verdict::Error).count();
    assert!(errors > 0 && 2 * errors < ends.len(), "{errors} errors of {}", ends.len());
}

/// How many reads and echoes are wrong in the test of a link that delivers the first TABLE_WRITE once more in front of the second
/// TABLE_READ, before a board that reads its tables otherwise if it is `broken`.
fn wrong_of_link(broken: bool) -> (u64, bool) {
    let (sender, delivered) = std::sync::mpsc::channel();
    let (mut copy, mut reads) = (None, 0);
    let alter = move |toward, mut packet: Passing| {
        if toward == Toward::Host {
            let last =
                packet.payload.last_mut().filter(|_| broken && packet.header.kind == Kind::TableRead.code());
            last.into_iter().for_each(|byte| *byte ^= 1);
            return vec![packet];
        }
        if packet.is(Kind::TableWrite) && copy.is_none() && reads == 0 {
            copy = Some(packet.clone());
        }
        reads += usize::from(packet.is(Kind::TableRead));
        let late = copy.take_if(|_| reads == 2);
        late.iter().for_each(|_| sender.send(()).unwrap());
        late.into_iter().chain([packet]).collect()
    };
    let link = Altered::new(&halfrow_mock::Options::default(), alter).candidate().link;
    let mut board = Board::open(link, &OpenOptions::default()).map_err(|(error, _)| error).unwrap();
    let figures = link_test::run(&mut board, Duration::from_millis(50), 1).unwrap();
    (figures.errors.wrong, delivered.try_recv().is_ok())
}

#[test]
fn an_old_copy_of_a_request_makes_no_link_test_call_a_sound_board_wrong() {
    assert_eq!(wrong_of_link(false), (0, true));
    assert!(wrong_of_link(true).0 > 0);
}

/// A request comes twice, and the counters are wrong behind frames that are right; in the session in which that is looked at again
/// nothing comes back.
#[test]
fn no_check_of_a_doubtful_session_is_told_of_the_next_one() {
    let (mut first, mut is_lost) = (None, false);
    let report = judge(&System::TINY, move |toward, packet: Passing| {
        let session = packet.header.session;
        if packet.is(Kind::Echo) && *first.get_or_insert(session) != session {
            return Vec::new();
        }
        if toward == Toward::Host && packet.is(Kind::TableWrite) && !is_lost {
            is_lost = true;
            return Vec::new();
        }
        match packet.reply() {
            Some(Reply::Status(status)) => {
                vec![packet.saying(&Reply::Status(Status { samples_over: 1, ..status }))]
            }
            _ => vec![packet],
        }
    });
    assert_eq!(report.verdict, Verdict::Error, "{}", report.headline());
    let told = report.checks.iter().filter(|check| check.outcome != Outcome::Skipped);
    let told: Vec<_> = told.map(|check| (check.name, check.outcome)).collect();
    let passed = [CheckName::Judge, CheckName::Identity].map(|name| (name, Outcome::Passed));
    assert_eq!(told, [&passed[..], &[(CheckName::Link, Outcome::Error)]].concat());
}

/// Every program's first packet would be its number 1 otherwise, and a refusal names no nonce.
#[test]
fn a_refusal_that_an_earlier_program_was_told_is_not_this_one_s() {
    let draws = Draws { nonce: 5, host: 6, sequence: 0xfffe };
    let alter = |toward, packet: Passing| {
        if toward == Toward::Board || !packet.is(Kind::Hello) {
            return vec![packet];
        }
        let refusal = Refusal { code: RefusalCode::Held, kind: Kind::Hello.code(), detail: 37 };
        let mut stale = packet.saying(&Reply::Refusal(refusal));
        (stale.header.kind, stale.header.sequence) = (Kind::Refusal.code(), 1);
        vec![stale, packet]
    };
    let candidate = Altered::new(&halfrow_mock::Options::default(), alter).candidate();
    let circumstances = Circumstances { draws, ..Circumstances::default() };
    let options = RunOptions { circumstances, ..RunOptions::default() };
    let report = verify(&System::TINY.plan(), candidate, &options, &Silent).unwrap().report;
    assert_eq!(report.verdict, Verdict::Pass, "{}", report.headline());
}
