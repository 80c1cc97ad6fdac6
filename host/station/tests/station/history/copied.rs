//! Copies of a station that is not as it should be, and on a disk that is not.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use halfrow_station::kept::{backup, restore};
use halfrow_station::progress::Progress;
use halfrow_station::store::{Folder, Store, StoreError};
use tempfile::TempDir;

use super::commands::did;
use super::made::{End, Made, Run};
use crate::common::{Did, check, program, query, untold};

/// A FAIL with evidence, the path of that within a station's folder, and a place for copies.
fn failed() -> (Made, PathBuf, TempDir) {
    let mut made = Made::new();
    made.run(&Run { evidence: vec!["seen"], ..Run::of("S1", End::Fail(&["memory"])) });
    let hash = &query(made.as_ref(), "SELECT sha256 FROM attachment")[0];
    let path = PathBuf::from("blobs").join(&hash[..2]).join(hash);
    (made, path, tempfile::tempdir().unwrap())
}

/// Otherwise a station with one bad sector would have no copy of all the rest.
#[test]
fn a_copy_lacks_what_is_damaged_or_lost_and_has_all_the_rest() {
    let (made, evidence, place) = failed();
    let [whole, damaged, lost] = ["whole", "damaged", "lost"].map(|name| place.path().join(name));
    assert_eq!(backup(&made.folder(), &whole, &mut untold).unwrap().evidence, 2);
    let of_station = made.folder().path().join(&evidence);
    for copy in [&damaged, &lost] {
        if copy == &damaged {
            fs::write(&of_station, "other").unwrap();
        } else {
            fs::remove_file(&of_station).unwrap();
        }
        let (code, said, complained) = did(&made, &["backup", copy.to_str().unwrap()]);
        assert_eq!((code, complained.as_str()), (3, ""), "{said}");
        assert!(said.starts_with("fault: evidence of run "), "{said}");
        assert!(said.contains("1 run and 1 piece of evidence are in "), "{said}");
        assert!(said.contains("; `restore` refuses it for 1 fault"), "{said}");
    }
    // Put back by hand, as the fault says, it is a copy like any other.
    let to = lost.join(&evidence);
    fs::create_dir_all(to.parent().unwrap()).unwrap();
    fs::copy(whole.join(evidence), to).unwrap();
    restore(&Folder::new(&lost), &place.path().join("again"), &mut untold).unwrap();
}

/// People look for space where an error tells them to.
#[test]
fn a_copy_without_room_names_the_disk_that_is_full() {
    let (made, _, place) = failed();
    let copy = place.path().join("copy");
    let mut full = Command::new("strace");
    full.args(["-qq", "-o", "/dev/null", "-e", "inject=pwrite64:error=ENOSPC"]).arg(program()).arg("backup");
    let did = Did::from(full.arg(&copy).arg("--data").arg(made.as_ref()).output().unwrap());
    assert_eq!(did.code, Some(3), "{did:?}");
    assert!(did.complained.contains(place.path().to_str().unwrap()), "{did:?}");
    assert!(!did.complained.contains(made.as_ref().to_str().unwrap()), "{did:?}");
    assert_eq!(fs::read_dir(place.path()).unwrap().count(), 0, "what was begun is removed");
}

/// `restore` from `copy` to `to` while the disk refuses this call.
fn restored(copy: &Path, to: &Path, refused: &str) -> Did {
    let mut call = Command::new("strace");
    call.args(["-qq", "-o", "/dev/null", "-e", refused]).arg(program()).arg("restore").arg(copy);
    call.arg("--data").arg(to).output().unwrap().into()
}

/// Else a station could begin on results that a power cut takes away.
#[test]
fn of_a_copy_whose_names_the_disk_did_not_take_nothing_stays() {
    let (made, _, place) = failed();
    let [copy, new, empty, trace] = ["copy", "new", "empty", "trace"].map(|name| place.path().join(name));
    backup(&made.folder(), &copy, &mut untold).unwrap();
    for is_there in [false, true] {
        let to = if is_there { &empty } else { &new };
        let begin = || {
            if is_there {
                fs::create_dir(to).unwrap();
            }
        };
        begin();
        let mut call = Command::new("strace");
        call.args(["-qq", "-e", "trace=fsync", "-o"]).arg(&trace).arg(program()).arg("restore").arg(&copy);
        assert!(call.arg("--data").arg(to).status().unwrap().success());
        let last = fs::read_to_string(&trace).unwrap().lines().count();
        fs::remove_dir_all(to).unwrap();
        begin();
        let did = restored(&copy, to, &format!("inject=fsync:error=EIO:when={last}"));
        assert_eq!(did.code, Some(3), "{did:?}");
        // The lock of whoever restores stays in a folder that was there.
        let kept = fs::read_dir(to)
            .map_or(0, |left| left.filter(|one| one.as_ref().unwrap().file_name() != "station.lock").count());
        assert_eq!((kept, to.exists()), (0, is_there), "{did:?}");
        restore(&Folder::new(&copy), to, &mut untold).unwrap();
        assert_eq!(check(to).code, Some(0));
    }
}

