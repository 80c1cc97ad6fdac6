//! Boards that never answer one certain thing, or never end a packet, behind a link that loses nothing.

use std::thread;
use std::time::Duration;

use halfrow::board::{Board, OpenOptions};
use halfrow::link::Candidate;
use halfrow::link_test::{self, LinkTestError};
use halfrow::result::Report;
use halfrow::verdict::{Cause, Verdict};
use halfrow_mock::Options;
use halfrow_protocol::Kind;
use halfrow_tests::altered::{Altered, Passing, Toward, judge};
use halfrow_tests::system::{System, open};
use halfrow_tests::through::Through;

/// The report on a board that never answers the packets that are `meant`, and says so or not.
fn silent(meant: impl Fn(&Passing) -> bool + Send + 'static) -> Report {
    let mut asked = None;
    judge(&System::TINY, move |toward, packet| {
        if toward == Toward::Board {
            asked = meant(&packet).then_some(packet.header.sequence);
        } else if asked == Some(packet.header.sequence) && !packet.is(Kind::RowOut) {
            return Vec::new();
        }
        vec![packet]
    })
}

/// The report on a board that never gets the packets that are `meant`.
fn deaf(meant: impl Fn(&Passing) -> bool + Send + 'static) -> Report {
    judge(
        &System::TINY,
        move |toward, packet| {
            if toward == Toward::Board && meant(&packet) { Vec::new() } else { vec![packet] }
        },
    )
}

fn told(report: &Report) -> String {
    assert_eq!((report.verdict(), report.cause), (Verdict::Error, Cause::Station), "{}", report.headline());
    report.headline()
}

/// Silence is no FAIL, since a link can swallow the same bytes each time. But no cable chooses one kind of request.
#[test]
fn a_request_that_alone_is_left_unanswered_is_not_blamed_on_the_cable() {
    for kind in [Kind::TableCrc, Kind::Configure, Kind::Status] {
        let told = told(&silent(move |packet| packet.is(kind)));
        for clause in [
            format!("no answer to {kind} with"),
            "in 8 tries, and to this alone: the board answered others at once".to_owned(),
            "which no poor cable does; check how the board".to_owned(),
        ] {
            assert!(told.contains(&clause), "{told}");
        }
        // What it counts is asked by STATUS.
        assert_eq!(told.contains("counts a further try as received"), kind != Kind::Status, "{told}");
        assert!(!told.contains("does not count"), "{told}");
    }
}

#[test]
fn a_silence_tells_what_the_board_counts_and_how_long_the_request_is() {
    let is_long = |packet: &Passing| packet.is(Kind::Echo) && packet.payload.len() == 4080;
    let answered = told(&silent(is_long));
    assert!(answered.contains("no answer to ECHO with 4,080 bytes in 8 tries"), "{answered}");
    assert!(answered.contains("and it counts a further try as received,"), "{answered}");
    assert!(answered.contains("check how the board answers it"), "{answered}");
    let lost = told(&deaf(is_long));
    assert!(lost.contains("and it does not count a further try as received,"), "{lost}");
    assert!(lost.contains("check how the board takes it in"), "{lost}");
}

/// The board counts what it cannot unstuff, and answers whatever it can.
#[test]
fn a_receiver_that_damages_the_same_packet_each_time_is_told_from_a_poor_cable() {
    let report = System::TINY.judge(",fault=misread,instead=long-runs");
    let told = told(&report);
    for clause in [
        "no answer to ECHO with 256 bytes in 8 tries, because the board counts each as a damaged packet",
        "how the board undoes the stuffing of long packets",
    ] {
        assert!(told.contains(clause), "{told}");
    }
}

/// The ninth try comes through, so that it was no matter of what the packet holds.
#[test]
fn a_link_that_damages_long_packets_to_the_board_for_a_while_is_not_acquitted() {
    let candidate = Altered::new(&Options::default(), |_, packet| vec![packet]).candidate();
    let mut damaged = 0;
    let link = Through::boxed(candidate.link, move |link, out, back, wait| {
        let mut out = out.to_vec();
        if out.len() > 4080 && damaged < 8 {
            damaged += 1;
            out[100] ^= 2;
        }
        link.exchange(&out, back, wait)
    });
    let told = told(&System::TINY.judge_candidate(Candidate { link, ..candidate }));
    assert!(told.contains("though the board had answered before; check the cable"), "{told}");
}

/// Noise lets short packets through and long ones not.
#[test]
fn a_link_that_damages_long_packets_is_not_acquitted() {
    let candidate = Altered::new(&Options::default(), |_, packet| vec![packet]).candidate();
    let link = Through::boxed(candidate.link, |link, out, back, wait| {
        let from = back.len();
        let taken = link.exchange(out, back, wait)?;
        if back.len() - from > 4080 {
            back[from + 100] ^= 2;
        }
        Ok(taken)
    });
    let told = told(&System::TINY.judge_candidate(Candidate { link, ..candidate }));
    assert!(told.contains("8 packets came damaged: the link loses what is sent over it"), "{told}");
}

