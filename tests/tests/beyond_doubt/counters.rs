//! A board's counters, compared with what the host saw and with each other.

use std::collections::BTreeSet;
use std::time::Duration;

use halfrow::board::{Board, OpenOptions};
use halfrow::link_test;
use halfrow::result::{CheckName, Finding, NotExercised, Report};
use halfrow::verdict::Verdict;
use halfrow_mock::Options;
use halfrow_protocol::message::Status;
use halfrow_protocol::{Kind, Reply};
use halfrow_tests::altered::{Altered, Passing, Toward, judge, judge_each};
use halfrow_tests::system::{System, judge_by_plan, streamed};

use crate::conduct::{fails, passes};

/// The report on a board with ROW_OUT packets whose numbers `number` makes of the right ones.
fn numbered(number: fn(u16) -> u16) -> Report {
    judge_each(&System::TINY, move |_, mut packet| {
        if packet.is(Kind::RowOut) {
            packet.header.sequence = number(packet.header.sequence);
        }
        packet
    })
}

#[test]
fn numbers_of_packets_that_were_never_sent_are_the_board_s_fault() {
    for number in [
        (|right| right.wrapping_mul(3).wrapping_add(777)) as fn(u16) -> u16,
        |right| right.wrapping_add(1),
        |right| if right < 5 { right } else { right.wrapping_add(1) },
    ] {
        fails(
            &numbered(number),
            CheckName::Counters,
            "ROW_OUT packets by their numbers; the right number is",
        );
    }
}

/// The report on a board after `change` was made to each of its STATUS replies.
fn with_counter(change: fn(&mut Status)) -> Report {
    judge_each(&System::TINY, move |_, packet| match packet.reply() {
        Some(Reply::Status(mut status)) => {
            change(&mut status);
            packet.saying(&Reply::Status(status))
        }
        _ => packet,
    })
}

#[test]
fn counters_are_compared_with_what_the_host_saw() {
    for (sentence, change) in [
        ("rows in; the right number is", (|status| status.rows_in += 1) as fn(&mut Status)),
        ("rows out; the right number is", |status| status.rows_out += 1),
        ("as the first row that has not arrived (next_row_in)", |status| status.next_row_in += 1),
        ("as the first row that is not acknowledged (next_row_out)", |status| status.next_row_out += 1),
        ("as the tables' generation; the right number is 2", |status| status.generation = 7),
        ("rows sent again; the right number is 0", |status| status.rows_repeated = 3),
        ("rows that were not needed; the right number is 0", |status| status.rows_unneeded = 3),
        ("1 refusals; the right number is 0", |status| status.refusals = 1),
        ("packets of another session; the right number is 0", |status| status.foreign_packets = 2),
    ] {
        fails(&with_counter(change), CheckName::Counters, sentence);
    }
}

#[test]
fn damaged_packets_that_nobody_missed_are_only_noted() {
    let report = with_counter(|status| (status.crc_errors, status.framing_errors) = (3, 2));
    passes(&report);
    assert_eq!(report.link.damaged_out, 5);
    let counters = report.checks.iter().find(|check| check.name == CheckName::Counters).unwrap();
    assert!(
        counters
            .detail()
            .contains("the board counts 5 damaged packets, although nothing had to be sent again")
    );
    assert!(report.not_exercised.contains(&NotExercised::CountersOfPoorLinks {}));
}

/// When a board counts faults of its link of which the host saw nothing, other counters are not compared.
#[test]
fn counters_that_are_not_compared_are_told_of_a_board_that_passes() {
    let is_told = |change: fn(&mut Status)| {
        let report = with_counter(change);
        passes(&report);
        report.not_exercised.contains(&NotExercised::CountersOfPoorLinks {})
    };
    assert!(!is_told(|_| {}));
    assert!(is_told(|status| status.packets += 1000));
    assert!(is_told(|status| (status.crc_errors, status.rows_repeated) = (1, status.rows_repeated + 3)));
}

