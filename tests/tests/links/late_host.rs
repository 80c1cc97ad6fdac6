//! A host that is kept from running, as on a busy machine: what arrived meanwhile was in time.

use std::time::Duration;

use halfrow::verdict::Cause;
use halfrow_tests::parallel;
use halfrow_tests::system::System;

/// Longer than any timeout of the host.
const PAUSE: Duration = Duration::from_secs(1);

#[test]
fn it_does_not_find_the_board_late() {
    let every: Vec<u32> = (2..20).chain([29, 53, 101, 211]).collect();
    let reports =
        parallel::map(&every, |&every| System::TINY.judge_late(",speed=1200000,delay=0.001", every, PAUSE));
    for (every, report) in every.iter().zip(reports) {
        assert_eq!(report.cause, Cause::Equal, "every {every}: {}", report.headline());
        assert_eq!(report.link.retries, 0, "every {every}");
    }
}