/// Nothing comes back damaged, so that only the board's count tells of the link.
#[test]
fn a_link_test_tells_what_was_damaged_on_the_way_to_the_board() {
    let link = Through::boxed(open("mock").link, |link, out, back, wait| {
        let mut out = out.to_vec();
        if out.len() > 4080 {
            out[100] ^= 2;
        }
        link.exchange(&out, back, wait)
    });
    let mut board = Board::open(link, &OpenOptions::default()).unwrap();
    let error = link_test::run(&mut board, Duration::from_millis(50), 1).unwrap_err();
    assert!(matches!(&error, LinkTestError::PoorLink { errors, .. } if errors.damaged() > 0), "{error}");
}

/// A link that was broken for longer than all tries brings the next request, and the one that was left unanswered.
#[test]
fn a_link_that_was_broken_for_a_while_is_not_called_a_silence_of_the_board() {
    let (mut asked, mut lost) = (false, 0);
    let report = judge(&System::TINY, move |toward, packet| {
        asked |= packet.is(Kind::Configure);
        if toward == Toward::Board && asked && lost < 8 {
            lost += 1;
            return Vec::new();
        }
        vec![packet]
    });
    let told = told(&report);
    assert!(told.contains("check the cable, its connectors and the rate"), "{told}");
}

/// It is the same row each time, whatever else goes through.
#[test]
fn a_row_that_alone_is_lost_is_not_blamed_on_the_cable() {
    let is_row = |packet: &Passing| packet.is(Kind::RowIn) && packet.payload[6..8] == [3, 0];
    let lost = told(&deaf(is_row));
    assert!(lost.contains("row 2 of frame 0 did not come back"), "{lost}");
    // A row leaves while the next one enters.
    assert!(lost.contains("this row alone was missing, and the board still waited for row 3"), "{lost}");
    let report = judge(&System::TINY, |toward, packet| {
        let is_lost = toward == Toward::Host && packet.is(Kind::RowOut) && packet.payload[6..8] == [3, 0];
        if is_lost { Vec::new() } else { vec![packet] }
    });
    let unsent = told(&report);
    assert!(unsent.contains("row 3 of frame 0 did not come back"), "{unsent}");
    assert!(unsent.contains("alone was missing, and the board says that it took every row"), "{unsent}");
}

/// The report on a board whose packets end without a zero.
fn unclosed() -> Report {
    let candidate = Altered::new(&Options::default(), |_, packet| vec![packet]).candidate();
    let link = Through::boxed(candidate.link, |link, out, back, wait| {
        let mut came = Vec::new();
        let taken = link.exchange(out, &mut came, wait)?;
        // Each packet has a zero on either side; the one behind it goes.
        let mut inside = false;
        for byte in came {
            let is_behind = byte == 0 && inside;
            inside = byte != 0;
            if !is_behind {
                back.push(byte);
            }
        }
        Ok(taken)
    });
    System::TINY.judge_candidate(Candidate { link, ..candidate })
}

/// Every answer would come only when the next one begins, and the run would take hours.
#[test]
fn a_board_that_ends_no_packet_is_told_so_at_once() {
    let report = unclosed();
    assert_eq!((report.verdict(), report.cause), (Verdict::Error, Cause::Refused), "{}", report.headline());
    let told = report.headline();
    assert!(told.contains("without the zero that must follow each of them"), "{told}");
    assert!(Duration::from_secs_f64(report.link.seconds) < Duration::from_secs(5), "{}", report.link.seconds);
}

/// The second frame takes longer than all that the run leaves out of its times.
#[test]
fn times_add_up_to_no_more_than_the_run_if_rows_stop_coming() {
    let mut rows = 0;
    let report = judge(&System::TINY, move |toward, packet| {
        let is_row = toward == Toward::Host && packet.is(Kind::RowOut);
        rows += usize::from(is_row);
        if is_row && rows == 12 {
            thread::sleep(Duration::from_millis(300));
        }
        if is_row && rows > 12 { Vec::new() } else { vec![packet] }
    });
    assert_eq!(report.verdict(), Verdict::Error, "{}", report.headline());
    let checks = report.checks.iter().map(|check| check.seconds);
    let seconds: f64 = checks.chain(report.frames.iter().map(|frame| frame.seconds)).sum();
    assert!((0.3..=report.run.seconds).contains(&seconds), "{seconds} of {} s", report.run.seconds);
}
