//! A folder into which results are written.

use std::fs::{self, File};
use std::os::unix::fs::PermissionsExt as _;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, SystemTime};

use halfrow_station::store::Folder;

use super::{SEND, did, send, settings};
use crate::common::{Did, NO_AUDIT, change, program, query};
use crate::history::made::Made;
use crate::history::released::history;

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> =
        fs::read_dir(folder).unwrap().map(|file| file.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// The folder of a station with a history, and a sink of this format inside it.
fn station(format: &str) -> (tempfile::TempDir, String) {
    let folder = history().closed();
    let sink = format!("[[sink]]\nname = \"share\"\nfolder = \"share\"\nformat = \"{format}\"\n");
    (folder, sink)
}

#[test]
fn each_run_is_a_file_with_the_bytes_that_are_exported_and_a_waiver_is_one_too() {
    for (format, ending) in
        [("record", ".json"), ("junit", ".xml"), ("csv", ".csv"), ("openhtf", ".openhtf.json")]
    {
        let (folder, sink) = station(format);
        let share = folder.path().join("share");
        fs::create_dir(&share).unwrap();
        let sent = send(folder.path(), &sink);
        assert!(sent.said.starts_with("10 sent, 0 not"), "{sent:?}");
        let runs = query(folder.path(), "SELECT id FROM run WHERE state = 'final' ORDER BY id");
        let [waiver] = &query(folder.path(), "SELECT id FROM waiver")[..] else {
            panic!("there is one waiver")
        };
        let mut expected: Vec<_> = runs.iter().map(|run| format!("{run}{ending}")).collect();
        expected.push(format!("{waiver}.waiver.json"));
        expected.sort();
        assert_eq!(names(&share), expected);
        for run in &runs {
            let data = folder.path().to_str().unwrap();
            let exported = Command::new(program())
                .args(["export", run, "--format", format, "--data", data])
                .output()
                .unwrap();
            assert_eq!(fs::read(share.join(format!("{run}{ending}"))).unwrap(), exported.stdout, "{format}");
        }
        let waived: serde_json::Value =
            serde_json::from_slice(&fs::read(share.join(format!("{waiver}.waiver.json"))).unwrap()).unwrap();
        assert_eq!((&waived["operator"], &waived["reason"]), (&"engel".into(), &"it's \"as\" is".into()));
    }
}

/// The share goes, or its disk breaks, when the file has its name: a power cut may take that away again.
#[test]
fn what_the_folder_may_lose_in_a_power_cut_is_sent_again() {
    let (folder, sink) = station("record");
    let share = folder.path().join("share");
    fs::create_dir(&share).unwrap();
    settings(folder.path(), &sink);
    let mut broken = Command::new("strace");
    broken.args(["-f", "-qq", "-o", "/dev/null", "-e", "inject=fsync:error=EIO", "-P"]).arg(&share);
    broken.arg(program()).args(["outbox", "send", "--any-disk", "--settings"]);
    let vain = Did::from(broken.arg(folder.path().join("station.toml")).output().unwrap());
    // A folder is not sent the two lines of the audit.
    assert!(vain.said.starts_with("2 sent, 8 not"), "{vain:?}");
    let sent = send(folder.path(), &sink);
    assert!(sent.said.starts_with("8 sent, 0 not"), "{sent:?}");
}

/// A disk that is not mounted would have a station that begins anew.
#[test]
fn nothing_is_sent_of_a_station_that_is_not_there_and_none_is_made() {
    let folder = tempfile::tempdir().unwrap();
    let sink = "[[sink]]\nname = \"share\"\nfolder = \"share\"\n";
    let sent = send(folder.path(), sink);
    assert!(sent.code == Some(2) && sent.complained.contains("has no station's results"), "{sent:?}");
    assert_eq!(names(folder.path()), ["plan.toml", "station.toml"]);
}

/// Whether another computer still writes a file, no lock tells for certain: not every share has locks that all computers see.
#[test]
fn what_a_power_cut_left_in_the_folder_is_removed_after_a_day() {
    let (folder, sink) = station("record");
    let share = folder.path().join("share");
    fs::create_dir(&share).unwrap();
    let [old, young, locked, other] = [
        ".halfrow-aaaaaaaaaa.aside",
        ".halfrow-bbbbbbbbbb.aside",
        ".halfrow-cccccccccc.aside",
        "notes.aside",
    ]
    .map(|name| share.join(name));
    let written = |path: &Path, hours: u64| {
        let file = File::create(path).unwrap();
        file.set_modified(SystemTime::now() - Duration::from_secs(3600 * hours)).unwrap();
        file
    };
    let held = written(&locked, 25);
    held.lock().unwrap();
    let _ = [(&old, 25), (&young, 23), (&other, 25)].map(|(path, hours)| written(path, hours));
    let sent = send(folder.path(), &sink);
    assert!(sent.said.starts_with("10 sent, 0 not"), "{sent:?}");
    assert_eq!([old, young, locked, other].map(|path| path.exists()), [false, true, true, true]);
}

/// The service's own files are for nobody else, but what it writes here is for everybody who may read the folder.
#[test]
fn whoever_may_read_the_folder_may_read_its_files_and_nobody_else() {
    for (of_folder, of_files) in [(0o755, 0o644), (0o2770, 0o640), (0o700, 0o600)] {
        let (folder, sink) = station("record");
        let share = folder.path().join("share");
        fs::create_dir(&share).unwrap();
        fs::set_permissions(&share, fs::Permissions::from_mode(of_folder)).unwrap();
        settings(folder.path(), &sink);
        let call = "umask 077; exec \"$0\" outbox send --any-disk --settings \"$1\"";
        let mut shell = Command::new("sh");
        shell.args(["-c", call]).arg(program()).arg(folder.path().join("station.toml"));
        let sent = Did::from(shell.output().unwrap());
        assert!(sent.said.starts_with("10 sent, 0 not"), "{sent:?}");
        for name in names(&share) {
            let mode = fs::metadata(share.join(&name)).unwrap().permissions().mode() & 0o777;
            assert_eq!(mode, of_files, "{name} in a folder of mode {of_folder:o}: {mode:o}");
        }
    }
}

#[test]
fn a_folder_that_is_away_is_waited_for_and_another_file_is_never_written_over() {
    let (folder, sink) = station("record");
    let share = folder.path().join("share");
    // Kept by a command that knows no sinks.
    let listed = did(folder.path(), &sink, &["outbox", "list"]);
    assert!(listed.said.contains("share      10     0"), "{listed:?}");
    let away = send(folder.path(), &sink);
    assert!(away.said.starts_with("0 sent, 10 not") && away.said.contains("make it, or mount"), "{away:?}");
    assert!(!share.exists());
    fs::create_dir(&share).unwrap();
    let run = query(folder.path(), "SELECT min(id) FROM run").remove(0);
    let other = share.join(format!("{run}.json"));
    fs::write(&other, "somebody's own").unwrap();
    let sent = send(folder.path(), &sink);
    assert!(sent.said.starts_with("9 sent, 1 not"), "{sent:?}");
    assert_eq!(fs::read_to_string(&other).unwrap(), "somebody's own");
    let listed = did(folder.path(), &sink, &["outbox", "list"]);
    assert!(listed.said.contains("nothing was changed: keep both"), "{listed:?}");
    // A person corrects it, and releases everything that waits for this sink.
    fs::remove_file(&other).unwrap();
    let release =
        ["outbox", "release", "--sink", "share", "--reason", "it was a trial", "--operator", "engel"];
    assert_eq!(did(folder.path(), &sink, &release).code, Some(0));
    assert_eq!(did(folder.path(), &sink, &release).code, Some(2));
    assert!(send(folder.path(), &sink).said.contains(" sent, 0 not"));
    // A file that exists with the same content is not written again.
    change(folder.path(), "DELETE FROM outbox");
    let modified = fs::metadata(&other).unwrap().modified().unwrap();
    let trace = folder.path().join("trace");
    let mut again = Command::new("strace");
    again.args(["-f", "-y", "-e", "trace=fsync", "-o"]).arg(&trace).arg(program()).args(SEND);
    let again = Did::from(again.arg("--settings").arg(folder.path().join("station.toml")).output().unwrap());
    assert!(again.said.contains(" sent, 0 not"), "{again:?}");
    assert_eq!(fs::metadata(&other).unwrap().modified().unwrap(), modified);
    // A program that was killed may have left it without its name on the disk.
    let trace = fs::read_to_string(trace).unwrap();
    for synced in [&other, &share] {
        assert!(trace.contains(&format!("<{}>)", synced.display())), "{}: {trace}", synced.display());
    }
}

/// The run is sent once its record is put back; those after it do not wait for that.
#[test]
fn a_run_whose_record_cannot_be_read_is_not_taken_for_sent() {
    let (folder, sink) = station("record");
    let share = folder.path().join("share");
    fs::create_dir(&share).unwrap();
    let of_first = "SELECT record_sha256 FROM run WHERE state = 'final' ORDER BY id LIMIT 1";
    let hash = query(folder.path(), of_first).remove(0);
    let record = Folder::new(folder.path()).blobs().path(&hash);
    let aside = folder.path().join("aside");
    fs::rename(&record, &aside).unwrap();
    let sent = send(folder.path(), &sink);
    assert!(sent.said.starts_with("9 sent, 1 not") && sent.code == Some(3), "{sent:?}");
    assert_eq!(names(&share).len(), 7);
    fs::rename(&aside, &record).unwrap();
    let sent = send(folder.path(), &sink);
    assert!(sent.said.starts_with("1 sent, 0 not") && sent.code == Some(0), "{sent:?}");
    assert_eq!(names(&share).len(), 8);
}

#[test]
fn a_sink_that_is_no_more_is_forgotten_when_the_settings_do_not_name_it() {
    let (folder, sink) = station("record");
    assert_eq!(send(folder.path(), &sink).code, Some(3));
    let forget = ["outbox", "forget", "share", "--reason", "the share is gone", "--operator", "engel"];
    let refused = did(folder.path(), &sink, &forget);
    assert!(
        refused.code == Some(2) && refused.complained.contains("take it out of them first"),
        "{refused:?}"
    );
    let unknown = did(folder.path(), "", &forget.map(|word| if word == "share" { "shore" } else { word }));
    assert!(unknown.code == Some(2) && unknown.complained.contains("no sink shore"), "{unknown:?}");
    // What cannot be entered in the audit is not forgotten.
    change(folder.path(), NO_AUDIT);
    assert_eq!(did(folder.path(), "", &forget).code, Some(3));
    change(folder.path(), "DROP TRIGGER full");
    let forgotten = did(folder.path(), "", &forget);
    assert_eq!((forgotten.code, forgotten.said.as_str()), (Some(0), "10 of share are forgotten\n"));
    assert_eq!(did(folder.path(), "", &["outbox", "list"]).said, "nothing is left to be sent\n");
    let told = "SELECT operator_id || ' ' || act || ' ' || subject || ': ' || detail FROM audit WHERE act = 'forget-sink'";
    assert_eq!(query(folder.path(), told), ["engel forget-sink share: the share is gone"]);
    drop(Made::at(folder));
}
