//! The command line from outside: what it prints, what it writes, what it refuses, and with which exit code.

// clippy.toml allows it inside #[test] functions, but not in the functions that several tests call.
#![allow(clippy::unwrap_used, clippy::panic)]

mod at_once;
mod bad_calls;
mod bad_frames;
mod bad_tables;
mod bad_targets;
mod contradictions;
mod corrected;
mod documents;
mod explained;
mod file_schemas;
mod grids;
mod hashed;
mod help;
mod info;
mod lenses;
mod load;
mod made_files;
mod measured;
mod names;
mod origins;
mod outputs;
mod paper;
mod photographs;
mod pool;
mod previewed;
mod replay;
mod report_folder;
mod running;
mod settings;
mod signals;
#[cfg(feature = "sim")]
mod simulated;
mod station;
mod streams;
mod threads;
mod unfit_lenses;
mod unlisted;
mod varied;
mod verdicts;
mod void_faults;
mod within;

use halfrow_tests::program::{Ended, Folder};

/// The options of a frame so small that a whole run takes a moment.
const SMALL: [&str; 4] = ["--width", "128", "--height", "16"];

/// `command`, then the size of a small frame, then `more`.
fn small<'a>(command: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    [command].into_iter().chain(SMALL).chain(more.iter().copied()).collect()
}

/// Runs a wrong call. It must end with `code`, print `sentence` on stderr and nothing on stdout, and write nothing.
#[track_caller]
fn refused_with(code: i32, folder: &Folder, arguments: &[&str], sentence: &str) -> Ended {
    let before = folder.names(".");
    let ended = folder.halfrow(arguments.iter().copied());
    assert_eq!(ended.code, Some(code), "{arguments:?}: {}{}", ended.stdout, ended.stderr);
    assert!(ended.stderr.contains(sentence), "{arguments:?} says: {}", ended.stderr);
    assert_eq!(ended.stdout, "", "{arguments:?}");
    assert_eq!(folder.names("."), before, "{arguments:?}");
    ended
}

/// Like [`refused_with`], with the exit code of wrong usage.
#[track_caller]
fn refused(folder: &Folder, arguments: &[&str], sentence: &str) {
    refused_with(2, folder, arguments, sentence);
}
