//! Rows that do not come back: the board's fault only when the board itself says so.

use halfrow::link::{Candidate, Link};
use halfrow::result::{CheckName, Finding, MissingRow, Outcome, Report};
use halfrow::verdict::{Cause, Verdict};
use halfrow_mock::Options;
use halfrow_protocol::message::Status;
use halfrow_protocol::{Kind, Reply};
use halfrow_tests::altered::{Altered, Passing, Toward, judge};
use halfrow_tests::system::System;
use halfrow_tests::through::Through;

/// Whether the packet is this row of any frame.
fn is_row_out(packet: &Passing, row: u16) -> bool {
    matches!(packet.reply(), Some(Reply::RowOut(found)) if found.place.row == row)
}

fn row_of_request(packet: &Passing) -> Option<u16> {
    // After the row sequence number and the frame.
    packet.is(Kind::RowIn).then(|| u16::from_le_bytes([packet.payload[6], packet.payload[7]]))
}

#[test]
fn a_board_that_swallows_rows_fails() {
    for row in [0, 3, 7] {
        let report = System::TINY.judge(&format!(",fault=lost-row,row={row}"));
        assert_eq!(report.verdict(), Verdict::Fail, "{}", report.headline());
        let sentence = format!("row {row} of frame 0 went into the board and never came out");
        assert!(report.headline().contains(&sentence), "{}", report.headline());
    }
}

/// The link loses them, or a front end: the board counts that it sent the row again each time.
#[test]
fn rows_that_the_board_says_it_sent_are_lost_behind_it() {
    for row in [0, 3, 7] {
        let report = judge(&System::TINY, move |toward, packet| {
            let lost = toward == Toward::Host && is_row_out(&packet, row);
            if lost { Vec::new() } else { vec![packet] }
        });
        assert_eq!(report.verdict(), Verdict::Error, "{}", report.headline());
        assert!(report.headline().contains(&format!("row {row} of frame 0")), "{}", report.headline());
    }
}

/// A row's second half leaves while the next one enters (WIRE.md, 5), so the row before a lost one does not come back either.
#[test]
fn rows_that_never_reach_the_board_are_lost_in_front_of_it() {
    for (row, missing) in [(0, 0), (3, 2), (7, 6)] {
        let report = judge(&System::TINY, move |toward, packet| {
            let lost = toward == Toward::Board && row_of_request(&packet) == Some(row);
            if lost { Vec::new() } else { vec![packet] }
        });
        assert_eq!(report.verdict(), Verdict::Error, "{}", report.headline());
        let alone = MissingRow { row: missing, frame: 0, waits_for: Some(row.into()) };
        assert_eq!(report.finding, Finding::RowLostEachTime(alone), "{}", report.headline());
    }
}

/// Row 3 stays inside the board when row 4 never reaches it, and the board is right to say that it does not need row 3 again.
#[test]
fn a_row_that_waits_for_its_successor_is_not_swallowed() {
    let mut copies = 0;
    let report = judge(&System::TINY, move |toward, packet| match row_of_request(&packet) {
        Some(4) if toward == Toward::Board => Vec::new(),
        // The counts of packets still agree.
        Some(3) if toward == Toward::Board => {
            copies += 1;
            if copies % 2 == 0 { vec![packet.clone(), packet] } else { vec![packet] }
        }
        _ => vec![packet],
    });
    assert_eq!(report.verdict(), Verdict::Error, "{}", report.headline());
}

/// The link changes the window in what the board sends, so that row 4 is never sent, and all counts agree.
#[test]
fn a_row_whose_successor_was_not_let_in_is_not_swallowed() {
    let mut window = u32::MAX;
    let report = judge(&System::TINY, move |toward, mut packet| {
        match toward {
            Toward::Board if packet.is(Kind::Reset) => window = u32::MAX,
            Toward::Board if row_of_request(&packet) == Some(3) => {
                window = u32::from_le_bytes(packet.payload[..4].try_into().unwrap()) + 1;
            }
            Toward::Board => {}
            Toward::Host => packet.header.window = packet.header.window.min(window),
        }
        vec![packet]
    });
    assert_eq!(report.verdict(), Verdict::Error, "{}", report.headline());
    assert!(report.headline().contains("row 3 of frame 0"), "{}", report.headline());
}

/// The report on a sound board whose row 3 never leaves its front end, after `change` was made to its counters. To the host it
/// looks like a swallowed row.
fn withheld(change: fn(&mut Status)) -> Report {
    judge(&System::TINY, move |_, packet| withhold(packet, change))
}

fn withhold(packet: Passing, change: fn(&mut Status)) -> Vec<Passing> {
    withhold_row(3, packet, change)
}

