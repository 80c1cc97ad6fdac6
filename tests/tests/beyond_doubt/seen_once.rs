//! What a board has said in a whole packet stands, whatever the link does afterwards.

use halfrow::result::{BurstCount, CheckName, Finding, Report};
use halfrow::verdict::Verdict;
use halfrow_protocol::{Kind, Reply};
use halfrow_tests::altered::{Passing, Toward, judge, judge_each};
use halfrow_tests::system::System;

/// The report on a board whose packet number `place` of `kind`, from 0, is altered, and whose packets of the kind `lost` are all
/// lost after that one.
fn altered_once(
    kind: Kind,
    place: usize,
    alter: impl Fn(&mut Vec<u8>) + Send + 'static,
    lost: Kind,
) -> Report {
    let mut count = 0;
    judge(&System::TINY, move |toward, mut packet: Passing| {
        if toward == Toward::Board {
            return vec![packet];
        }
        if count > place && packet.is(lost) {
            return Vec::new();
        }
        if packet.is(kind) && !matches!(packet.reply(), Some(Reply::Refusal(_)) | None) {
            if count == place {
                alter(&mut packet.payload);
            }
            count += 1;
        }
        vec![packet]
    })
}

/// The report on a board whose first record is altered in this byte, and no other record comes.
fn altered_record(byte: usize) -> Report {
    // A record has 18 bytes. The packet's own fields before it have ten, the last of which is the count of records.
    let first_alone = move |payload: &mut Vec<u8>| {
        payload.truncate(28);
        payload[9] = 1;
        payload[10 + byte] ^= 1;
    };
    altered_once(Kind::Records, 0, first_alone, Kind::Records)
}

/// A record begins with its signature.
#[test]
fn a_frame_that_was_wrong_at_speed_fails_though_no_record_comes_after_it() {
    let report = altered_record(0);
    assert_eq!(report.verdict(), Verdict::Fail, "{}", report.headline());
    assert!(report.headline().contains("differs at speed"), "{}", report.headline());
}

/// Behind its signature stands the count of samples.
#[test]
fn a_count_that_was_wrong_at_speed_fails_though_no_record_comes_behind_it() {
    let report = altered_record(4);
    let is_told =
        matches!(report.finding, Finding::MiscountedAtSpeed { count: BurstCount::Samples, frame: 0, .. });
    assert!(report.verdict() == Verdict::Fail && is_told, "{}", report.headline());
}

#[test]
fn a_table_that_was_another_fails_though_no_entry_is_read_after_that() {
    for place in 0..4 {
        let report = altered_once(Kind::TableCrc, place, |payload| payload[0] ^= 1, Kind::TableRead);
        assert_eq!(report.verdict(), Verdict::Fail, "{place}: {}", report.headline());
        let failed = report.checks.iter().find(|check| check.name == CheckName::ReadBack).unwrap();
        assert!(failed.detail().contains("CRC"), "{place}: {}", failed.detail());
    }
}

/// Whatever they are, they are not the entries whose CRC is wrong.
#[test]
fn entries_of_another_place_name_no_defect_of_a_table() {
    // The first byte of the span's `first`, and the first one of its entries (WIRE.md, section 5).
    const FIRST: usize = 3;
    const ENTRIES: usize = 7;
    let report = judge_each(&System::TINY, |toward, mut packet: Passing| {
        let changed: &[usize] = match packet.reply() {
            Some(Reply::TableCrc(_)) if toward == Toward::Host => &[0],
            Some(Reply::TableRead(_)) if toward == Toward::Host => &[FIRST, ENTRIES],
            _ => &[],
        };
        changed.iter().for_each(|&byte| packet.payload[byte] ^= 1);
        packet
    });
    assert_eq!((report.verdict(), &report.finding), (Verdict::Fail, &Finding::TableCrcWrong {}));
}

/// What a board says under its own CRC is no fault of a link's.
#[test]
fn an_echo_that_is_another_is_the_board_s_fault() {
    // The one in front of them is empty, and tells how long an answer takes.
    for place in [1, 2] {
        let report = altered_once(Kind::Echo, place, |payload| payload[0] ^= 1, Kind::TableRead);
        assert_eq!((report.verdict(), &report.finding), (Verdict::Fail, &Finding::EchoWrong {}));
    }
}
