//! What is looked at once more, in another session: what no link brings about is not, and of two looks the one that says more stands.

use halfrow::progress::Silent;
use halfrow::result::{CheckName, Counter, Finding, Report, SoakLength};
use halfrow::run::{AtSpeed, Plan, RunOptions, verify};
use halfrow::verdict::{Cause, Verdict};
use halfrow_mock::Options;
use halfrow_protocol::message::{Refusal, RefusalCode};
use halfrow_protocol::{Kind, Reply, Request};
use halfrow_tests::altered::{Altered, Passing, Toward, judge, judge_each};
use halfrow_tests::system::System;

use crate::by_the_rules::altering;
use crate::conduct::fails;

/// In the first session alone: in another one all would be right.
#[test]
fn counters_that_contradict_each_other_are_not_looked_at_again() {
    let mut greetings = 0;
    let report = judge_each(&System::TINY, move |toward, packet| {
        greetings += usize::from(toward == Toward::Board && packet.is(Kind::Hello));
        match packet.reply() {
            Some(Reply::Status(mut status)) if greetings == 1 => {
                (status.crc_errors, status.refusals, status.foreign_packets) = (1, 4242, 55);
                packet.saying(&Reply::Status(status))
            }
            _ => packet,
        }
    });
    fails(&report, CheckName::Counters, "packets that came to it; the right number is at least");
}

/// The report on a board that counts a row too many, over a link that loses what acknowledges rows in so many sessions. Nobody misses
/// that.
fn acknowledged_in_vain(sessions: usize) -> Report {
    let mut greetings = 0;
    judge(&System::TINY, move |toward, packet| {
        greetings += usize::from(toward == Toward::Board && packet.is(Kind::Hello));
        let is_lost = toward == Toward::Board && packet.is(Kind::RowAck) && greetings <= sessions;
        match packet.reply() {
            _ if is_lost => Vec::new(),
            Some(Reply::Status(mut status)) if status.rows_in > 0 => {
                status.rows_in += 1;
                vec![packet.saying(&Reply::Status(status))]
            }
            _ => vec![packet],
        }
    })
}

#[test]
fn counters_are_no_fault_where_the_board_counts_fewer_packets_than_were_sent() {
    let report = acknowledged_in_vain(1);
    assert!(
        matches!(report.finding, Finding::CounterWrong { counter: Counter::RowsIn, .. }),
        "{:?}",
        report.finding
    );
    assert_eq!(report.verdict(), Verdict::Fail, "{}", report.headline());
    let report = acknowledged_in_vain(usize::MAX);
    assert!(matches!(report.finding, Finding::WrongOverDoubtfulLink { .. }), "{:?}", report.finding);
    assert_eq!((report.verdict(), report.cause), (Verdict::Error, Cause::Station), "{}", report.headline());
}

/// What is wrong in a session.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Wrong {
    /// A bit of each row.
    Rows,
    /// The answer to CONFIGURE, which refuses it.
    Answer,
}

/// The report on a board that is wrong in this in one session after the other, over a link that brings the first CONFIGURE of a session
/// twice where that is said.
fn wrong_by_turns(sessions: &'static [(Wrong, bool)]) -> Report {
    let (mut session, mut is_first) = (None, true);
    judge(&System::TINY, move |toward, packet| {
        if toward == Toward::Board && packet.is(Kind::Hello) {
            (session, is_first) = (Some(session.map_or(0, |session: usize| session + 1)), true);
        }
        let Some(&(wrong, twice)) = session.and_then(|session| sessions.get(session)) else {
            return vec![packet];
        };
        let is_setting = packet.is(Kind::Configure);
        if toward == Toward::Board {
            let is_doubled = is_setting && is_first && twice;
            is_first &= !is_setting;
            return is_doubled.then(|| packet.clone()).into_iter().chain([packet]).collect();
        }
        match packet.reply() {
            Some(Reply::RowOut(_)) if wrong == Wrong::Rows => {
                vec![packet.with_row(|_, packed| packed[0] ^= 1)]
            }
            _ if is_setting && wrong == Wrong::Answer => {
                let refusal = Refusal { code: RefusalCode::Busy, kind: Kind::Configure.code(), detail: 0 };
                let mut refused = packet.saying(&Reply::Refusal(refusal));
                refused.header.kind = Kind::Refusal.code();
                vec![refused]
            }
            _ => vec![packet],
        }
    })
}

