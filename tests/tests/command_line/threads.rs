//! A user who may have no more threads or files than it takes to begin. Root has no such limit, so that these run as another user.

use std::fs::{self, Permissions};
use std::os::unix::fs::PermissionsExt as _;

use halfrow_tests::program::{Folder, finish};

use crate::small;

#[test]
fn one_thread_does_what_all_would_share() {
    let folder = Folder::new();
    fs::create_dir(folder.path().join("out")).unwrap();
    fs::set_permissions(folder.path().join("out"), Permissions::from_mode(0o777)).unwrap();
    let call = small("correct", &["builtin:black", "builtin:noise", "--model", "-o", "out"]);
    let Some(mut command) = folder.within("--nproc=2", &call) else { return };
    let ended = finish(&mut command);
    assert_eq!(ended.code, Some(0), "{}{}", ended.stdout, ended.stderr);
    assert_eq!(folder.names("out"), ["black.pgm", "noise.pgm"]);
}

#[test]
fn a_program_that_cannot_begin_says_what_it_wants() {
    for limit in ["--nproc=1", "--nofile=4"] {
        let folder = Folder::new();
        let Some(mut command) = folder.within(limit, &["faults", "--json"]) else { return };
        let ended = finish(&mut command);
        assert_eq!(ended.code, Some(3), "{limit}: {}{}", ended.stdout, ended.stderr);
        let said =
            "cannot wait for signals; end other programs, or allow this user more processes and open files";
        assert!(ended.stderr.contains(said), "{limit}: {}", ended.stderr);
        assert_eq!(ended.json()["error"]["code"], "signals-unheard", "{limit}");
    }
}