fn withhold_row(row: u16, packet: Passing, change: fn(&mut Status)) -> Vec<Passing> {
    match packet.reply() {
        Some(Reply::Status(mut status)) => {
            (status.rows_repeated, status.rows_unneeded) = (0, 3);
            change(&mut status);
            vec![packet.saying(&Reply::Status(status))]
        }
        Some(Reply::RowOut(out)) if out.place.row == row => Vec::new(),
        _ => vec![packet],
    }
}

/// Counters are cleared before a row is played again.
#[test]
fn a_packet_that_came_twice_before_excuses_no_board_that_swallows_rows() {
    let mut is_doubled = false;
    let report = judge(&System::TINY, move |toward, packet| {
        let is_echo = toward == Toward::Board && packet.is(Kind::Echo);
        if is_echo && !std::mem::replace(&mut is_doubled, true) {
            return vec![packet.clone(), packet];
        }
        withhold(packet, |_| {})
    });
    assert_eq!(report.verdict(), Verdict::Fail, "{}", report.headline());
}

/// A link that adds bytes that are no packet to everything that it brings.
fn noisy(link: Box<dyn Link>) -> Box<dyn Link> {
    Through::boxed(link, |link, out, back, wait| {
        let taken = link.exchange(out, back, wait)?;
        if !back.is_empty() {
            back.extend([3, 7, 9, 0]);
        }
        Ok(taken)
    })
}

/// The damaged packet may have been the row.
#[test]
fn a_row_is_not_swallowed_where_packets_come_damaged() {
    let candidate = Altered::new(&Options::default(), |_, packet| withhold(packet, |_| {})).candidate();
    let report = System::TINY.judge_candidate(Candidate { link: noisy(candidate.link), ..candidate });
    assert_eq!(report.verdict(), Verdict::Error, "{}", report.headline());
    assert!(report.headline().contains("row 3 of frame 0"), "{}", report.headline());
    assert!(report.link.damaged_in > 0);
}

type Denial = fn(&mut Status);

/// Each denial takes back one of the board's statements that FAIL needs.
#[test]
fn a_row_that_the_board_does_not_admit_to_is_no_fail() {
    let admitted = withheld(|_| {});
    assert_eq!(admitted.verdict(), Verdict::Fail, "{}", admitted.headline());
    let denials: [(&str, Denial); 8] = [
        ("it did not take it", |status| status.rows_in = status.rows_in.saturating_sub(1)),
        ("it waits for it", |status| status.next_row_in = status.next_row_out),
        ("it sent it again", |status| status.rows_repeated += 1),
        ("it brought it out", |status| status.rows_unneeded = 0),
        ("it was acknowledged", |status| status.next_row_out += 1),
        ("packets are missing", |status| status.packets = status.packets.saturating_sub(1)),
        ("packets were damaged", |status| status.crc_errors += 1),
        ("packets were another host's", |status| status.foreign_packets += 1),
    ];
    for (what, denial) in denials {
        let report = withheld(denial);
        assert_eq!(report.verdict(), Verdict::Error, "{what}: {}", report.headline());
    }
}

/// It comes as soon as the host has dropped it and plays its frame again.
#[test]
fn a_row_that_comes_when_its_frame_is_played_again_was_lost_on_the_way() {
    let (mut lost, mut is_over) = (0, false);
    let report = judge(&System::TINY, move |toward, packet| {
        is_over |= lost > 0 && toward == Toward::Board && packet.is(Kind::Reset);
        let loses = !is_over && toward == Toward::Host && is_row_out(&packet, 3);
        lost += usize::from(loses);
        if loses { Vec::new() } else { vec![packet] }
    });
    assert_eq!((report.verdict(), report.cause), (Verdict::Error, Cause::Station), "{}", report.headline());
    assert_eq!(report.finding, Finding::RowLostOnce { row: 3, frame: 0 });
}

/// A board that says something else than it is asked is asked in vain what became of the row.
#[test]
fn a_row_is_not_swallowed_where_echoes_come_back_otherwise() {
    let mut is_lost = false;
    let report = judge(&System::TINY, move |toward, mut packet| {
        is_lost |= toward == Toward::Host && is_row_out(&packet, 3);
        if is_lost && toward == Toward::Host && packet.is(Kind::Echo) {
            packet.payload[0] ^= 1;
        }
        withhold(packet, |_| {})
    });
    assert_eq!(report.verdict(), Verdict::Error, "{}", report.headline());
    assert_eq!(report.finding, Finding::RowLostAmongOthers { row: 3, frame: 0 });
}

