//! Rows whose latency differs from the one that the board claims.

use halfrow::result::Finding;
use halfrow_protocol::Reply;
use halfrow_tests::altered::{Toward, judge_each};
use halfrow_tests::system::System;

/// A pipeline of another depth would make every row late.
#[test]
fn one_late_row_is_not_the_depth_of_the_pipeline() {
    let report = judge_each(&System::TINY, |toward, packet| match packet.reply() {
        Some(Reply::RowOut(mut row)) if toward == Toward::Host && row.place.row == 3 => {
            (row.first_latency, row.last_latency) = (row.first_latency + 1, row.last_latency + 1);
            packet.saying(&Reply::RowOut(row))
        }
        _ => packet,
    });
    let Finding::LatencyWrong(late) = &report.finding else { panic!("{}", report.headline()) };
    assert_eq!((late.rows * System::TINY.height, late.are_one_row()), (late.of_rows, true));
    assert!(report.headline().contains("board claims, all row 3: "), "{}", report.headline());
    assert!(report.remedy().unwrap().starts_with("Check the enable and the row player"), "{report:?}");
}

/// What comes last is measured by itself.
#[test]
fn a_row_that_begins_in_time_and_ends_late_is_late() {
    for change in [(|last| last + 1) as fn(u16) -> u16, |last| last - 1] {
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
    }
}
