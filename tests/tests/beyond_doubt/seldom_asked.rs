//! Boards that are wrong only in what no host asks: each breaks one rule, which the smallest run with the rules finds.

use halfrow::board::RefusalCode;
use halfrow::result::{Answer, Counter, Rule};
use halfrow_protocol::message::{Status, TrappedRow};
use halfrow_protocol::{Kind, Reply};
use halfrow_tests::altered::Toward;

use super::by_the_rules::{altering_each, answering, broken, miscounted, refusing};

/// The width of a row (WIRE.md, 20).
fn width(row: &[u8]) -> usize {
    row.get(8..10).map_or(0, |width| usize::from(u16::from_le_bytes([width[0], width[1]])))
}

/// A board that takes what is missing for zeros would look at the window next.
#[test]
fn a_row_without_its_last_byte_is_cut_short_also_where_there_is_no_credit() {
    let report = refusing(Kind::RowIn, |row| row.len() < 12 + width(row) / 2 * 3, RefusalCode::Credit);
    assert_eq!(broken(&report).0, Rule::Payload, "{}", report.headline());
}

#[test]
fn a_row_of_an_odd_width_is_out_of_place() {
    let report = refusing(Kind::RowIn, |row| width(row) % 2 == 1, RefusalCode::Payload);
    assert_eq!(broken(&report).0, Rule::RowPlace, "{}", report.headline());
}

#[test]
fn a_status_says_whether_it_clears() {
    let report = answering(Kind::Status, <[u8]>::is_empty, |packet| {
        *packet = packet.saying(&Reply::Status(Status::default()));
    });
    assert_eq!(broken(&report).0, Rule::Payload, "{}", report.headline());
}

#[test]
fn a_status_that_clears_tells_what_was_counted_before() {
    let report = answering(
        Kind::Status,
        |payload| payload == [0x80],
        |packet| *packet = packet.saying(&Reply::Status(Status::default())),
    );
    assert_eq!(miscounted(&report), Counter::RowsIn);
}

#[test]
fn half_a_shape_is_none() {
    let report = refusing(Kind::Commit, |commit| commit.len() == 12, RefusalCode::TableCrc);
    assert_eq!(broken(&report).0, Rule::Skipped, "{}", report.headline());
}

/// The bank of a span (WIRE.md, 10).
const BANK: usize = 1;

/// The other bank must hold what was active before.
#[test]
fn a_commit_makes_the_banks_change_places() {
    let (mut generation, mut has_changed, mut asked) = (0, false, None);
    let report = altering_each(move |toward, packet| {
        if toward == Toward::Board {
            has_changed &= !packet.is(Kind::TableWrite) && !packet.is(Kind::Reset);
            let is_of_shadow = packet.is(Kind::TableCrc) && packet.payload.get(BANK) == Some(&0);
            asked = (has_changed && is_of_shadow).then_some(packet.header.sequence);
        } else if let Some(Reply::RowOut(row)) = packet.reply() {
            has_changed |= std::mem::replace(&mut generation, row.generation) != row.generation;
        } else if asked == Some(packet.header.sequence) && packet.is(Kind::TableCrc) {
            packet.payload[0] ^= 1;
        }
    });
    assert_eq!(broken(&report).0, Rule::CommitFrame, "{}", report.headline());
}

/// The versions in a HELLO (WIRE.md, 00).
const VERSIONS: std::ops::Range<usize> = 8..10;

#[test]
fn a_host_that_speaks_no_version_of_the_boards_gets_no_session() {
    let report = altering_each(|toward, packet| {
        if toward == Toward::Board && packet.is(Kind::Hello) {
            packet.payload[VERSIONS].fill(1);
        }
    });
    assert_eq!(broken(&report).0, Rule::NewSession, "{}", report.headline());
}

#[test]
fn a_reset_to_a_smaller_number_takes_the_window_down() {
    let report = answering(
        Kind::Reset,
        |reset| reset.get(1..5) == Some(&(3_u32 << 29).to_le_bytes()),
        |packet| packet.header.window = 1 << 31,
    );
    let (rule, right, found) = broken(&report);
    assert_eq!((rule, right), (Rule::Window, &Answer::Credit { rows: 4 }), "{}", report.headline());
    assert_eq!(found, &Answer::Credit { rows: 1 << 29 });
}

/// The frames of a BURST and its mode (WIRE.md, 30).
const FRAMES: std::ops::Range<usize> = 4..8;
const MODE: usize = 16;

#[test]
fn every_bit_of_a_number_of_frames_counts() {
    for bytes in [2, 3] {
        let report = altering_each(move |toward, packet| {
            if toward == Toward::Board
                && packet.is(Kind::Burst)
                && packet.payload.get(FRAMES) != Some(&[!0; 4])
            {
                packet.payload[FRAMES][bytes..].fill(0);
            }
        });
        assert_eq!(broken(&report).0, Rule::Ended, "{}", report.headline());
    }
}

#[test]
fn rows_of_a_burst_are_in_no_counter() {
    let (mut of_bursts, mut clears) = (0, false);
    let report = altering_each(move |toward, packet| {
        if toward == Toward::Board {
            of_bursts += 4 * u32::from(packet.is(Kind::Burst));
            clears = packet.is(Kind::Status) && packet.payload != [0];
        } else if let Some(Reply::Status(status)) = packet.reply() {
            let rows_out = status.rows_out + of_bursts;
            *packet = packet.saying(&Reply::Status(Status { rows_out, ..status }));
            of_bursts = if clears { 0 } else { of_bursts };
        }
    });
    assert_eq!(miscounted(&report), Counter::RowsOut);
}

#[test]
fn a_burst_that_sets_no_trap_leaves_what_is_in_it() {
    let mut mode = 0;
    let report = altering_each(move |toward, packet| {
        if toward == Toward::Board && packet.is(Kind::Burst) && packet.payload.len() > MODE {
            mode = packet.payload[MODE];
        }
        if matches!(packet.reply(), Some(Reply::Trap(Some(_)))) && toward == Toward::Host && mode == 0 {
            *packet = packet.saying(&Reply::Trap(None));
        }
    });
    assert_eq!(broken(&report).0, Rule::Trap, "{}", report.headline());
}

#[test]
fn what_is_expected_of_rows_stays_when_a_session_ends() {
    let mut is_told = false;
    let report = altering_each(move |toward, packet| {
        is_told = packet.is(Kind::Expect) || is_told && !packet.is(Kind::Hello);
        if let Some(Reply::Trap(Some(kept))) = packet.reply()
            && toward == Toward::Host
            && !is_told
        {
            let packed = kept.packed.to_vec();
            *packet = packet.saying(&Reply::Trap(Some(TrappedRow { row: 0, packed: &packed, ..kept })));
        }
    });
    assert_eq!(broken(&report).0, Rule::Trap, "{}", report.headline());
}
