//! Boards that are sound except in what they look at first, or in looking at what they must ignore.

use halfrow::board::RefusalCode;
use halfrow::result::{Report, Rule};
use halfrow::verdict::{Cause, Verdict};
use halfrow_protocol::message::{Refusal, ResetLevel};
use halfrow_protocol::{Kind, Reply};
use halfrow_tests::altered::{Passing, Toward};

use super::by_the_rules::{altering_each, broken, refusal, refusing};

/// Bytes of a row's place, and where its number, width, flags and generation are (WIRE.md, 20).
const PLACE: usize = 12;
const WIDTH: std::ops::Range<usize> = 8..10;
const FLAGS: usize = 10;
const GENERATION: usize = 11;

/// The report on a board that refuses the packets that `are_meant` with `code`, and looks at nothing of them but their window.
fn refusing_instead(
    mut are_meant: impl FnMut(&Passing) -> bool + Send + 'static,
    code: RefusalCode,
) -> Report {
    let mut meant = None;
    altering_each(move |toward, packet| match toward {
        Toward::Board if are_meant(packet) => {
            meant = Some((packet.header.sequence, packet.header.kind));
            // No board carries this out.
            packet.header.kind = Kind::RowOut.code();
        }
        Toward::Board => {}
        Toward::Host => {
            if let Some((_, kind)) = meant.filter(|meant| meant.0 == packet.header.sequence)
                && refusal(packet).is_some()
            {
                *packet = packet.saying(&Reply::Refusal(Refusal { code, kind, detail: 0 }));
            }
        }
    })
}

fn is_row_with(packet: &Passing, is_meant: impl FnOnce(&[u8]) -> bool) -> bool {
    packet.is(Kind::RowIn) && packet.payload.len() > PLACE && is_meant(&packet.payload)
}

/// Whether it is a row that is in its place and has what a board must ignore.
fn is_marked_in_place(packet: &Passing) -> bool {
    let is_marked = |row: &[u8]| row[FLAGS] & !1 != 0 && row[GENERATION] != 0;
    // Rows that must be refused are black, and a byte follows their samples.
    let is_black = |row: &[u8]| row[PLACE..row.len() - 1].iter().all(|&byte| byte == 0);
    is_row_with(packet, |row| is_marked(row) && !is_black(row))
}

/// No frame of the run has the width of this one.
fn is_row_of_66(packet: &Passing) -> bool {
    is_row_with(packet, |row| row[WIDTH] == [66, 0])
}

#[test]
fn the_unused_bits_of_a_row_that_is_in_place_are_ignored() {
    assert_eq!(broken(&refusing_instead(is_marked_in_place, RefusalCode::Row)).0, Rule::Skipped);
}

/// Any other row of 66 samples must be refused so.
#[test]
fn that_a_row_is_known_comes_before_its_width() {
    assert_eq!(broken(&refusing_instead(is_row_of_66, RefusalCode::Row)).0, Rule::Banks);
}

/// A host that stood still may have lost it.
#[test]
fn a_board_that_refuses_a_row_since_it_has_lost_its_session_breaks_no_rule() {
    for meant in [is_marked_in_place, is_row_of_66] {
        let report = refusing_instead(meant, RefusalCode::Session);
        assert_eq!((report.verdict(), report.cause), (Verdict::Error, Cause::Station));
        assert!(report.headline().contains("no longer knows this session"), "{}", report.headline());
    }
}

#[test]
fn credit_comes_before_what_a_board_without_tables_lacks() {
    let mut has_tables = true;
    let report = altering_each(move |toward, packet| {
        let (wipes, code) = (ResetLevel::Tables as u8, RefusalCode::NotReady);
        if toward == Toward::Board {
            has_tables &= !packet.is(Kind::Reset) || packet.payload.first() != Some(&wipes);
        } else if packet.is(Kind::Commit) {
            has_tables = true;
        } else if let Some(refusal) = refusal(packet)
            && refusal.code == RefusalCode::Credit
            && !has_tables
        {
            *packet = packet.saying(&Reply::Refusal(Refusal { code, ..refusal }));
        }
    });
    assert_eq!(broken(&report).0, Rule::Credit);
}

/// Where COMMIT names its generation, and the bytes of one with a shape (WIRE.md, 13).
const NEW_GENERATION: usize = 10;
const COMMIT: usize = 13;

#[test]
fn that_there_is_no_configuration_comes_before_the_generation() {
    let is_unnamed = |commit: &[u8]| commit.get(NEW_GENERATION) == Some(&0);
    assert_eq!(broken(&refusing(Kind::Commit, is_unnamed, RefusalCode::Range)).0, Rule::NotReady);
}

#[test]
fn a_byte_after_a_commit_is_ignored() {
    let is_longer = |commit: &[u8]| commit.len() > COMMIT;
    assert_eq!(broken(&refusing(Kind::Commit, is_longer, RefusalCode::Payload)).0, Rule::Skipped);
}

#[test]
fn a_byte_in_an_acknowledgement_is_ignored() {
    let is_longer = |packet: &Passing| packet.is(Kind::RowAck) && !packet.payload.is_empty();
    assert_eq!(broken(&refusing_instead(is_longer, RefusalCode::Payload)).0, Rule::Unanswered);
}
