//! Whoever guesses the badges and passwords of others.

use std::thread;

use super::station::{Browser, PUBLIC, Station};

#[test]
fn many_who_guess_at_once_guess_no_oftener() {
    let station = Station::public(1);
    let serving = station.serve();
    let browser = serving.browser(PUBLIC);
    // Checking a password takes a while.
    let guess = browser.post("/login", &[("badge", "B-0022"), ("password", "wrong horse")]);
    let guesses: Vec<_> =
        (0..30).map(|_| guess.clone()).map(|one| thread::spawn(move || one.send())).collect();
    let statuses: Vec<_> = guesses.into_iter().map(|guess| guess.join().unwrap().status).collect();
    let of = |status| statuses.iter().filter(|one| **one == status).count();
    assert_eq!((of(403), of(429)), (10, 20), "{statuses:?}");
}

/// docs/station-lanes.md: 120 scans a minute by one person, on however many screens.
#[test]
fn whoever_is_logged_in_does_not_guess_the_badges_of_others_for_long() {
    let station = Station::public(1);
    let serving = station.serve();
    let scan = |browser: &Browser, text: &str| {
        browser.post("/scan", &[("text", text)]).with("accept", "application/json").send()
    };
    let screens = [serving.operator(), serving.operator()];
    for wrong in 0..119 {
        assert_eq!(scan(&screens[wrong % 2], &format!("B-1{wrong:03}")).status, 200, "{wrong}");
    }
    // A barcode of the station is no guess.
    for _ in 0..120 {
        assert_eq!(scan(&screens[0], "HR:LANE:1").status, 200);
    }
    // Nobody begins anew by logging in again.
    let again = serving.operator();
    assert_eq!(scan(&again, "B-1119").status, 200);
    for browser in screens.iter().chain([&again, &serving.operator()]) {
        assert_eq!(scan(browser, "B-0022").status, 429, "also if it is right");
    }
    let aborted = scan(&again, "HR:ABORT");
    assert!(aborted.status == 200 && aborted.text().contains("nothing is under way"), "{}", aborted.text());
    // The control: another person, from the same address.
    let braun = serving.logged_in("B-0022", "");
    assert_eq!(scan(&braun, "A-1000").status, 200);
    assert!(scan(&braun, "A-0017").text().contains("Weber tests from now on"));
}

/// docs/station-lanes.md: ten failures a minute from one address lead to a wait.
#[test]
fn whoever_scans_the_stations_own_barcodes_before_a_badge_has_not_guessed() {
    let station = Station::public(1);
    let serving = station.serve();
    let browser = serving.browser(PUBLIC);
    let scan = |text: &str| browser.post("/scan", &[("text", text)]).send().status;
    for barcode in ["HR:LANE:1", "HR:START", "HR:ABORT", "HR:MOCK"].iter().cycle().take(12) {
        assert_eq!(scan(barcode), 401, "{barcode}");
    }
    assert_eq!(scan("A-0017"), 303, "the badge");
}
