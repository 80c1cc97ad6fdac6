//! Scans and boards that the program as a whole refuses.

use super::floor::{SERIALS, Station};

#[test]
fn a_scan_that_is_refused_begins_nothing() {
    let station = Station::with(&["mock,serial=1", "mock,serial=2"], "[scanner]\nprefix = \"]C1\"\n");
    let mut running = station.start();
    running.scan(SERIALS[0]);
    assert!(running.answer(SERIALS[0]).1.contains("without what the scanner adds"));
    for (scan, said) in [
        (format!("]C1{}", SERIALS[0]), "scan the barcode of one first"),
        ("]C1HR:LANE:7".to_owned(), "there is no lane 7"),
        ("]C1HR:LUNCH".to_owned(), "is no barcode of the station"),
        ("]C1HR:START".to_owned(), "scan the barcode of one first"),
    ] {
        running.scan(&scan);
        let (is_taken, answer) = running.answer(&scan);
        assert!(!is_taken && answer.contains(said), "{scan}: {answer}");
    }
    assert_eq!(running.end().0, Some(0));
    assert_eq!(station.query("SELECT id FROM run"), Vec::<String>::new());
}

/// Such bytes come from a scanner with another character set, or over a disturbed line.
#[test]
fn a_scan_that_is_no_text_is_refused_and_the_next_one_is_taken() {
    let station = Station::with(&["mock"], "");
    let mut running = station.start();
    running.scan_bytes(b"CA01\xff31103628");
    assert!(!running.answer("CA01\u{fffd}31103628").0);
    running.test("1", SERIALS[0]);
    running.state("1", "PASS");
    assert_eq!(running.end().0, Some(0));
}

/// The two kinds of mis-scan that no check digit finds: each board under the other's number.
#[test]
fn boards_that_were_exchanged_are_refused_before_a_frame_is_sent() {
    let station = Station::with(&["mock,serial=1", "mock,serial=2"], "");
    let mut running = station.start();
    for (lane, serial) in [("1", SERIALS[0]), ("2", SERIALS[1])] {
        running.test(lane, serial);
        running.state(lane, "PASS");
    }
    for (lane, serial) in [("1", SERIALS[1]), ("2", SERIALS[0])] {
        running.test(lane, serial);
        let ended = running.state(lane, "ERROR");
        let said = format!("you scanned {serial}");
        assert!(ended["shown"]["headline"].as_str().unwrap().contains(&said), "{ended}");
    }
    // A new label on a known board, and a known label on a new one.
    running.test("1", SERIALS[2]);
    running.state("1", "RUNNING");
    running.state("1", "ERROR");
    let judged =
        "SELECT step.outcome FROM step JOIN run ON run.id = run_id WHERE verdict = 'ERROR' AND seq > 1";
    assert_eq!(station.query(judged), ["skipped"; 3]);
    for (lane, serial) in [("1", SERIALS[0]), ("2", SERIALS[1])] {
        running.test(lane, serial);
        running.state(lane, "RUNNING");
        running.state(lane, "PASS");
    }
    assert_eq!(running.end().0, Some(0));
    station.assert_well();
}

#[test]
fn a_lane_is_taken_out_of_service_and_put_back() {
    let station = Station::with(&["mock"], "");
    let mut running = station.start();
    running.scan("HR:OUT");
    running.state("1", "OUT");
    running.scan(SERIALS[0]);
    assert!(running.answer(SERIALS[0]).1.contains("is out of service"));
    running.scan("HR:IN");
    running.state("1", "READY");
    running.scan(SERIALS[0]);
    running.state("1", "PASS");
    assert_eq!(running.end().0, Some(0));
}
