//! Folders that may be written but not listed, such as drop boxes.

use std::fs::{self, Permissions};
use std::os::unix::fs::PermissionsExt as _;

use halfrow_tests::program::{Folder, finish};

use crate::small;

#[test]
fn what_is_whole_in_a_folder_that_cannot_be_listed_is_not_said_to_be_lost() {
    let folder = Folder::new();
    let drop = folder.path().join("drop");
    fs::create_dir(&drop).unwrap();
    fs::set_permissions(&drop, Permissions::from_mode(0o1333)).unwrap();
    let calls = [
        (small("verify", &["--report", "drop/r", "--record", "drop/run.rec"]), "drop/r/report.json"),
        (small("tables", &["-o", "drop/t.json"]), "drop/t.json"),
        (small("correct", &["builtin:black", "--model", "-o", "drop/o.pgm"]), "drop/o.pgm"),
    ];
    for (call, made) in calls {
        finish(&mut folder.as_nobody(&call)).succeeded();
        assert!(folder.path().join(made).is_file(), "{made}");
    }
    fs::set_permissions(&drop, Permissions::from_mode(0o755)).unwrap();
    assert_eq!(folder.names("drop"), ["o.pgm", "r", "run.rec", "t.json"]);
}
