//! Boards that are sound except in the rows that they keep for the host: as many as they have banks for, until each is
//! acknowledged.

use std::collections::BTreeSet;

use halfrow::result::{CheckName, Counter, Finding, RepeatedRow, Report, Rule};
use halfrow::verdict::Verdict;
use halfrow_mock::Options;
use halfrow_protocol::message::{Capabilities, Status};
use halfrow_protocol::{Kind, Reply};
use halfrow_tests::altered::{Altered, Passing, Toward};
use halfrow_tests::system::{failed_check, judge_by_plan};

use super::by_the_rules::{altering, broken, miscounted, plan, said_by};

/// Bytes of a row's place, which begins with its sequence number (WIRE.md, 20).
const PLACE: usize = 12;

/// The report on a board with `row_banks_out` output banks that claims to have `told`.
fn telling(row_banks_out: u8, told: u8) -> Report {
    let options = Options { row_banks_out, ..Options::default() };
    said_by(&options, move |packet| match packet.reply() {
        Some(Reply::Capabilities(capabilities)) => {
            let told = Capabilities { row_banks_out: told, ..capabilities };
            Some(packet.saying(&Reply::Capabilities(told)))
        }
        _ => Some(packet),
    })
}

#[test]
fn a_board_that_makes_more_rows_than_it_says_it_has_banks_for_fails() {
    for told in [2, 3, 7] {
        assert_eq!(broken(&telling(8, told)).0, Rule::Banks, "{told}");
    }
}

#[test]
fn a_board_that_stops_before_its_banks_are_full_fails() {
    for told in [4, 8, 255] {
        assert_eq!(broken(&telling(3, told)).0, Rule::Banks, "{told}");
    }
}

#[test]
fn any_number_of_banks_may_be_filled() {
    for banks in [2, 3, 5, 23, 64, 255] {
        let report = telling(banks, banks);
        assert_eq!(failed_check(&report), None, "{banks}: {}", report.headline());
    }
}

/// The report on a board that never hears the packets that are `swallowed`, but still counts them.
fn deaf_to(swallowed: impl FnMut(Toward, &mut Passing) -> bool + Send + 'static) -> Report {
    deaf(&Options::default(), swallowed)
}

/// The same for a board of the build `options`.
fn deaf(
    options: &Options,
    mut swallowed: impl FnMut(Toward, &mut Passing) -> bool + Send + 'static,
) -> Report {
    let mut missed = 0;
    let altered = move |toward, mut packet: Passing| {
        if swallowed(toward, &mut packet) {
            missed += 1;
            return Vec::new();
        }
        match packet.reply() {
            Some(Reply::Status(status)) if toward == Toward::Host => {
                let packets = status.packets + missed;
                vec![packet.saying(&Reply::Status(Status { packets, ..status }))]
            }
            _ => vec![packet],
        }
    };
    judge_by_plan(&plan(), Altered::new(options, altered).candidate())
}

#[test]
fn a_board_that_ignores_acknowledgements_fails() {
    let report = deaf_to(|_, packet| packet.is(Kind::RowAck));
    assert_eq!(miscounted(&report), Counter::NextRowOut);
}

/// The link loses the first row of the frames, long before.
#[test]
fn a_board_that_ignores_acknowledgements_fails_over_a_link_that_loses_a_row_too() {
    let (mut is_lost, mut missed) = (false, 0);
    let report = altering(move |toward, packet| match packet.reply() {
        _ if packet.is(Kind::RowIn) && !std::mem::replace(&mut is_lost, true) => Vec::new(),
        _ if packet.is(Kind::RowAck) => {
            missed += 1;
            Vec::new()
        }
        Some(Reply::Status(status)) if toward == Toward::Host => {
            let packets = status.packets + missed;
            vec![packet.saying(&Reply::Status(Status { packets, ..status }))]
        }
        _ => vec![packet],
    });
    assert_eq!(miscounted(&report), Counter::NextRowOut);
}

/// It loses them each time, and brings STATUS twice, so that the board counts as many packets as were sent.
#[test]
fn a_link_that_loses_acknowledgements_and_doubles_what_asks_for_them_makes_no_sound_board_fail() {
    let report = altering(|toward, packet| match toward {
        Toward::Board if packet.is(Kind::RowAck) => Vec::new(),
        Toward::Board if packet.is(Kind::Status) => vec![packet.clone(), packet],
        _ => vec![packet],
    });
    assert_ne!(report.verdict(), Verdict::Fail, "{}", report.headline());
}

/// The host asks again for a row that the board has, by sending black samples.
#[test]
fn a_board_that_does_not_send_a_row_again_fails() {
    let mut came = BTreeSet::new();
    let report = deaf_to(move |toward, packet| {
        let Some((row, samples)) = packet.payload.split_at_checked(PLACE) else { return false };
        let number = row[..4].to_vec();
        if toward == Toward::Host && packet.is(Kind::RowOut) {
            came.insert(number);
            return false;
        }
        packet.is(Kind::RowIn) && came.contains(&number) && samples.iter().all(|&byte| byte == 0)
    });
    assert_eq!(broken(&report).0, Rule::Banks);
    // Of 8 tries each the first one asks, and then only waits.
    assert_eq!(report.link.retries, 7 + 7);
}

/// The row that fills the last bank is not heard until it is asked for again, which the host does by sending black samples. No
/// frame of more than one row fills this many banks, so no other row waits for it.
#[test]
fn a_row_that_comes_late_and_in_another_place_fails() {
    const BANKS: u32 = 23;
    let mut late = None;
    let options = Options { row_banks_out: BANKS as u8, ..Options::default() };
    let report = deaf(&options, move |toward, packet| {
        let Some((row, samples)) = packet.payload.split_at_checked(PLACE) else { return false };
        let number = u32::from_le_bytes(row[..4].try_into().unwrap());
        if toward == Toward::Host {
            if packet.is(Kind::RowOut) && late == Some(number) {
                packet.payload[4] ^= 1;
            }
            return false;
        }
        let is_last = packet.is(Kind::RowIn) && number.wrapping_sub(packet.header.window) == BANKS - 1;
        let is_swallowed = is_last && samples.iter().any(|&byte| byte != 0);
        late = late.or(is_swallowed.then_some(number));
        is_swallowed
    });
    assert_eq!(failed_check(&report), Some(CheckName::Rules), "{}", report.headline());
    assert!(matches!(report.finding, Finding::RowMisplaced(_)), "{}", report.headline());
}

#[test]
fn a_row_that_says_that_it_never_came_before_fails() {
    let report = said_by(&Options::default(), |packet| match packet.reply() {
        Some(Reply::RowOut(row)) => {
            let mut row = row;
            row.repeats = 0;
            Some(packet.saying(&Reply::RowOut(row)))
        }
        _ => Some(packet),
    });
    assert_eq!(failed_check(&report), Some(CheckName::Rules), "{}", report.headline());
    let stands = matches!(report.finding, Finding::RowRepeatsStand(RepeatedRow { repeats: 0, .. }));
    assert!(stands && report.headline().contains(" of the rules' frame "), "{}", report.headline());
}
