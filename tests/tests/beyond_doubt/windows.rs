//! Boards that give another window than they keep to, and links that leave a sound board with a smaller window than the host
//! knows.

use halfrow::result::{Answer, Counter, Finding, Report, Rule};
use halfrow::verdict::Verdict;
use halfrow_mock::Options;
use halfrow_protocol::message::{Refusal, RefusalCode, Status};
use halfrow_protocol::{Kind, Reply};
use halfrow_tests::altered::{Passing, Toward, judge, judge_each};
use halfrow_tests::system::System;

use super::by_the_rules::{altering, broken, carried_out, refusal, said_by};

/// Where a RESET names the row that the board then waits for (WIRE.md, 03).
const NEXT_ROW: std::ops::Range<usize> = 1..5;
/// The mock's input banks.
const BANKS: u32 = 4;

/// The credit after a RESET that the board gives instead of that for its banks.
fn credit(report: &Report) -> u32 {
    assert_eq!(report.verdict(), Verdict::Fail, "{}", report.headline());
    let Finding::RuleBroken { rule: Rule::Window, right, found, .. } = &report.finding else {
        panic!("{}", report.headline())
    };
    assert_eq!(right, &Answer::Credit { rows: BANKS }, "{}", report.headline());
    let Answer::Credit { rows } = found else { panic!("{}", report.headline()) };
    let told = "the window must be next_row plus row_banks_in";
    assert!(report.headline().contains(told), "{}", report.headline());
    // The rule is no refusal.
    let asked = report.finding.remedy().unwrap_or_default();
    assert!(asked.contains("protocol/WIRE.md") && !asked.contains("refuse"), "{asked}");
    *rows
}

#[test]
fn a_board_that_sends_its_window_with_the_greatest_byte_first_fails() {
    let report = judge_each(&System::TINY, |toward, mut packet: Passing| {
        if toward == Toward::Host {
            packet.header.window = packet.header.window.swap_bytes();
        }
        packet
    });
    assert_ne!(credit(&report), BANKS);
}

#[test]
fn a_board_that_does_not_go_on_from_the_row_that_a_reset_names_fails() {
    let mut window = BANKS;
    let report = judge_each(&System::TINY, move |toward, mut packet: Passing| {
        if toward == Toward::Host {
            window = packet.header.window;
        } else if let (true, Some(next_row)) = (packet.is(Kind::Reset), packet.payload.get_mut(NEXT_ROW)) {
            next_row.copy_from_slice(&(window - BANKS).to_le_bytes());
        }
        packet
    });
    assert_eq!(credit(&report), 0);
}

/// Too few rows are then in the board at once for any to come back, so the run ends for want of a row.
#[test]
fn a_board_that_gives_less_credit_than_it_has_banks_fails() {
    for less in [BANKS - 1, u32::MAX] {
        let report = judge_each(&System::TINY, move |toward, mut packet: Passing| {
            if toward == Toward::Host {
                packet.header.window = packet.header.window.saturating_sub(less);
            }
            packet
        });
        assert_eq!(credit(&report), BANKS.saturating_sub(less));
    }
}

/// While a row waits.
#[test]
fn a_board_with_a_smaller_window_in_its_counters_fails() {
    let report = said_by(&Options::default(), |mut packet| {
        packet.header.window = packet.header.window.saturating_sub(packet.is(Kind::Status).into());
        Some(packet)
    });
    assert_eq!(credit(&report), BANKS - 1);
}

/// Of the rows before the last number all have come, so there is credit for none.
#[test]
fn a_board_whose_window_wraps_fails() {
    let mut has_come = false;
    let report = said_by(&Options::default(), move |mut packet| {
        has_come &= !packet.is(Kind::Reset);
        has_come |=
            matches!(packet.reply(), Some(Reply::RowOut(row)) if row.place.row_sequence == u32::MAX - 1);
        if packet.header.window == u32::MAX && has_come {
            packet.header.window = BANKS - 1;
        }
        Some(packet)
    });
    let (rule, right, found) = broken(&report);
    assert_eq!(rule, Rule::Window, "{}", report.headline());
    assert_eq!((right, found), (&Answer::Credit { rows: 0 }, &Answer::Credit { rows: BANKS }));
}

