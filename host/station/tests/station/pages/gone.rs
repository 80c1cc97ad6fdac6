//! Pages of a station whose folder is moved away, or whose disk is unmounted.

use std::fs;

use crate::pages::station::Station;

/// An empty folder in its place is what is seen of a mount point then.
#[test]
fn lanes_are_shown_while_the_folder_is_away_and_no_page_asks_for_another_one() {
    let station = Station::private(1);
    let serving = station.serve();
    let here = serving.here();
    let [data, aside] = ["data", "aside"].map(|name| station.path(name));
    let gone = "/data cannot be used; check that it is there, is writable and has space";
    for is_mount_point in [false, true] {
        fs::rename(&data, &aside).unwrap();
        if is_mount_point {
            fs::create_dir(&data).unwrap();
        }
        for path in ["/history", "/yield", "/outbox"] {
            let answer = here.get(path).send();
            assert!(answer.status == 503 && answer.text().contains(gone), "{path}: {}", answer.text());
        }
        for path in ["/", "/still"] {
            let answer = here.get(path).send();
            let shown = answer.text();
            assert!(answer.status == 200 && shown.contains("id=\"lane-1\""), "{path}: {shown}");
            let (_, today) = shown.split_once("<footer id=\"today\"").unwrap();
            assert!(today.contains(gone), "{path}: {today}");
        }
        let today = here.get("/today").send();
        let told = today.text();
        assert!(today.status == 200 && told.contains("data-again") && told.contains(gone), "{told}");
        if is_mount_point {
            fs::remove_dir(&data).unwrap();
        }
        fs::rename(&aside, &data).unwrap();
        assert!(here.get("/").send().text().contains(": 0 judged, 0 for"), "the control");
    }
}
