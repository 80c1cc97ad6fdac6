//! Runs that are sent signals.

use std::path::Path;

use halfrow_tests::patience::wait_until;
use halfrow_tests::program::{Folder, Running};

/// At 20,000 bytes a second the built-in frames would take an hour.
pub(crate) const SLOW: &str = "mock,pace=real,speed=20000";

/// Starts `halfrow` in `folder` with every signal as a user's shell leaves it, whatever started the tests.
pub(crate) fn started<'a>(folder: &Folder, arguments: impl IntoIterator<Item = &'a str>) -> Running {
    Running::start(&mut folder.by_shell("exec env --default-signal=INT,TERM,HUP \"$@\"", arguments))
}

/// A run on a slow board that has its session, and so hears signals.
pub(crate) fn streaming<'a>(folder: &Folder, arguments: impl IntoIterator<Item = &'a str>) -> Running {
    let call = ["verify", "-vv", "--json", "--board", SLOW];
    let mut running = started(folder, call.into_iter().chain(arguments));
    running.wait_for("session ");
    running
}

/// Stops a run where something half written is in `folder`.
pub(crate) fn stop_amid(running: &Running, folder: &Path) {
    let is_hidden = |name: &str| name.starts_with('.');
    wait_until("something to be half written", || {
        if !has(folder, is_hidden) {
            return false;
        }
        running.stop();
        let is_amid = has(folder, is_hidden);
        if !is_amid {
            running.send("CONT");
        }
        is_amid
    });
}

/// Waits until something in `folder` has a name that `is_wanted`.
pub(crate) fn until_there_is(folder: &Path, is_wanted: impl Fn(&str) -> bool) {
    wait_until("a file to come", || has(folder, &is_wanted));
}

fn has(folder: &Path, is_wanted: impl Fn(&str) -> bool) -> bool {
    let mut entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    entries.any(|entry| is_wanted(&entry.file_name().to_string_lossy()))
}
