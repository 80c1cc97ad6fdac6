//! The buttons of lanes.

use std::fs;

use crate::common::NO_AUDIT;
use crate::pages::lanes::seen;
use crate::pages::station::{SERIALS, Serving, Station};

/// A station whose lane has a serial number, and is started by `start`.
fn started_by(start: &str) -> (Station, Serving) {
    let station = Station::private(1);
    let port = station.path("port");
    let started = format!("board = \"serial:{}\"\nstart = [\"{start}\"]", port.display());
    let station = station.where_instead("station.toml", "board = \"mock,serial=1\"", &started);
    let serving = station.serve();
    fs::write(&port, "").unwrap();
    seen(&serving, "lane ready");
    serving.here().post("/scan", &[("text", SERIALS[0])]).send();
    (station, serving)
}

/// As on a full disk.
#[test]
fn an_abort_that_cannot_be_entered_is_done_all_the_same() {
    let (station, serving) = started_by("button");
    let lane =
        |act: &str| serving.here().post(&format!("/lanes/1/{act}"), &[("of", SERIALS[0])]).send().status;
    let scan = |text: &str| serving.here().post("/scan", &[("text", text)]).send().status;
    let database = rusqlite::Connection::open(station.path("data").join("station.db")).unwrap();
    seen(&serving, "lane waiting");
    database.execute_batch(NO_AUDIT).unwrap();
    assert_eq!((lane("start"), scan("HR:START")), (503, 503), "what else there is");
    assert_eq!(lane("abort"), 303);
    seen(&serving, "lane ready");
    database.execute_batch("DROP TRIGGER full").unwrap();
    scan(SERIALS[0]);
    seen(&serving, "lane waiting");
    database.execute_batch(NO_AUDIT).unwrap();
    assert_eq!(scan("HR:ABORT"), 200);
    seen(&serving, "lane ready");
    database.execute_batch("DROP TRIGGER full").unwrap();
    assert_eq!(lane("abort"), 409, "nothing is under way");
    let acts = "SELECT act || ' ' || detail FROM audit ORDER BY id";
    let [scan, abort] = ["scan", "lane HR:ABORT"].map(|act| format!("{act} {}", SERIALS[0]));
    assert_eq!(station.query(acts), [&*scan, &scan, &abort], "what could be entered");
}

/// A page without a script may be of any age: meanwhile a colleague's board may be in the lane.
#[test]
fn an_abort_ends_only_what_its_page_showed() {
    let (station, serving) = started_by("button");
    let abort = |of: &str| serving.here().post("/lanes/1/abort", &[("of", of)]).send();
    let shows = |serial: &str| format!("<input type=\"hidden\" name=\"of\" value=\"{serial}\">");
    let page = seen(&serving, "lane waiting");
    assert!(page.contains(&shows(SERIALS[0])), "{page}");
    assert_eq!(abort(SERIALS[0]).status, 303);
    seen(&serving, "lane ready");
    serving.here().post("/scan", &[("text", SERIALS[1])]).send();
    seen(&serving, &shows(SERIALS[1]));
    for old in [SERIALS[0], ""] {
        let late = abort(old);
        assert_eq!(late.status, 409, "{old}");
        assert!(late.text().contains("another board may be there by now"), "{old}: {}", late.text());
    }
    seen(&serving, &shows(SERIALS[1]));
    assert_eq!(abort(SERIALS[1]).status, 303);
    // The audit says what was meant, whatever became of it.
    let meant = station.query("SELECT detail FROM audit WHERE act = 'lane' ORDER BY id");
    let [first, second] = [0, 1].map(|number| format!("HR:ABORT {}", SERIALS[number]));
    assert_eq!(meant, [&*first, &first, "HR:ABORT", &second]);
}

/// Everything that the page offers is also accepted.
#[test]
fn a_lane_that_waits_says_what_starts_it() {
    for (start, does, has_button) in
        [("button", "press start", true), ("presence", "unplug the board, and plug it in again", false)]
    {
        let (_station, serving) = started_by(start);
        let page = seen(&serving, "lane waiting");
        assert!(page.contains(&format!("<p class=\"does\">{does}</p>")), "{page}");
        assert_eq!(page.contains("/lanes/1/start"), has_button, "{page}");
        assert!(page.contains("/lanes/1/abort") && !page.contains("/lanes/1/out"), "{page}");
    }
}
