//! A station at work whose folder is moved away, or whose disk is unmounted.

use std::fs;

use super::ends::connected;
use super::floor::{SERIALS, Station};
use crate::common::silent_board;

/// An empty folder in its place is what is seen of a mount point then.
#[test]
fn a_folder_that_is_moved_away_is_not_made_anew_and_once_it_is_back_nothing_is_lost() {
    for is_mount_point in [false, true] {
        let (listener, silent) = silent_board();
        let station = Station::with(&[&silent, "mock"], "");
        let mut running = station.start();
        let [data, aside] = ["data", "aside"].map(|name| station.path(name));
        running.test("1", SERIALS[0]);
        connected(&listener);
        fs::rename(&data, &aside).unwrap();
        if is_mount_point {
            fs::create_dir(&data).unwrap();
        }
        drop(listener);
        let gone = "/data cannot be used; check that it is there, is writable and has space";
        let unsaved = running.state("1", "UNSAVED");
        let note = unsaved["note"].as_str().unwrap();
        assert!(unsaved["shown"].is_null() && note.contains("could not be saved"), "{unsaved}");
        assert!(note.contains(gone), "{unsaved}");
        running.test("2", SERIALS[1]);
        running.wait("why no run begins", |news| {
            news["lane"] == "2" && news["note"].as_str().is_some_and(|note| note.contains(gone))
        });
        let made = || fs::read_dir(&data).map(Iterator::count);
        assert_eq!(made().ok(), is_mount_point.then_some(0));
        // The control: there was nothing to keep it from that.
        fs::create_dir_all(data.join("other")).unwrap();
        fs::remove_dir_all(&data).unwrap();
        fs::rename(&aside, &data).unwrap();
        let ended = running.state("1", "ERROR");
        assert!(ended["shown"]["headline"].as_str().unwrap().contains("could not be saved"), "{ended}");
        running.test("2", SERIALS[1]);
        running.state("2", "PASS");
        assert_eq!(running.end().0, Some(0));
        assert_eq!(station.query("SELECT verdict FROM run ORDER BY id"), ["ERROR", "PASS"]);
        station.assert_well();
    }
}