#[test]
fn a_refusal_over_a_link_that_doubts_is_no_end_of_looking() {
    use Wrong::{Answer, Rows};
    let report = wrong_by_turns(&[(Rows, true), (Answer, true), (Rows, false)]);
    assert!(matches!(report.finding, Finding::SamplesDiffer { .. }), "{}", report.headline());
    assert_eq!(report.verdict(), Verdict::Fail, "{}", report.headline());
}

#[test]
fn a_refusal_says_less_than_rows_that_differ() {
    use Wrong::{Answer, Rows};
    let report = wrong_by_turns(&[(Rows, true), (Answer, true), (Answer, true), (Answer, true)]);
    let Finding::WrongOverDoubtfulLink { found, .. } = &report.finding else {
        panic!("{}", report.headline())
    };
    assert!(matches!(**found, Finding::SamplesDiffer { .. }), "{}", report.headline());
    assert_eq!(report.verdict(), Verdict::Error, "{}", report.headline());
}

/// The link brings the first BURST twice, and in the third burst one frame is another, once.
#[test]
fn what_a_link_did_to_one_burst_casts_no_doubt_on_a_later_one() {
    let (mut bursts, mut is_spoilt) = (Vec::new(), false);
    let board = Altered::new(
        &Options { pixel_clock: 10_000, ..Options::default() },
        move |toward, packet: Passing| {
            if let (Toward::Board, Some(Request::Burst(burst))) = (toward, packet.request()) {
                let is_first = bursts.is_empty();
                if !bursts.contains(&burst.burst) {
                    bursts.push(burst.burst);
                }
                return is_first.then(|| packet.clone()).into_iter().chain([packet]).collect();
            }
            if toward == Toward::Board || bursts.len() != 3 || is_spoilt {
                return vec![packet];
            }
            vec![packet.with_records(|_, records| {
                records.iter_mut().take(1).for_each(|record| {
                    record.signature ^= 1;
                    is_spoilt = true;
                });
            })]
        },
    );
    let soak = AtSpeed::Soak(SoakLength::Frames { frames: 4000 });
    let plan = Plan { at_speed: soak, fail_fast: false, ..System::TINY.plan() };
    let report = verify(&plan, board.candidate(), &RunOptions::default(), &Silent).unwrap().report;
    assert_eq!(report.verdict(), Verdict::Fail, "{}", report.headline());
    assert_eq!(report.soak.map(|soak| soak.wrong), Some(1));
}

/// The link brings the first CONFIGURE twice. The board says once that it has not cleared a counter, and is then right about it, but
/// wrong in every row until the next session.
#[test]
fn what_is_right_when_it_is_tried_again_leaves_no_certainty_behind() {
    let (mut configured, mut slips, mut is_over) = (false, 0, false);
    let report = altering(move |toward, packet| {
        if toward == Toward::Board {
            is_over |= slips > 1 && packet.is(Kind::Hello);
            // STATUS clears with any number but 0; the rules send another one than 1.
            let clears = packet.is(Kind::Status) && packet.payload.first().is_some_and(|&clear| clear > 1);
            slips += usize::from(slips == 0 && clears);
            let is_first = packet.is(Kind::Configure) && !std::mem::replace(&mut configured, true);
            return is_first.then(|| packet.clone()).into_iter().chain([packet]).collect();
        }
        match packet.reply() {
            // The first one tells the counters as they were.
            Some(Reply::Status(mut status)) if slips == 1 && status.rows_in == 0 => {
                slips += 1;
                status.rows_in = 1;
                vec![packet.saying(&Reply::Status(status))]
            }
            Some(Reply::RowOut(_)) if slips > 1 && !is_over => {
                vec![packet.with_row(|_, packed| packed[0] ^= 1)]
            }
            _ => vec![packet],
        }
    });
    assert!(matches!(report.finding, Finding::RightInAnotherSession { .. }), "{:?}", report.finding);
    assert_eq!((report.verdict(), report.cause), (Verdict::Error, Cause::Station), "{}", report.headline());
}
