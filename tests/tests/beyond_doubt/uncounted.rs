//! What the rules have a board take, keep or free, and what of that nobody hears of: each end names the counter that was looked at.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use halfrow::result::{Counter, Doubt, Finding, Report, Rule};
use halfrow::verdict::Verdict;
use halfrow_mock::Options;
use halfrow_protocol::message::Status;
use halfrow_protocol::{Kind, Reply};
use halfrow_tests::altered::{Passing, Toward};

use super::by_the_rules::altering;

/// Rows that are given to a board whose output banks are full.
const WAITING: u32 = 2;

/// The report on a board whose counters `alter` changes, and whose host's packets all reach it, except those that are `lost`.
fn counting(
    mut alter: impl FnMut(&mut Status) + Send + 'static,
    lost: impl Fn(&Passing) -> bool + Send + 'static,
) -> Report {
    altering(move |toward, packet| match packet.reply() {
        Some(Reply::Status(mut status)) if toward == Toward::Host => {
            alter(&mut status);
            vec![packet.saying(&Reply::Status(status))]
        }
        _ if toward == Toward::Board && lost(&packet) => Vec::new(),
        _ => vec![packet],
    })
}

/// The counter that is wrong, by how much, and the rule; and why that is not the board's.
fn told(report: &Report) -> (Counter, i64, Rule, Doubt) {
    assert_eq!(report.verdict(), Verdict::Error, "{}", report.headline());
    let Finding::WrongOverDoubtfulLink { found, doubt } = &report.finding else {
        panic!("{}", report.headline())
    };
    let Finding::CounterWrong { counter, counted, right, rule: Some(rule) } = **found else {
        panic!("{}", found.sentence())
    };
    (counter, i64::from(counted) - i64::from(right), rule, *doubt)
}

fn nothing(_: &Passing) -> bool {
    false
}

fn output_banks() -> u32 {
    Options::default().row_banks_out.into()
}

#[test]
fn a_row_that_never_enters_is_not_said_to_stay_inside() {
    let report = counting(
        |status| {
            status.next_row_in -= status.core_busy;
            status.core_busy = 0;
        },
        nothing,
    );
    assert_eq!(told(&report), (Counter::NextRowIn, -1, Rule::Inside, Doubt::AnswerLost {}));
}

#[test]
fn a_row_that_must_not_come_is_not_said_to_have_to() {
    let report = counting(
        |status| status.next_row_in = status.next_row_in.min(status.next_row_out + output_banks()),
        nothing,
    );
    let wanting = -i64::from(WAITING);
    assert_eq!(told(&report), (Counter::NextRowIn, wanting, Rule::Banks, Doubt::AnswerLost {}));
}

/// The altered link drops damaged packets, so the board counts none of them.
#[test]
fn a_row_that_is_freed_by_damage_that_nobody_counts_is_not_said_to_stay_away() {
    let mut full = 0;
    let report = counting(
        move |status| {
            full += u32::from(status.next_row_in - status.next_row_out == output_banks() + WAITING);
            // After the rows are given, after one is given again, before the damaged packets, and after these.
            status.next_row_out += u32::from(full >= 4);
        },
        nothing,
    );
    let (counter, more, rule, doubt) = told(&report);
    assert_eq!((counter, more, rule), (Counter::NextRowOut, 1, Rule::Damage));
    assert!(matches!(doubt, Doubt::DamageUncounted { counted: 0, sent } if sent > 0), "{doubt:?}");
    let told = "the board counts 0 of the ";
    assert!(report.headline().contains(told), "{}", report.headline());
}

#[test]
fn a_row_that_came_and_is_never_acknowledged_is_not_said_to_stay_away() {
    let is_full = Arc::new(AtomicBool::new(false));
    let fills = Arc::clone(&is_full);
    let report = counting(
        move |status| {
            let rows = status.next_row_in - status.next_row_out;
            fills.fetch_or(rows == output_banks() + WAITING, Ordering::Relaxed);
        },
        move |packet| packet.is(Kind::RowAck) && is_full.load(Ordering::Relaxed),
    );
    assert_eq!(told(&report), (Counter::NextRowOut, -1, Rule::Banks, Doubt::AnswerLost {}));
}
