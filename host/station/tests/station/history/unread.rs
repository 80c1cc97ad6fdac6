//! Evidence that could not be read just then: the disk or the share had a fault, or the program had no descriptor left. It
//! may be sound.

use halfrow::result::sha256;
use halfrow_station::kept::backup;
use halfrow_station::store::Folder;

use super::commands::did;
use super::made::{End, Made, Run};
use crate::common::{did_refused, untold};

const OVERWRITTEN: &str = "cannot be read; put the file of that name";

/// A station's folder with a FAIL whose evidence is `seen`.
fn made() -> Made {
    let mut made = Made::new();
    made.run(&Run { evidence: vec!["seen"], ..Run::of("S1", End::Fail(&["memory"])) });
    made
}

/// Otherwise somebody puts an older file in the place of a sound one, and never learns of the disk.
#[test]
fn what_could_not_be_read_is_told_with_the_system_s_reason_and_not_called_damaged() {
    let made = made();
    let place = tempfile::tempdir().unwrap();
    let [copy, again] = ["copy", "again"].map(|name| place.path().join(name));
    backup(&made.folder(), &copy, &mut untold).unwrap();
    let paths = [made.as_ref(), &copy, &again].map(|path| path.to_str().unwrap().to_owned());
    let [data, copy_name, again] = [0, 1, 2].map(|at| paths[at].as_str());
    let of = |folder: &Folder| folder.blobs().path(&sha256([b"seen"]));
    let evidence = of(&made.folder());
    for (what, reason) in
        [("read:error=EIO", "Input/output error"), ("openat:error=EMFILE", "Too many open files")]
    {
        let did = did_refused(&evidence, what, &["check", "--data", data]);
        let is_told = did.said.contains(reason) && did.said.contains("read it again");
        assert!(did.code == Some(3) && is_told && !did.said.contains(OVERWRITTEN), "{did:?}");
        let did = did_refused(&of(&Folder::new(&copy)), what, &["restore", copy_name, "--data", again]);
        let is_told = did.complained.contains(reason) && did.complained.contains("read it again");
        assert!(did.code == Some(3) && is_told && !did.complained.contains(OVERWRITTEN), "{did:?}");
    }
    std::fs::remove_file(&evidence).unwrap();
    let (code, said, _) = did(&made, &["check"]);
    assert!(code == 3 && said.contains(OVERWRITTEN), "the control: {said}");
}

/// A backup says what it lacks in the words of `check`.
#[test]
fn a_backup_says_why_it_lacks_what_could_not_be_read() {
    let made = made();
    let nobody_s = made.folder().blobs().put(b"nobody's").unwrap();
    let place = tempfile::tempdir().unwrap();
    let copy = place.path().join("copy");
    let call = ["backup", copy.to_str().unwrap(), "--data", made.as_ref().to_str().unwrap()];
    let did = did_refused(&made.folder().blobs().path(&nobody_s), "read:error=EIO", &call);
    assert!(did.code == Some(3) && did.said.contains("Input/output error"), "{did:?}");
}
