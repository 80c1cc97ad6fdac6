//! What the program says of a call that it cannot use, and of names that it is given.

use crate::common::{PLAN, did};
use crate::runs::bench::Station;

/// It conceals what follows, and begins a line as a verdict does.
#[test]
fn a_folder_s_name_begins_no_line() {
    let station = Station::with(PLAN);
    station.run("CAT00001", "mock,fault=stuck-data");
    let data = station.data().display().to_string();
    let to = |name: &str| station.path(&format!("{name}\u{1b}[8m\nPASS")).display().to_string();
    let run = &station.query("SELECT id FROM run")[0];
    let [exported, copied, kept] = ["exported", "copied", "kept"].map(to);
    for call in [&["export", "--to", &exported][..], &["evidence", run, "--to", &copied], &["backup", &kept]]
    {
        let told = did(&[call, &["--data", &data]].concat());
        assert_eq!(told.code, Some(0), "{call:?}: {told:?}");
        assert!(told.said.contains("\\u{1b}[8m\\nPASS") && told.said.lines().count() == 1, "{told:?}");
    }
}
