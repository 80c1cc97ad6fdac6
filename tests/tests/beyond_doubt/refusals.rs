//! Boards that refuse what they must carry out: never FAIL, since another host or an old request may be the reason, and never
//! called the station's fault where only the board can be at fault.

use halfrow::result::{CheckName, Finding, Report};
use halfrow::verdict::{Cause, Verdict};
use halfrow_protocol::message::{Refusal, RefusalCode};
use halfrow_protocol::{Kind, Reply};
use halfrow_tests::altered::{Passing, Toward, judge_each};
use halfrow_tests::system::{System, failed_check};

/// The report on a board that refuses each request of `kind`.
fn refusing(kind: Kind, code: RefusalCode) -> Report {
    judge_each(&System::TINY, move |toward, packet: Passing| {
        if toward == Toward::Board || !packet.is(kind) {
            return packet;
        }
        packet.saying(&Reply::Refusal(Refusal { code, kind: kind.code(), detail: 0 }))
    })
}

#[test]
fn a_refusal_of_what_a_board_says_that_it_can_is_its_own() {
    let own = "its capabilities allow that";
    let passing = "run again, and if it refuses each time";
    for (kind, code, cause, said) in [
        (Kind::Configure, RefusalCode::Range, Cause::Refused, own),
        (Kind::TableWrite, RefusalCode::Taps, Cause::Refused, own),
        (Kind::TableCrc, RefusalCode::Range, Cause::Refused, own),
        (Kind::Status, RefusalCode::Kind, Cause::Refused, "every board must answer it"),
        (Kind::Burst, RefusalCode::Kind, Cause::Refused, own),
        (Kind::Burst, RefusalCode::Range, Cause::Refused, own),
        (Kind::Commit, RefusalCode::Payload, Cause::Refused, own),
        (Kind::Commit, RefusalCode::NotReady, Cause::Station, passing),
        (Kind::Commit, RefusalCode::Range, Cause::Station, passing),
        (Kind::Configure, RefusalCode::Busy, Cause::Station, "stop whatever else feeds the board's core"),
        (Kind::Configure, RefusalCode::Session, Cause::Station, "run again"),
    ] {
        let report = refusing(kind, code);
        let what = format!("{kind}, {code}: {}", report.headline());
        assert_eq!((report.verdict(), report.cause), (Verdict::Error, cause), "{what}");
        assert!(report.headline().contains(said), "{what}");
    }
}

/// It has read back what was uploaded, through every port, and computes another CRC of it when that is committed.
#[test]
fn tables_that_only_a_commit_finds_wrong_are_the_board_s_fault() {
    let report = refusing(Kind::Commit, RefusalCode::TableCrc);
    assert_eq!((report.verdict(), failed_check(&report)), (Verdict::Fail, Some(CheckName::ReadBack)));
    assert_eq!(report.finding, Finding::CommitCrcWrong {});
}
