//! Calls that name something that is not a station's.

use std::fs::{self, File};
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::Command;

use nix::sys::stat::Mode;
use nix::unistd::mkfifo;

use super::bench::{Did, PLAN, Station, program};

fn called(arguments: &[&str], path: &Path, more: &[&str]) -> Did {
    Command::new(program()).args(arguments).arg(path).args(more).output().unwrap().into()
}

#[test]
fn a_lock_that_is_a_link_or_a_pipe_is_refused_and_not_written_through() {
    let station = Station::with(PLAN);
    let (data, other) = (station.data(), station.path("other.txt"));
    fs::create_dir(&data).unwrap();
    fs::write(&other, "worth keeping").unwrap();
    let lock = data.join("station.lock");
    for make in [
        |lock: &Path| symlink("../other.txt", lock).unwrap(),
        |lock: &Path| mkfifo(lock, Mode::S_IRWXU).unwrap(),
    ] {
        make(&lock);
        let did = station.run("CAT00001", "mock");
        assert!(
            did.code == Some(3) && did.complained.contains("station.lock there is a link or no regular file"),
            "{did:?}"
        );
        assert_eq!(fs::read_to_string(&other).unwrap(), "worth keeping");
        assert!(station.check().code.is_some());
        fs::remove_file(&lock).unwrap();
    }
    assert_eq!(station.run("CAT00001", "mock").code, Some(0));
}

/// Neither judges nor looks, and nothing in it is changed.
#[test]
fn a_database_that_is_not_a_station_s_is_refused() {
    let station = Station::with(PLAN);
    fs::create_dir(station.data()).unwrap();
    let path = station.data().join("station.db");
    let refused = || {
        for did in [station.run("CAT00001", "mock"), station.check()] {
            let is_told = did.complained.contains("is damaged, or no database at all");
            assert!(did.code == Some(3) && is_told, "{did:?}");
        }
    };
    mkfifo(&path, Mode::S_IRWXU).unwrap();
    refused();
    fs::remove_file(&path).unwrap();
    let other = rusqlite::Connection::open(&path).unwrap();
    other.execute_batch("CREATE TABLE bookmark (address TEXT)").unwrap();
    drop(other);
    let before = fs::read(&path).unwrap();
    refused();
    assert!(fs::read(&path).unwrap() == before);
}

#[test]
fn a_folder_without_results_is_told_as_such_to_whoever_removes() {
    let station = Station::with(PLAN);
    let did = called(&["prune", "--operator", "weber", "--data"], &station.data(), &[]);
    assert!(did.code == Some(2) && did.complained.contains("has no station's results"), "{did:?}");
}

#[test]
fn a_station_without_a_name_judges_nothing() {
    let station = Station::with(PLAN);
    let mut arguments = station.run_arguments("CAT00001", "mock");
    arguments.extend(["--station", " "].map(str::to_owned));
    let did: Did =
        Command::new(program()).args(arguments).env_remove("HALFROW_STATION").output().unwrap().into();
    assert!(did.code == Some(2) && did.complained.contains("write a name"), "{did:?}");
    assert!(!station.data().exists());
}

/// Results of boards that do not exist would be among those of real ones.
#[test]
fn a_demonstration_takes_no_folder_that_has_something() {
    let station = Station::with(PLAN);
    let did =
        called(&["demo", "--lanes", "1", "--port", "0", "--any-disk", "--folder"], &station.path(""), &[]);
    assert!(did.code == Some(2) && did.complained.contains("name a new folder"), "{did:?}");
    assert!(!station.path("station.toml").exists());
}

/// It is shown once.
#[test]
fn a_token_that_could_not_be_shown_does_not_stay() {
    let station = Station::with(PLAN);
    let settings = "schema = 1\n[station]\nname = \"12\"\ndata = \"data\"\n[web]\nlisten = \"127.0.0.1:0\"\n\
                    [access]\nusers = \"users.toml\"\ntokens = \"tokens.toml\"\n";
    fs::write(station.path("station.toml"), settings).unwrap();
    let add = |out: &str| {
        let out = File::options().write(true).open(out).unwrap();
        let mut add = Command::new(program());
        let add = add.args(["token", "add", "grafana", "--settings"]).arg(station.path("station.toml"));
        add.stdout(out).output().unwrap().status.code()
    };
    assert_eq!(add("/dev/full"), Some(3));
    assert_eq!(add("/dev/null"), Some(0));
}
