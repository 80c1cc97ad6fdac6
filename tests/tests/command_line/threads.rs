//! A user who may have no more threads or files than it takes to begin. Root has no such limit, so that these run as another user.

use std::fs;
use std::os::unix::fs::MetadataExt as _;
use std::process::Command;

use halfrow_tests::program::{Ended, Folder, finish};

use crate::small;

/// Nobody else runs anything by this number, whose processes are counted.
const ALONE: u32 = 65_533;

/// Runs `halfrow` under `limit` of prlimit, as a user who runs nothing else. None where nobody can become that user.
fn limited(folder: &Folder, limit: &str, call: &[&str]) -> Option<Ended> {
    if fs::metadata(folder.path()).unwrap().uid() != 0 {
        return None;
    }
    let plain = folder.as_nobody(call);
    let mut command = Command::new("setpriv");
    command.arg(format!("--reuid={ALONE}")).args(["--regid=65534", "--clear-groups", "prlimit", limit]);
    command.arg(plain.get_program()).args(plain.get_args()).current_dir(folder.path());
    command.env("XDG_CONFIG_HOME", "/nonexistent").env("HALFROW_SETTINGS", "/dev/null");
    Some(finish(&mut command))
}

#[test]
fn one_thread_does_what_all_would_share() {
    let folder = Folder::new();
    fs::create_dir(folder.path().join("out")).unwrap();
    std::os::unix::fs::chown(folder.path().join("out"), Some(ALONE), None).unwrap_or_default();
    let call = small("correct", &["builtin:black", "builtin:noise", "--model", "-o", "out"]);
    let Some(ended) = limited(&folder, "--nproc=2", &call) else { return };
    assert_eq!(ended.code, Some(0), "{}{}", ended.stdout, ended.stderr);
    assert_eq!(folder.names("out"), ["black.pgm", "noise.pgm"]);
}

#[test]
fn a_program_that_cannot_begin_says_what_it_wants() {
    for limit in ["--nproc=1", "--nofile=4"] {
        let Some(ended) = limited(&Folder::new(), limit, &["faults", "--json"]) else { return };
        assert_eq!(ended.code, Some(3), "{limit}: {}{}", ended.stdout, ended.stderr);
        let said =
            "cannot wait for signals; end other programs, or allow this user more processes and open files";
        assert!(ended.stderr.contains(said), "{limit}: {}", ended.stderr);
        assert_eq!(ended.json()["error"]["code"], "signals-unheard", "{limit}");
    }
}