/// An acknowledgement is lost and a row reaches the board twice, so that it counts as many packets as were sent. A row that comes
/// back twice says that the link does such things.
#[test]
fn a_link_that_is_seen_to_double_may_have_doubled_a_row_that_the_board_counts() {
    let [mut acknowledged, mut given, mut came] = [0; 3];
    let report = judge(&System::TINY, move |toward, packet| {
        let is_second = |count: &mut u32, of, kind| {
            let is_such = toward == of && packet.is(kind);
            *count += u32::from(is_such);
            is_such && *count == 2
        };
        if is_second(&mut acknowledged, Toward::Board, Kind::RowAck) {
            return Vec::new();
        }
        let is_doubled = is_second(&mut given, Toward::Board, Kind::RowIn);
        if is_doubled || is_second(&mut came, Toward::Host, Kind::RowOut) {
            return vec![packet.clone(), packet];
        }
        vec![packet]
    });
    passes(&report);
}

/// Nothing but the rows and what was answered reaches the board: it counts no packet that would make up for those requests which
/// follow a count that was asked for twice.
#[test]
fn requests_that_follow_a_count_which_was_lost_are_not_missed_in_it() {
    let (mut came, mut counts) = (false, BTreeSet::new());
    let alter = move |toward, packet: Passing| {
        came |= toward == Toward::Host && packet.is(Kind::RowOut);
        let is_count = toward == Toward::Board && came && packet.is(Kind::Status);
        let is_lost = is_count && counts.insert(packet.header.sequence);
        let is_kept = !is_lost && !packet.is(Kind::RowAck);
        is_kept.then_some(packet).into_iter().collect()
    };
    let candidate = Altered::new(&Options::default(), alter).candidate();
    let report = judge_by_plan(&streamed(System::TINIEST.plan()), candidate);
    passes(&report);
    assert!(report.link.retries > 0);
}

/// Each row that a board took, each that it did not need and each refusal came in a packet of its own, over whatever link.
#[test]
fn counters_that_contradict_each_other_are_the_board_s_fault_over_any_link() {
    for change in [
        (|status| status.packets = 0) as fn(&mut Status),
        |status| (status.packets, status.refusals) = (0, 4242),
        |status| (status.crc_errors, status.refusals, status.foreign_packets) = (1, 4242, 55),
        |status| (status.crc_errors, status.rows_unneeded) = (1, 4242),
        |status| (status.crc_errors, status.foreign_packets) = (1, 4242),
    ] {
        fails(
            &with_counter(change),
            CheckName::Counters,
            "packets that came to it; the right number is at least",
        );
    }
}

/// A late copy of the STATUS that clears the counters leaves the same.
#[test]
fn fewer_packets_than_were_answered_are_no_pass_and_no_fail() {
    let report = with_counter(|status| status.packets = status.packets.saturating_sub(30));
    assert_eq!(report.verdict(), Verdict::Error, "{}", report.headline());
    assert!(report.headline().contains("packets that came to it"), "{}", report.headline());
}

/// A row of 64 samples takes W/2 + 12 pixel clocks in the mock.
#[test]
fn both_latencies_that_a_board_counts_are_compared_with_those_of_its_rows() {
    let told = |least, most| Finding::LatencyMiscounted {
        least: 44,
        most: 44,
        counted_least: least,
        counted_most: most,
    };
    let least = with_counter(|status| status.least_latency -= (status.least_latency > 0) as u32);
    let most = with_counter(|status| status.most_latency += (status.most_latency > 0) as u32);
    for (report, right) in [(least, told(43, 44)), (most, told(44, 45))] {
        assert_eq!((report.verdict(), &report.finding), (Verdict::Fail, &right), "{}", report.headline());
    }
}

/// One is asked in front of the second session of a test, and one at its end.
#[test]
fn damaged_packets_of_both_sessions_of_a_link_test_add_up() {
    let board = Altered::new(&Options::default(), |_, packet| match packet.reply() {
        Some(Reply::Status(status)) => {
            vec![packet.saying(&Reply::Status(Status { crc_errors: 3, framing_errors: 4, ..status }))]
        }
        _ => vec![packet],
    });
    let mut board = Board::open(board.candidate().link, &OpenOptions::default()).unwrap();
    let figures = link_test::run(&mut board, Duration::from_millis(20), 1).unwrap();
    assert_eq!(figures.errors.damaged_out, 2 * 7);
}
