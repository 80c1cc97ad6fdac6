//! What the log says while the audit takes nothing, as on a full disk.

use crate::common::NO_AUDIT;
use crate::pages::station::{SERIALS, Station};

/// Whoever reads the log from afar sees that it is over.
#[test]
fn the_log_says_once_that_the_audit_takes_nothing_and_once_that_it_does_again() {
    let station = Station::private(1);
    let serving = station.serve();
    let scan = || serving.here().post("/scan", &[("text", SERIALS[0])]).send().status;
    let logged = |what: &str| serving.complained().lines().filter(|line| line.contains(what)).count();
    let (begun, over) = ("refuses a line of the audit; ", "the audit takes entries again");
    for times in 1..=2 {
        station.change(NO_AUDIT);
        let refused = serving.here().post("/scan", &[("text", SERIALS[0])]).send();
        assert!(refused.text().contains("<small>database-refuses</small>"), "{}", refused.text());
        assert_eq!([refused.status, scan()], [503, 503]);
        assert_eq!((logged(begun), logged(over)), (times, times - 1), "{}", serving.complained());
        let line = serving.complained().lines().rfind(|line| line.contains(begun)).unwrap().to_owned();
        assert!(line.contains(" (database-refuses"), "{line}");
        station.change("DROP TRIGGER full");
        assert!(scan() != 503 && scan() != 503);
        assert_eq!((logged(begun), logged(over)), (times, times), "{}", serving.complained());
    }
}
