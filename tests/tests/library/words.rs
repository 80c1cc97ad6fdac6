//! The words of the libraries: they name settings, and only the program names flags.

use std::fs;
use std::path::{Path, PathBuf};

const LIBRARIES: [&str; 4] = ["host/files/src", "host/frames/src", "host/link/src", "host/judge/src"];

pub(crate) fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

pub(crate) fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
}

/// The lines of the libraries except comments, with the files that they are in. A string that is continued by a `\` counts as one
/// line.
fn lines() -> Vec<(String, String)> {
    let mut files = Vec::new();
    LIBRARIES.iter().for_each(|library| sources(&root().join(library), &mut files));
    let mut lines = Vec::new();
    for file in files {
        let text = fs::read_to_string(&file).unwrap();
        let code: Vec<_> = text.lines().map(str::trim_start).filter(|line| !line.starts_with("//")).collect();
        let whole = code.join("\n").replace("\\\n", "");
        lines.extend(whole.lines().map(|line| (file.display().to_string(), line.to_owned())));
    }
    lines
}

/// Whether the text contains a flag, such as `--overwrite`.
fn names_a_flag(line: &str) -> bool {
    let behind = line.match_indices("--").map(|(place, dashes)| &line[place + dashes.len()..]);
    let mut behind = behind.filter_map(|rest| rest.chars().next());
    behind.any(|letter| letter.is_ascii_lowercase())
}

#[test]
fn no_library_names_a_flag() {
    assert!(names_a_flag("or raise --retry-limit\""));
    let lines = lines();
    assert!(lines.len() > 5000, "only {} lines were found", lines.len());
    let flags: Vec<_> = lines.iter().filter(|(_, line)| names_a_flag(line)).collect();
    assert!(flags.is_empty(), "{flags:#?}");
}

#[test]
fn every_setting_that_the_program_has_a_flag_for_is_named_by_a_library() {
    let lines = lines();
    for (setting, flag) in halfrow_cli::flags::FLAGS {
        assert!(lines.iter().any(|(_, line)| line.contains(setting)), "nobody says `{setting}` ({flag})");
    }
}