/// What comes twice or late may have come in place of the row, too.
#[test]
fn a_row_is_not_swallowed_where_answers_come_twice() {
    let report = judge(&System::TINY, move |toward, packet| {
        if toward == Toward::Host && packet.is(Kind::Echo) {
            return vec![packet.clone(), packet];
        }
        withhold(packet, |_| {})
    });
    assert_eq!(report.verdict(), Verdict::Error, "{}", report.headline());
    assert_eq!(report.finding, Finding::RowLostAmongOthers { row: 3, frame: 0 });
}

/// The link spoils the echoes beside it the first time that its frame is played again.
#[test]
fn a_row_that_was_once_missing_beside_other_trouble_is_not_said_to_be_lost_alone_each_time() {
    let (mut lost, mut spoilt) = (0, 0);
    let report = judge(&System::TINY, move |toward, mut packet| {
        lost += u32::from(toward == Toward::Host && is_row_out(&packet, 3));
        if lost > 0 && spoilt < 8 && toward == Toward::Host && packet.is(Kind::Echo) {
            spoilt += 1;
            packet.payload[0] ^= 1;
        }
        withhold(packet, |status| status.rows_unneeded = 0)
    });
    assert_eq!(report.verdict(), Verdict::Error, "{}", report.headline());
    assert_eq!(report.finding, Finding::RowLostAmongOthers { row: 3, frame: 0 });
}

/// A row that is asked for is not answered if the board has let it go, so nobody misses it: what is lost so may have been the row.
#[test]
fn a_row_is_not_swallowed_where_packets_are_missing_of_which_nobody_hears() {
    let (mut is_lost, mut is_asked) = (false, false);
    let report = judge(&System::TINY, move |toward, packet| {
        is_lost |= toward == Toward::Host && is_row_out(&packet, 3);
        if toward == Toward::Board {
            is_asked = (is_asked || is_lost && packet.is(Kind::Echo)) && !packet.is(Kind::Reset);
            if is_asked && row_of_request(&packet) == Some(3) {
                return Vec::new();
            }
        }
        withhold(packet, |_| {})
    });
    assert_eq!(report.verdict(), Verdict::Error, "{}", report.headline());
    let alone = MissingRow { row: 3, frame: 0, waits_for: None };
    assert_eq!(report.finding, Finding::RowLostEachTime(alone));
}

/// The report on a board that withholds `row` of each frame, and whose other rows that are `meant` take a clock more than claimed.
fn withheld_and_late(row: u16, meant: fn(u16) -> bool) -> Report {
    judge(&System::TINY, move |_, packet| {
        let mut packets = withhold_row(row, packet, |_| {});
        for packet in &mut packets {
            if let Some(Reply::RowOut(mut out)) = packet.reply()
                && meant(out.place.row)
            {
                (out.first_latency, out.last_latency) = (out.first_latency + 1, out.last_latency + 1);
                *packet = packet.saying(&Reply::RowOut(out));
            }
        }
        packets
    })
}

/// One register too many: after a frame's last row the player stops before its last sample is out.
#[test]
fn the_last_row_of_a_frame_whose_rows_are_all_late_is_lost_to_the_latency() {
    let last = System::TINY.height as u16 - 1;
    let report = withheld_and_late(last, |_| true);
    assert_eq!(report.verdict(), Verdict::Fail, "{}", report.headline());
    let Finding::LatencyWrong(late) = &report.finding else { panic!("{}", report.headline()) };
    // W/2 + 12 of the mock, and one.
    assert_eq!((late.first, late.last, late.claimed), (45, 45, 44));
    assert!(report.remedy().unwrap().starts_with("Check the depth of the pipeline"), "{report:?}");
    let frames = report.checks.iter().find(|check| check.name == CheckName::Frames).unwrap();
    assert_eq!(frames.outcome, Outcome::Failed);
    assert_eq!(frames.finding, Finding::RowSwallowed { row: last, frame: 0, again: last });
    assert_eq!(halfrow::report::wording::differences(&report, &report.frames[0]), "incomplete");
}

/// Neither another row nor some late rows show where the player stops.
#[test]
fn a_row_is_swallowed_where_the_latency_does_not_explain_it() {
    let last = System::TINY.height as u16 - 1;
    for (row, meant) in [(3, (|_| true) as fn(u16) -> bool), (last, |row| row % 2 == 0), (last, |_| false)] {
        let report = withheld_and_late(row, meant);
        assert_eq!(report.verdict(), Verdict::Fail, "{}", report.headline());
        assert_eq!(report.finding, Finding::RowSwallowed { row, frame: 0, again: row });
    }
}
