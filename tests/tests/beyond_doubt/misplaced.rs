//! Rows that come back with the place of another row, or never, where frames are not what is judged.

use halfrow::result::{CheckName, Finding, PlacedRow, Report};
use halfrow::run::{Part, Plan, Selection};
use halfrow::verdict::{Cause, Verdict};
use halfrow_mock::Options;
use halfrow_protocol::Reply;
use halfrow_protocol::message::{Configuration, Request, RowOut};
use halfrow_tests::altered::{Altered, Passing, Toward};
use halfrow_tests::system::{System, failed_check, judge_by_plan};

use super::by_the_rules::altering;

/// The number of the frame that brings tables into effect for a burst.
const ACTIVATING: u16 = u16::MAX;

/// The report on a board whose rows `alter` changes.
fn returning(plan: &Plan, alter: impl Fn(RowOut<'_>) -> Option<RowOut<'_>> + Send + 'static) -> Report {
    let altered = move |_, packet: Passing| match packet.reply() {
        Some(Reply::RowOut(row)) => {
            alter(row).map(|row| packet.saying(&Reply::RowOut(row))).into_iter().collect()
        }
        _ => vec![packet],
    };
    judge_by_plan(plan, Altered::new(&Options::default(), altered).candidate())
}

/// The smallest run with bursts in the corners of the settings.
fn at_speed() -> Plan {
    let parts = Selection::least().with(Part::AtSpeed, 2).with(Part::Corners, 1);
    Plan { selection: Some(parts), ..System::TINY.plan() }
}

/// The rows of the board's next configuration.
fn rows(packet: &Passing) -> Option<u16> {
    match packet.request() {
        Some(Request::Configure(Configuration { height, .. })) => Some(height),
        _ => None,
    }
}

/// The report on a board that forgets which row is the last one of frames of two rows, from the `nth` time on that it is configured
/// for these; and how often it was.
fn forgetting_the_last(nth: usize) -> (Report, usize) {
    let (sender, configured) = std::sync::mpsc::channel();
    let (mut times, mut height) = (0, 0);
    let report = altering(move |toward, packet| {
        if let Some(rows) = rows(&packet).filter(|_| toward == Toward::Board) {
            height = rows;
            if rows == 2 {
                times += 1;
                sender.send(()).unwrap();
            }
        }
        match packet.reply() {
            Some(Reply::RowOut(mut row)) if height == 2 && times >= nth => {
                row.place.last = false;
                vec![packet.saying(&Reply::RowOut(row))]
            }
            _ => vec![packet],
        }
    });
    (report, configured.iter().count())
}

/// A packet that comes back whole, under the number of a row that was sent, has the place of that row, whatever the link does.
#[test]
fn a_row_in_the_wrong_place_is_the_boards_wherever_the_rules_see_it() {
    let times = forgetting_the_last(usize::MAX).1;
    assert!(times > 3, "{times}");
    let mut failed = 0;
    for nth in 1..=times {
        let (report, _) = forgetting_the_last(nth);
        if report.verdict() == Verdict::Pass {
            continue;
        }
        failed += 1;
        assert_eq!(failed_check(&report), Some(CheckName::Rules), "{nth}: {}", report.headline());
        let Finding::RowMisplaced(PlacedRow { row: 1, rules: true, .. }) = report.finding else {
            panic!("{nth}: {:?}", report.finding)
        };
    }
    assert!(failed > 2, "{failed} of {times}");
}

#[test]
fn a_row_in_the_wrong_place_is_the_boards_where_it_brings_tables_into_effect() {
    let report = returning(&at_speed(), |mut row| {
        row.place.last ^= row.place.frame == ACTIVATING;
        Some(row)
    });
    assert_eq!(failed_check(&report), Some(CheckName::AtSpeed), "{}", report.headline());
    let Finding::InCorner { found, .. } = &report.finding else { panic!("{}", report.headline()) };
    assert!(
        matches!(**found, Finding::RowMisplaced(PlacedRow { frame: ACTIVATING, rules: false, .. })),
        "{found:?}"
    );
}

#[test]
fn a_row_that_is_lost_where_it_brings_tables_into_effect_sends_nobody_in_a_circle() {
    let report = returning(&at_speed(), |row| (row.place.frame != ACTIVATING).then_some(row));
    assert_eq!((report.verdict(), report.cause), (Verdict::Error, Cause::Station), "{}", report.headline());
    assert!(!report.headline().contains("halfrow verify"), "{}", report.headline());
    let remedy = report.remedy().unwrap();
    assert!(remedy.contains("cable") && !remedy.contains("verify"), "{remedy}");
}
