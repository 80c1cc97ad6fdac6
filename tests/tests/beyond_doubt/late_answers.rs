//! What a board says to a packet that came late: no sound board is blamed for it, and none that is broken is right.

use halfrow::result::Report;
use halfrow::verdict::Verdict;
use halfrow_protocol::message::{Refusal, RefusalCode};
use halfrow_protocol::{Kind, Reply};
use halfrow_tests::altered::{Passing, Toward, judge};
use halfrow_tests::system::System;

use crate::stale_packets::late_copy;

fn refuses_a_row(packet: &Passing) -> bool {
    matches!(packet.reply(), Some(Reply::Refusal(refusal)) if refusal.kind == Kind::RowIn.code())
}

/// The report behind a link that delivers the refusal number `which` of a row once more, in front of the next row that comes back.
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
        assert_eq!(report.verdict, Verdict::Pass, "{which}: {}", report.headline());
        assert!(report.link.strays > 0, "{which}");
    }
}

/// The board refuses the copy, under the number that it has.
#[test]
fn a_refusal_of_an_old_row_is_none_of_the_rows_under_way() {
    for before in 50..55 {
        let report = late_copy((Kind::RowIn, 246), (Kind::RowIn, before), true);
        assert_eq!(report.verdict, Verdict::Pass, "{before}: {}", report.headline());
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
        let mut refused = packet.saying(&Reply::Refusal(refusal));
        refused.header.kind = Kind::Refusal.code();
        vec![refused]
    });
    assert_eq!(report.verdict, Verdict::Error, "{}", report.headline());
}
