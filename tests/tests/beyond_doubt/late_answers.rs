//! Answers of a board to packets that came late: no sound board is blamed for them, and no broken one passes by them.

use halfrow::result::{Finding, Report};
use halfrow::verdict::{Cause, Verdict};
use halfrow_protocol::message::{Refusal, RefusalCode};
use halfrow_protocol::{Kind, Reply};
use halfrow_tests::altered::{Passing, Toward, judge};
use halfrow_tests::system::System;

use crate::stale_packets::late_copy;

/// How a report begins to ask for another bitstream.
const BLAME: &str = "load a";

fn refuses_a_row(packet: &Passing) -> bool {
    matches!(packet.reply(), Some(Reply::Refusal(refusal)) if refusal.kind == Kind::RowIn.code())
}

/// The report behind a link that delivers refusal number `which` of a row once more, before the next row that comes back.
fn late_refusal(which: usize) -> Report {
    let (mut seen, mut copy) = (0, None);
    judge(&System::TINY, move |toward, packet: Passing| {
        if toward == Toward::Board {
            return vec![packet];
        }
        let late = copy.take_if(|_| packet.is(Kind::RowOut));
        let refused = refuses_a_row(&packet);
        if refused && seen == which {
            copy = Some(packet.clone());
        }
        seen += usize::from(refused);
        late.into_iter().chain([packet]).collect()
    })
}

#[test]
fn an_old_refusal_of_a_row_is_none_of_the_rows_under_way() {
    for which in [0, 5, 30, 50] {
        let report = late_refusal(which);
        assert_eq!(report.verdict(), Verdict::Pass, "{which}: {}", report.headline());
        assert!(report.link.strays > 0, "{which}");
    }
}

/// The board refuses the copy, under the copy's number.
#[test]
fn a_refusal_of_an_old_row_is_none_of_the_rows_under_way() {
    for before in 50..55 {
        let (report, delivered) = late_copy((Kind::RowIn, 246), (Kind::RowIn, before), true);
        assert_eq!(report.verdict(), Verdict::Pass, "{before}: {}", report.headline());
        assert!(delivered, "{before}");
    }
}

#[test]
fn a_row_that_is_refused_is_not_right() {
    let mut rows = 0;
    let report = judge(&System::TINY, move |toward, packet: Passing| {
        rows += usize::from(toward == Toward::Host && packet.is(Kind::RowOut));
        if toward == Toward::Board || !packet.is(Kind::RowOut) || rows < 20 {
            return vec![packet];
        }
        let refusal = Refusal { code: RefusalCode::Row, kind: Kind::RowIn.code(), detail: 0 };
        vec![packet.saying(&Reply::Refusal(refusal))]
    });
    assert_eq!(report.verdict(), Verdict::Error, "{}", report.headline());
}

/// Both copies are answered, so that the host knows of them.
#[test]
fn an_error_that_an_old_copy_of_a_request_may_have_brought_about_is_looked_at_again() {
    for which in [(Kind::Reset, 2), (Kind::Reset, 3), (Kind::Burst, 20), (Kind::Burst, 30)] {
        for before in [(Kind::RowIn, 10), (Kind::RowIn, 30), (Kind::Records, 4)] {
            let (report, delivered) = late_copy(which, before, true);
            let what = format!("{which:?} before {before:?}: {}", report.headline());
            assert!(delivered && !report.headline().contains(BLAME), "{what}");
            assert_ne!(report.verdict(), Verdict::Fail, "{what}");
        }
    }
}

/// The report on a board that refuses CONFIGURE in the first `sessions` sessions, after an ECHO that came twice.
fn refusing(code: RefusalCode, sessions: usize) -> Report {
    let (mut greetings, mut twice) = (0, false);
    judge(&System::TINY, move |toward, packet: Passing| {
        greetings += usize::from(toward == Toward::Board && packet.is(Kind::Hello));
        if toward == Toward::Board && packet.is(Kind::Echo) && !twice {
            twice = true;
            return vec![packet.clone(), packet];
        }
        if toward == Toward::Board || !packet.is(Kind::Configure) || greetings > sessions {
            return vec![packet];
        }
        vec![packet.saying(&Reply::Refusal(Refusal { code, kind: Kind::Configure.code(), detail: 0 }))]
    })
}

#[test]
fn a_board_that_refuses_over_a_link_that_doubts_is_right_in_no_session() {
    let once = refusing(RefusalCode::Range, 1);
    assert_eq!((once.verdict(), once.cause), (Verdict::Error, Cause::Station), "{}", once.headline());
    assert!(matches!(once.finding, Finding::RightInAnotherSession { .. }), "{}", once.headline());
    assert!(!once.headline().contains(BLAME), "{}", once.headline());
    let always = refusing(RefusalCode::Range, usize::MAX);
    assert_eq!((always.verdict(), always.cause), (Verdict::Error, Cause::Refused), "{}", always.headline());
    assert!(always.headline().contains("its capabilities allow that"), "{}", always.headline());
}
