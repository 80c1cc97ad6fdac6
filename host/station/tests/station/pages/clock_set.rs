//! Pages of a station whose clock is set while somebody works with them.

use super::station::{SERIALS, Serving, Station};
use crate::clocks::Clocks;
use crate::common::until;

/// Otherwise the next person's board would be tested in the lane that somebody else has chosen.
#[test]
fn without_a_script_a_lane_is_chosen_for_fifteen_seconds_however_the_clock_is_set() {
    let station = Station::private(2);
    let clocks = Clocks::in_folder(&station.path(""));
    let serving = Serving::of(clocks.of(&mut station.command()));
    let here = serving.here();
    let scan = |text: &str, more: &[(&str, &str)]| {
        here.post("/scan", &[&[("text", text), ("typed", "true")], more].concat()).send().text()
    };
    let is_over = |set: i64, passed: i64| {
        clocks.ahead(0, 0);
        let chosen = scan("HR:LANE:2", &[]);
        let (_, made) = chosen.split_once("name=\"made_ms\" value=\"").unwrap();
        let (made, _) = made.split_once('"').unwrap();
        clocks.ahead(set, passed);
        let said = scan(SERIALS[0], &[("lane", "2"), ("chosen", "2"), ("made_ms", made)]);
        said.contains("lane 2 was chosen more than 15 s ago")
    };
    for set in [-3600, 0, 3600] {
        assert!(is_over(set, 16), "set by {set} s");
        // A busy computer may take longer than that.
        until("a scan in time", || !is_over(set, 0));
    }
}

/// In one hour of the year a time without its offset is either of two.
#[test]
fn when_a_verdict_was_saved_is_shown_with_the_offset_to_whoever_points_at_it() {
    let station = Station::private(1);
    let serving = Serving::of(station.command().env("TZ", "IST-5:30"));
    serving.here().post("/scan", &[("text", SERIALS[0])]).until_taken();
    let page = serving.here().get("/").until("lane pass");
    let (_, saved) = page.split_once("class=\"saved\"").unwrap();
    let (title, _) = saved.split_once("title=\"").unwrap().1.split_once('"').unwrap();
    assert!(title.ends_with(" +05:30"), "{title}");
}
