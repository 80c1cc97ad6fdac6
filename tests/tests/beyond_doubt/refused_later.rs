//! Boards whose rows are wrong and that then refuse what follows or say nothing more: what was wrong before is judged, or told.

use halfrow::result::{CheckName, Finding, Outcome};
use halfrow::run::Plan;
use halfrow::verdict::Verdict;
use halfrow_mock::Options;
use halfrow_protocol::message::{Refusal, RefusalCode};
use halfrow_protocol::{Kind, Reply};
use halfrow_tests::altered::{Altered, Passing, Toward, judge, judge_each};
use halfrow_tests::system::{System, failed_check, judge_by_plan};

/// Where COMMIT names its first frame (WIRE.md, 13).
const FIRST_FRAME: std::ops::Range<usize> = 8..10;

/// The commit that came too late is still pending when the next tables are written, so that these are refused.
#[test]
fn a_board_whose_tables_change_a_frame_late_fails() {
    let mut commits = 0;
    let plan = Plan { fail_fast: false, ..System { height: 16, radius: 40.0, ..System::TINY }.plan() };
    let altered = move |toward, mut packet: Passing| {
        if toward == Toward::Board && packet.is(Kind::Commit) {
            commits += 1;
            let first = &mut packet.payload[FIRST_FRAME];
            let frame = u16::from_le_bytes([first[0], first[1]]) + u16::from(commits > 1);
            first.copy_from_slice(&frame.to_le_bytes());
        }
        vec![packet]
    };
    let report = judge_by_plan(&plan, Altered::new(&Options::default(), altered).candidate());
    assert_eq!(failed_check(&report), Some(CheckName::Frames), "{}", report.headline());
    let Finding::GenerationWrong { row, named, committed, .. } = report.finding else {
        panic!("{}", report.headline())
    };
    assert_eq!((row, named, committed), (0, 1, 2));
}

/// `packet` with a row that takes a clock more than the board claims, if it is one.
fn late(packet: Passing) -> Passing {
    match packet.reply() {
        Some(Reply::RowOut(mut row)) => {
            (row.first_latency, row.last_latency) = (row.first_latency + 1, row.last_latency + 1);
            packet.saying(&Reply::RowOut(row))
        }
        _ => packet,
    }
}

/// The board counts that refusal, and rightly so.
#[test]
fn a_board_that_refuses_tables_after_late_rows_fails() {
    let mut is_late = false;
    let report = judge_each(&System::TINY, move |toward, packet| {
        is_late |= toward == Toward::Host && packet.is(Kind::RowOut);
        if toward == Toward::Board || !is_late || !packet.is(Kind::TableWrite) {
            return if toward == Toward::Host { late(packet) } else { packet };
        }
        let refusal = Refusal { code: RefusalCode::Busy, kind: Kind::TableWrite.code(), detail: 0 };
        packet.saying(&Reply::Refusal(refusal))
    });
    assert_eq!(failed_check(&report), Some(CheckName::Latency), "{}", report.headline());
    assert!(matches!(report.finding, Finding::LatencyWrong(_)), "{}", report.headline());
    let counters = report.checks.iter().find(|check| check.name == CheckName::Counters).unwrap();
    assert_ne!(counters.outcome, Outcome::Failed, "{}", counters.detail());
}

#[test]
fn what_was_wrong_with_rows_until_a_run_broke_off_is_told() {
    let mut rows = 0;
    let report = judge(&System::TINY, move |toward, packet| {
        rows += usize::from(toward == Toward::Host && packet.is(Kind::RowOut));
        match toward {
            Toward::Board => vec![packet],
            Toward::Host if rows > 20 => Vec::new(),
            Toward::Host => vec![late(packet)],
        }
    });
    assert_eq!(report.verdict(), Verdict::Error, "{}", report.headline());
    let told = "and the run broke off before that was looked into: ";
    assert!(report.headline().contains(told), "{}", report.headline());
}
