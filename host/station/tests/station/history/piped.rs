//! Named pipes in the place of what a station has kept: whoever opens one for reading may wait for ever.

use std::process::Command;

use halfrow::result::sha256;
use halfrow_station::kept::backup;
use halfrow_station::store::Folder;

use super::made::{End, Made, Run};
use super::served::Served;
use crate::common::{Did, program, replaced_by_pipe, untold};

#[test]
fn a_pipe_in_the_place_of_a_copy_s_evidence_is_told_and_nobody_waits_for_it() {
    let mut made = Made::new();
    made.run(&Run { evidence: vec!["seen"], ..Run::of("S1", End::Fail(&["memory"])) });
    let place = tempfile::tempdir().unwrap();
    let [copy, again] = ["copy", "again"].map(|name| place.path().join(name));
    backup(&made.folder(), &copy, &mut untold).unwrap();
    replaced_by_pipe(&Folder::new(&copy).blobs().path(&sha256([b"seen"])));
    let mut call = Command::new("timeout");
    call.arg("120").arg(program()).arg("restore").arg(&copy).arg("--data").arg(&again);
    let did: Did = call.output().unwrap().into();
    assert_eq!(did.code, Some(3), "{did:?}");
    assert!(did.complained.contains("cannot be read"), "{did:?}");
    assert!(!again.exists());
}

#[test]
fn pipes_in_the_place_of_a_record_and_of_evidence_hold_no_page_up() {
    let mut made = Made::new();
    let id = made.run(&Run { evidence: vec!["seen"], ..Run::of("S1", End::Fail(&["memory"])) });
    let (folder, seen) = (made.folder(), sha256([b"seen"]));
    let record = folder.verdict_of(&id).unwrap().unwrap().record_sha256;
    for hash in [&record, &seen] {
        replaced_by_pipe(&folder.blobs().path(hash));
    }
    let served = Served::of(made);
    assert!(served.page(&format!("/runs/{id}")).contains("cannot be read"));
    for of in ["export/record".to_owned(), format!("evidence/{seen}"), format!("preview/{seen}")] {
        assert_eq!(served.get(&format!("/runs/{id}/{of}")).status, 503, "{of}");
    }
    assert!(served.page("/unit?serial=S1").contains(&id));
}

#[test]
fn a_pipe_in_the_place_of_the_database_is_told_and_nobody_waits_for_it() {
    let folder = Made::new().closed();
    replaced_by_pipe(&folder.path().join("station.db"));
    for arguments in [&["yield"][..], &["waive", "x", "--reason", "why not", "--operator", "engel"]] {
        let mut call = Command::new("timeout");
        call.arg("120").arg(program()).args(arguments).arg("--data").arg(folder.path());
        let did: Did = call.output().unwrap().into();
        assert_eq!(did.code, Some(3), "{did:?}");
        assert!(did.complained.contains("it is a pipe"), "{did:?}");
    }
}
