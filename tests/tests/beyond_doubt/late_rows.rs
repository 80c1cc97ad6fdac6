//! Rows whose latency differs from the one that the board claims.

use halfrow::result::{Finding, LateRows, Report};
use halfrow_protocol::Reply;
use halfrow_tests::altered::{Toward, judge_each};
use halfrow_tests::system::System;

/// The report on a board whose rows that are `meant` take a clock more than it claims.
fn late(meant: fn(u16) -> bool) -> Report {
    judge_each(&System::TINY, move |toward, packet| match packet.reply() {
        Some(Reply::RowOut(mut row)) if toward == Toward::Host && meant(row.place.row) => {
            (row.first_latency, row.last_latency) = (row.first_latency + 1, row.last_latency + 1);
            packet.saying(&Reply::RowOut(row))
        }
        _ => packet,
    })
}

fn rows(report: &Report) -> &LateRows {
    let Finding::LatencyWrong(late) = &report.finding else { panic!("{}", report.headline()) };
    late
}

#[test]
fn two_late_rows_of_each_frame_are_not_one() {
    let report = late(|row| row == 3 || row == 5);
    let late = rows(&report);
    assert_eq!((late.row, late.rows * System::TINY.height), (3, 2 * late.of_rows));
    assert!(!late.are_one_row() && late.are_some(), "{late:?}");
}

/// A pipeline of another depth would make every row late.
#[test]
fn one_late_row_is_not_the_depth_of_the_pipeline() {
    let report = late(|row| row == 3);
    let late = rows(&report);
    assert_eq!((late.rows * System::TINY.height, late.are_one_row()), (late.of_rows, true));
    assert!(report.headline().contains("board claims, all row 3: "), "{}", report.headline());
    assert!(report.remedy().unwrap().starts_with("Check the enable and the row player"), "{report:?}");
}

/// What comes last is measured by itself.
#[test]
fn a_row_that_begins_in_time_and_ends_late_is_late() {
    for (change, seen) in [((|last| last + 1) as fn(u16) -> u16, (44, 45)), (|last| last - 1, (43, 44))] {
        let report = judge_each(&System::TINY, move |toward, packet| match packet.reply() {
            Some(Reply::RowOut(mut row)) if toward == Toward::Host && row.place.row == 3 => {
                row.last_latency = change(row.last_latency);
                packet.saying(&Reply::RowOut(row))
            }
            _ => packet,
        });
        let Finding::LatencyWrong(late) = &report.finding else { panic!("{}", report.headline()) };
        // W/2 + 12 of the mock.
        let claimed = System::TINY.width as u32 / 2 + 12;
        assert_eq!(
            (late.first, late.last),
            (claimed, change(claimed as u16).into()),
            "{}",
            report.headline()
        );
        let told = report.latency.unwrap();
        assert_eq!((told.least, told.most), seen);
    }
}
