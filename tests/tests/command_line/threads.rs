//! A user who may have no more threads or files than it takes to begin. Root has no limit on threads, so those tests run as
//! another user.

use std::fs::{self, Permissions};
use std::os::unix::fs::PermissionsExt as _;

use halfrow_tests::program::{Ended, Folder, finish};

use crate::small;

#[test]
fn one_thread_does_what_all_would_share() {
    let folder = Folder::new();
    fs::create_dir(folder.path().join("out")).unwrap();
    fs::set_permissions(folder.path().join("out"), Permissions::from_mode(0o777)).unwrap();
    let call = small("correct", &["builtin:black", "builtin:noise", "--model", "-o", "out"]);
    let Some(mut command) = folder.within("--nproc=2", &call) else { return };
    finish(&mut command).succeeded();
    assert_eq!(folder.names("out"), ["black.pgm", "noise.pgm"]);
}

#[test]
fn a_program_that_cannot_begin_for_want_of_processes_says_what_it_wants() {
    let folder = Folder::new();
    let Some(mut command) = folder.within("--nproc=1", &["faults", "--json"]) else { return };
    wants_more(&finish(&mut command));
}

/// This limit is per process, so it also holds for root.
#[test]
fn a_program_that_cannot_begin_for_want_of_files_says_what_it_wants() {
    let folder = Folder::new();
    wants_more(&finish(&mut folder.by_shell("ulimit -n 4; exec \"$@\"", ["faults", "--json"])));
}

#[track_caller]
fn wants_more(ended: &Ended) {
    assert_eq!(ended.code, Some(3), "{}{}", ended.stdout, ended.stderr);
    let said =
        "cannot wait for signals; end other programs, or allow this user more processes and open files";
    assert!(ended.stderr.contains(said), "{}", ended.stderr);
    assert_eq!(ended.json()["error"]["code"], "signals-unheard");
}