/// The link loses the first of these acknowledgements.
#[test]
fn a_board_that_takes_rows_as_acknowledged_that_it_never_sent_fails_over_a_link_that_loses_packets() {
    let (mut sent, mut beyond, mut is_lost) = (0, None, false);
    let report = altering(move |toward, packet| {
        if let (true, Some(next_row)) = (packet.is(Kind::Reset), packet.payload.get(NEXT_ROW)) {
            (sent, beyond) = (u32::from_le_bytes(next_row.try_into().unwrap()), None);
        }
        if toward == Toward::Board && packet.is(Kind::RowAck) && packet.header.window == sent + BANKS {
            beyond = is_lost.then_some(packet.header.window);
            is_lost = true;
            return Vec::from_iter(beyond.map(|_| packet));
        }
        match (packet.reply(), beyond) {
            (Some(Reply::Status(status)), Some(next_row_out)) if toward == Toward::Host => {
                vec![packet.saying(&Reply::Status(Status { next_row_out, ..status }))]
            }
            (Some(Reply::RowOut(row)), _) if toward == Toward::Host => {
                sent = sent.max(row.place.row_sequence + 1);
                vec![packet]
            }
            _ => vec![packet],
        }
    });
    let counter = match report.finding {
        Finding::CounterWrong { counter, rule: Some(Rule::Banks), .. } => Some(counter),
        _ => None,
    };
    assert_eq!(
        (report.verdict(), counter),
        (Verdict::Fail, Some(Counter::NextRowOut)),
        "{}",
        report.headline()
    );
}

/// The link loses each of these acknowledgements.
#[test]
fn a_board_of_which_it_is_not_known_what_it_takes_as_acknowledged_does_not_pass() {
    let mut next_row = 0;
    let report = altering(move |toward, packet| {
        if let (true, Some(named)) = (packet.is(Kind::Reset), packet.payload.get(NEXT_ROW)) {
            next_row = u32::from_le_bytes(named.try_into().unwrap());
        }
        let is_beyond = toward == Toward::Board && packet.header.window == next_row + BANKS;
        Vec::from_iter((!is_beyond || !packet.is(Kind::RowAck)).then_some(packet))
    });
    let Finding::WrongOverDoubtfulLink { found, .. } = &report.finding else {
        panic!("{}", report.headline())
    };
    let is_of_packets = matches!(**found, Finding::CounterWrong { counter: Counter::Packets, .. });
    assert!(is_of_packets && report.verdict() == Verdict::Error, "{}", report.headline());
}

fn is_without_credit(refusal: &Refusal) -> bool {
    (refusal.kind, refusal.code) == (Kind::RowIn.code(), RefusalCode::Credit)
}

/// The first RESET comes again, late, in the middle of the first rows of the frames: then the board waits for an earlier row.
#[test]
fn a_late_copy_of_a_reset_makes_no_sound_board_fail() {
    let (mut reset, mut rows) = (None, 0);
    let report = judge(&System::TINY, move |toward, packet: Passing| {
        if toward == Toward::Host {
            return vec![packet];
        }
        if packet.is(Kind::Reset) {
            reset.get_or_insert_with(|| packet.clone());
        }
        rows += u32::from(packet.is(Kind::RowIn));
        let copy = reset.clone().filter(|reset| rows == 20 && reset.header.session == packet.header.session);
        rows += u32::from(copy.is_some());
        [Some(packet), copy].into_iter().flatten().collect()
    });
    assert_ne!(report.verdict(), Verdict::Fail, "{}", report.headline());
}

/// A packet of an earlier session, which had the same number, names a window that this one does not have.
#[test]
fn a_window_of_an_earlier_session_makes_no_sound_board_fail() {
    let (sender, refused) = std::sync::mpsc::channel();
    let mut is_stale = true;
    let report = judge_each(&System::TINY, move |toward, mut packet: Passing| {
        if toward == Toward::Host {
            if is_stale && packet.is(Kind::Configure) {
                (packet.header.window, is_stale) = (packet.header.window + 9, false);
            }
            refusal(&packet).filter(is_without_credit).map(|refusal| sender.send(refusal));
        }
        packet
    });
    assert!(refused.try_recv().is_ok(), "{}", report.headline());
    assert_ne!(report.verdict(), Verdict::Fail, "{}", report.headline());
}

/// Whatever else came with the row or the request in which it showed first.
#[test]
fn the_rule_that_is_told_is_the_one_that_is_broken() {
    let report = said_by(&Options::default(), |packet| {
        let refusal = refusal(&packet).filter(is_without_credit);
        let code = RefusalCode::Row;
        Some(
            refusal
                .map_or_else(|| packet.clone(), |it| packet.saying(&Reply::Refusal(Refusal { code, ..it }))),
        )
    });
    assert_eq!(broken(&report).0, Rule::Credit, "{}", report.headline());
    let report = said_by(&Options::default(), |packet| {
        let of_records = |it: &Refusal| (it.kind, it.code) == (Kind::Records.code(), RefusalCode::Range);
        Some(
            refusal(&packet).filter(of_records).map_or_else(|| packet.clone(), |it| carried_out(&packet, it)),
        )
    });
    assert_eq!(broken(&report).0, Rule::Records, "{}", report.headline());
}
