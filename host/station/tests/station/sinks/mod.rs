//! Where results are sent other than the plant: a folder, a web server, a broker of events. Each is another program.

mod certificates;
mod events;
mod folder;
mod many;
mod post;
mod since;
mod told;

use std::path::Path;
use std::process::Command;

use halfrow_station::outbox::{Round, Sink, Standing, Undelivered, round};
use halfrow_station::said::Saying;
use halfrow_station::settings::Settings;
use halfrow_station::store::{Deed, Folder, Parcel, SharedStore, Snapshot, Store, Tried};

use crate::common::{self, Did, LANE, now_ms};

/// Runs a command of the station in this folder, with this `[[sink]]` in its settings.
fn did(folder: &Path, sink: &str, arguments: &[&str]) -> Did {
    command(folder, sink, arguments).output().unwrap().into()
}

/// The same command, not yet started.
fn command(folder: &Path, sink: &str, arguments: &[&str]) -> Command {
    settings(folder, sink);
    common::command(folder, arguments)
}

/// Writes the station's settings, with this sink.
fn settings(folder: &Path, sink: &str) {
    common::settings(folder, "12", ".", &format!("{sink}\n{LANE}"));
}

/// Sends everything that is not yet sent.
const SEND: [&str; 3] = ["outbox", "send", "--any-disk"];

fn send(folder: &Path, sink: &str) -> Did {
    did(folder, sink, &SEND)
}

#[test]
fn a_sink_that_is_not_one_is_refused_with_its_line() {
    let folder = tempfile::tempdir().unwrap();
    let cases = [
        ("name = \"mes\"", "has not one place to send to"),
        ("name = \"mes\"\nfolder = \"a\"\nmqtt = \"mqtt://localhost\"", "has not one place to send to"),
        ("name = \"plant\"\nfolder = \"a\"", "`plant` is no name for a sink"),
        ("name = \"m/s\"\nfolder = \"a\"", "is no name for a sink"),
        (
            "name = \"mes\"\nfolder = \"a\"\n[[sink]]\nname = \"mes\"\nfolder = \"b\"",
            "two sinks are called mes",
        ),
        (
            "name = \"mes\"\nmqtt = \"mqtt://localhost\"\nuser = \"me\"",
            "a user and a password belong together",
        ),
        ("name = \"mes\"\npost = \"ftp://localhost/a\"", "nothing is sent by ftp"),
        ("name = \"mes\"\npost = \"/runs\"", "this is no whole address"),
        ("name = \"mes\"\npost = \"https://a b\"", "this is no address"),
        ("name = \"mes\"\npost = \"https://me:secret@mes.example/\"", "anybody may see who"),
        ("name = \"mes\"\npost = \"http://mes.example/runs\"", "would send results openly to mes.example"),
        ("name = \"mes\"\nmqtt = \"mqtt://10.0.0.1\"", "would send results openly to 10.0.0.1"),
        (
            "name = \"mes\"\npost = \"http://localhost.example/\"",
            "would send results openly to localhost.example",
        ),
    ];
    are_refused(folder.path(), &cases);
    for right in
        ["post = \"http://[::1]:80/a\"", "post = \"https://mes.example\"", "mqtt = \"mqtts://b.example/a\""]
    {
        settings(folder.path(), &format!("[[sink]]\nname = \"mes\"\n{right}"));
        Settings::load(&folder.path().join("station.toml")).unwrap();
    }
}

/// Asserts that each of these sinks is refused with these words.
fn are_refused(folder: &Path, sinks: &[(&str, &str)]) {
    for (sink, expected) in sinks {
        settings(folder, &format!("[[sink]]\n{sink}"));
        let error = Settings::load(&folder.join("station.toml")).unwrap_err().to_string();
        assert!(error.contains(expected) && error.contains("station.toml:"), "{sink}: {error}");
    }
}

#[test]
fn a_key_that_says_nothing_to_a_sink_is_refused_with_its_line() {
    let folder = tempfile::tempdir().unwrap();
    let cases = [
        ("name = \"mes\"\nfolder = \"a\"\nformat = \"xls\"", "unknown variant `xls`"),
        ("name = \"mes\"\nfolder = \"a\"\nuser = \"me\"", "user says nothing to this sink"),
        ("name = \"mes\"\nfolder = \"a\"\nca = \"ca.pem\"", "ca says nothing to this sink"),
        (
            "name = \"mes\"\nmqtt = \"mqtt://localhost\"\ntoken_file = \"t\"",
            "token_file says nothing to this sink",
        ),
        (
            "name = \"mes\"\npost = \"http://localhost\"\npassword_file = \"p\"",
            "password_file says nothing to this sink",
        ),
        ("name = \"mes\"\nmqtt = \"mqtt://localhost\"\nformat = \"csv\"", "format says nothing to this sink"),
        ("name = \"mes\"\nfolder = \" \"", "there is nothing here"),
        ("name = \"mes\"\npost = \"http://localhost\"\ntoken_file = \"\"", "there is nothing here"),
        ("name = \"mes\"\nmqtt = \"mqtts://b.example\"\nca = \"\"", "there is nothing here"),
        (
            "name = \"mes\"\nmqtt = \"mqtt://localhost\"\nuser = \"me\"\npassword_file = \"\"",
            "there is nothing here",
        ),
    ];
    are_refused(folder.path(), &cases);
}

