//! Man pages and completions of the station, which packages contain.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::common::{Did, did, folder};

fn text(folder: &Path, page: &str) -> String {
    fs::read_to_string(folder.join(page)).unwrap_or_else(|error| panic!("{page}: {error}"))
}

#[test]
fn every_command_has_a_page_which_is_not_written_over_unless_asked() {
    let folder = folder();
    let to = folder.path().to_str().unwrap();
    assert_eq!(did(&["manual", to]).code, Some(0));
    assert!(text(folder.path(), "halfrow-station.1").contains(".TH halfrow-station 1"));
    assert!(text(folder.path(), "halfrow-station-user-add.1").contains("halfrow\\-station\\-user\\-add"));
    assert!(!folder.path().join("halfrow-station-lane.1").exists(), "a command that is hidden has a page");
    let help = did(&["--help"]).said;
    let listed = help.lines().skip_while(|line| *line != "Commands:").skip(1);
    // Names are indented by two columns, continued descriptions by more.
    let names = listed.take_while(|line| !line.is_empty()).filter_map(|line| line.strip_prefix("  "));
    let names: Vec<_> =
        names.filter(|line| !line.starts_with(' ')).filter_map(|line| line.split(' ').next()).collect();
    assert!(names.contains(&"serve") && names.contains(&"manual"), "{names:?}");
    for command in names.iter().filter(|name| **name != "help") {
        text(folder.path(), &format!("halfrow-station-{command}.1"));
    }
    assert_eq!(did(&["manual", to]).code, Some(2));
    assert_eq!(did(&["manual", to, "--overwrite"]).code, Some(0));
}

/// As by `halfrow manual`.
#[test]
fn no_page_is_written_if_one_is_in_the_way() {
    let folder = folder();
    let last = folder.path().join("halfrow-station.1");
    fs::write(&last, "precious").unwrap();
    let refused = did(&["manual", folder.path().to_str().unwrap()]);
    let told = ["--overwrite", "file-in-folder-exists"].map(|word| refused.complained.contains(word));
    assert!(refused.code == Some(2) && told == [true; 2], "{refused:?}");
    let names = fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name());
    assert_eq!(names.collect::<Vec<_>>(), ["halfrow-station.1"]);
    assert_eq!(text(folder.path(), "halfrow-station.1"), "precious");
    let below = did(&["manual", last.join("man").to_str().unwrap()]);
    assert!(below.code == Some(2) && below.complained.contains("file-not-written"), "{below:?}");
}

#[test]
fn bash_takes_the_completion_script() {
    let folder = folder();
    let script = folder.path().join("completions");
    fs::write(&script, did(&["completions", "bash"]).said).unwrap();
    let read = Command::new("bash")
        .args(["-euc", ". \"$1\"; complete -p halfrow-station", "-"])
        .arg(script)
        .output();
    let read: Did = read.unwrap().into();
    assert!(read.code == Some(0) && read.said.contains("halfrow-station"), "{read:?}");
}
