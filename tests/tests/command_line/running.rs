//! Runs that receive signals.

use std::fs::File;
use std::path::Path;

use halfrow_tests::patience::{come_to_an_end, wait_until};
use halfrow_tests::program::{Folder, Running};

/// At 20,000 bytes a second the built-in frames would take an hour.
pub(crate) const SLOW: &str = "mock,pace=real,speed=20000";

/// Starts `halfrow` in `folder` with every signal handled by default, as from a user's shell, whatever started the tests.
pub(crate) fn started<'a>(folder: &Folder, arguments: impl IntoIterator<Item = &'a str>) -> Running {
    Running::start(&mut folder.by_shell("exec env --default-signal=INT,TERM,HUP \"$@\"", arguments))
}

/// A run on a slow board that has opened its session, and so handles signals.
pub(crate) fn streaming<'a>(folder: &Folder, arguments: impl IntoIterator<Item = &'a str>) -> Running {
    let call = ["verify", "-vv", "--json", "--board", SLOW];
    let mut running = started(folder, call.into_iter().chain(arguments));
    running.wait_for("session ");
    running
}

/// A run of `arguments` that is stopped while something half written is in `out`. A quick run may write everything between two
/// checks; then it is started again.
pub(crate) fn stopped_amid(folder: &Folder, arguments: &[&str]) -> Running {
    let out = folder.path().join("out");
    let is_hidden = |name: &str| name.starts_with('.');
    let mut running = started(folder, arguments.iter().copied());
    wait_until("something to be half written", || {
        if running.has_ended() {
            std::fs::remove_dir_all(&out).unwrap();
            running = started(folder, arguments.iter().copied());
        }
        if !has(&out, is_hidden) {
            return false;
        }
        running.stop();
        let is_amid = has(&out, is_hidden);
        if !is_amid {
            running.send("CONT");
        }
        is_amid
    });
    running
}

/// The write end of the pipe at `path`, once a program reads it.
pub(crate) fn opened_to_write(path: &Path) -> File {
    let path = path.to_owned();
    come_to_an_end(move || File::options().write(true).open(path).unwrap())
}

/// Waits until something in `folder` has a name that `is_wanted`.
pub(crate) fn until_there_is(folder: &Path, is_wanted: impl Fn(&str) -> bool) {
    wait_until("a file to come", || has(folder, &is_wanted));
}

fn has(folder: &Path, is_wanted: impl Fn(&str) -> bool) -> bool {
    let mut entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    entries.any(|entry| is_wanted(&entry.file_name().to_string_lossy()))
}