#[test]
fn a_way_to_a_sink_that_is_none_is_refused_with_its_line() {
    let folder = tempfile::tempdir().unwrap();
    let cases = [
        (
            "name = \"mes\"\npost = \"http://localhost/\"\nproxy = \"http://p.example\"",
            "openly through a proxy",
        ),
        (
            "name = \"mes\"\npost = \"https://localhost/\"\nproxy = \"http://me:x@p.example\"",
            "asked without a password",
        ),
        (
            "name = \"mes\"\npost = \"https://localhost/\"\nproxy = \"p.example:3128\"",
            "write it as http://host:port",
        ),
        (
            "name = \"mes\"\npost = \"https://localhost/\"\nproxy = \"http://p.example:99999\"",
            "write it as http://host:port",
        ),
        ("name = \"mes\"\nfolder = \"a\"\nproxy = \"http://p.example\"", "proxy says nothing to this sink"),
        ("name = \"mes\"\npost = \"http://localhost:99999/x\"", "this is no address"),
        ("name = \"mes\"\nmqtt = \"mqtt://[::1]:65536\"", "this is no address"),
        ("name = \"mes\"\nmqtt = \"mqtt://localhost/a+b\"", "no topic may have"),
        ("name = \"mes\"\nmqtt = \"mqtt://localhost/a/#\"", "no topic may have"),
        ("name = \"mes\"\nmqtt = \"mqtt://localhost/a?b\"", "no topic may have"),
    ];
    are_refused(folder.path(), &cases);
}

/// A sink that reads what is unsent whenever it is given something.
struct Looking {
    folder: Folder,
    unsent: Vec<u32>,
}

impl Sink for Looking {
    fn name(&self) -> &str {
        "mes"
    }

    fn take(&mut self, _: &Parcel) -> Result<(), Undelivered> {
        let unsent = Snapshot::take(&self.folder).unwrap().unsent().unwrap();
        self.unsent.push(unsent.iter().map(|unsent| unsent.entries).sum());
        Ok(())
    }
}

#[test]
fn what_a_sink_has_is_known_before_it_has_all_that_comes_after_it() {
    let place = tempfile::tempdir().unwrap();
    let folder = Folder::new(place.path());
    let mut store = Store::open(&folder).unwrap();
    store.sends_to(vec!["mes".to_owned()]).unwrap();
    for number in ["1", "2", "3"] {
        store.note(Deed { operator: "weber", act: "scan", subject: "1", detail: number }).unwrap();
    }
    let (store, mut sink) = (SharedStore::new(store), Looking { folder, unsent: Vec::new() });
    assert_eq!(
        round(&store, &mut sink, &mut Standing::default()).unwrap(),
        Round { sent: 3, failed: 0, is_away: false }
    );
    assert_eq!(sink.unsent[..2], [3, 2]);
    assert!(Snapshot::take(&sink.folder).unwrap().unsent().unwrap().is_empty());
}

/// The clock was wrong by a day when the last try failed.
#[test]
fn what_waits_for_a_time_of_a_wrong_clock_is_sent_all_the_same() {
    let place = tempfile::tempdir().unwrap();
    let folder = Folder::new(place.path());
    let mut store = Store::open(&folder).unwrap();
    store.sends_to(vec!["mes".to_owned()]).unwrap();
    for (wait_ms, sent) in [(200_000, 0), (86_400_000, 1)] {
        store.note(Deed { operator: "weber", act: "scan", subject: "1", detail: "1" }).unwrap();
        let entry = folder.due("mes", now_ms(), i64::MAX).unwrap().remove(0);
        let again = Tried::Again { next_ms: now_ms() + wait_ms, said: Saying::NotAtPlant.into() };
        store.tried("mes", &[(entry, again)], now_ms()).unwrap();
        let shared = SharedStore::new(store);
        let mut sink = Looking { folder: folder.clone(), unsent: Vec::new() };
        // What was noted before, and waits for less time, is not sent.
        assert_eq!(round(&shared, &mut sink, &mut Standing::default()).unwrap().sent, sent, "{wait_ms}");
        drop(shared);
        store = Store::open(&folder).unwrap();
        store.sends_to(vec!["mes".to_owned()]).unwrap();
    }
}