#[test]
fn whoever_restores_a_copy_is_told_how_far_that_has_come() {
    let (made, _, place) = failed();
    let [copy, to] = ["copy", "to"].map(|name| place.path().join(name));
    backup(&made.folder(), &copy, &mut untold).unwrap();
    let mut told = Vec::new();
    restore(&Folder::new(&copy), &to, &mut |progress| told.push(progress)).unwrap();
    let progress = |what, done, of| Progress { what, done, of: Some(of) };
    let read = progress("entries read", 1, 1);
    let copied = [1, 2].map(|done| progress("pieces of evidence copied", done, 2));
    assert_eq!(told, [read, copied[0], copied[1], read]);
}

/// Every piece needs its folder's name and its own on the disk, but no folder more than once.
#[test]
fn each_folder_of_a_copys_evidence_is_brought_to_the_disk_once() {
    let (made, _, place) = failed();
    let [copy, to, trace] = ["copy", "to", "trace"].map(|name| place.path().join(name));
    backup(&made.folder(), &copy, &mut untold).unwrap();
    let mut call = Command::new("strace");
    call.args(["-y", "-qq", "-e", "trace=fsync", "-o"]).arg(&trace).arg(program()).arg("restore").arg(&copy);
    assert!(call.arg("--data").arg(&to).status().unwrap().success());
    let calls = fs::read_to_string(&trace).unwrap();
    let blobs = fs::read_dir(to.join("blobs")).unwrap().map(|entry| entry.unwrap().file_name());
    let folders: Vec<_> = blobs.map(|name| format!("/.partial/blobs/{}>", name.display())).collect();
    assert!(folders.len() > 1, "{folders:?}");
    for folder in folders.iter().map(String::as_str).chain(["/.partial/blobs>"]) {
        assert_eq!(calls.matches(folder).count(), 1, "{folder}: {calls}");
    }
}

/// A station could begin anew in it, since nothing marks it, and no later try would replace that.
#[test]
fn of_a_folder_that_was_made_for_a_copy_nothing_stays_when_the_copy_cannot_begin() {
    let (made, _, place) = failed();
    let [copy, to] = ["copy", "to"].map(|name| place.path().join(name));
    backup(&made.folder(), &copy, &mut untold).unwrap();
    let mut left = ["fsync:error=EIO:when=1", "mkdir:error=ENOSPC:when=2", "flock:error=ENOLCK"].to_vec();
    left.retain(|refused| {
        let did = restored(&copy, &to, &format!("inject={refused}"));
        assert_eq!(did.code, Some(3), "{refused}: {did:?}");
        fs::remove_dir_all(&to).is_ok()
    });
    assert_eq!(left, [""; 0]);
}

/// As where the power fails: a station that began anew would be in the copy's way.
#[test]
fn no_station_begins_where_a_restore_was_killed_that_made_its_folder() {
    let (made, _, place) = failed();
    let [copy, to] = ["copy", "to"].map(|name| place.path().join(name));
    backup(&made.folder(), &copy, &mut untold).unwrap();
    restored(&copy, &to, "inject=renameat2:signal=SIGKILL");
    let refused = Store::open(&Folder::new(&to)).unwrap_err();
    assert!(matches!(refused, StoreError::Unrestored { .. }), "{refused:?}");
    fs::remove_dir_all(to.join(".partial")).unwrap();
    restore(&Folder::new(&copy), &to, &mut untold).unwrap();
    assert_eq!(check(&to).code, Some(0));
}

/// An empty folder beside them makes no results worse.
#[test]
fn a_copy_is_made_though_the_folder_in_which_it_was_begun_stays() {
    let (made, _, place) = failed();
    let [copy, to] = ["copy", "to"].map(|name| place.path().join(name));
    backup(&made.folder(), &copy, &mut untold).unwrap();
    fs::create_dir(&to).unwrap();
    let did = restored(&copy, &to, "inject=rmdir,unlinkat:error=EIO");
    assert_eq!(did.code, Some(0), "{did:?}");
    assert!(to.join(".partial").exists(), "the control");
    assert_eq!(check(&to).code, Some(0));
}

/// A kill in between leaves nothing that looks like a station with only some of its evidence.
#[test]
fn of_a_copy_that_comes_into_a_folder_the_database_comes_last() {
    let (made, _, place) = failed();
    let [copy, to, renamed] = ["copy", "to", "renamed"].map(|name| place.path().join(name));
    backup(&made.folder(), &copy, &mut untold).unwrap();
    let mut call = Command::new("strace");
    call.args(["-f", "-qq", "-e", "trace=rename,renameat,renameat2", "-o"]).arg(&renamed);
    call.arg(program()).arg("restore").arg(&copy).arg("--data").arg(&to);
    assert!(call.status().unwrap().success());
    let renamed = fs::read_to_string(&renamed).unwrap();
    let moved: Vec<_> = renamed.lines().filter(|line| line.contains("/.partial/")).collect();
    let is_database = |line: &&str| line.contains("/.partial/station.db\"");
    assert!(moved.iter().any(|line| line.contains("/.partial/blobs\"")), "{renamed}");
    assert_eq!(moved.iter().rposition(is_database), Some(moved.len() - 1), "{renamed}");
}
