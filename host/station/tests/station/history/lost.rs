//! What a run's page says of evidence that is not there any more.

use std::fs;

use halfrow_station::kept::prune;

use super::made::{BEGIN_MS, End, HOUR_MS, Made, Run};
use super::served::Served;

#[test]
fn evidence_that_nobody_removed_is_not_said_to_have_been_old() {
    let mut made = Made::new();
    let mut fail = |serial, evidence, hour| {
        made.run(&Run { evidence: vec![evidence], ..Run::of(serial, End::Fail(&["memory"])).at_hour(hour) })
    };
    let (old, lost) = (fail("S1", "old", 1), fail("S2", "new", 48));
    assert_eq!(prune(&mut made.store, BEGIN_MS + 24 * HOUR_MS, "engel").unwrap().pieces, 1);
    fs::remove_file(made.folder().blobs().path(&halfrow::result::sha256([b"new"]))).unwrap();
    let served = Served::of(made);
    let removed = "removed because it was old";
    assert!(served.page(&format!("/runs/{old}")).contains(removed));
    let page = served.page(&format!("/runs/{lost}"));
    assert!(page.contains("not here") && !page.contains(removed), "{page}");
}
