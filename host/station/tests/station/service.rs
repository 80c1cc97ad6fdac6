//! What starts the program: the unit for systemd that docs/station-setup.md installs, and `nohup`.

use std::fs;
use std::os::unix::net::UnixDatagram;
use std::process::Command;

use nix::sys::signal::Signal;

use crate::common::{Did, folder, program};
use crate::lanes::floor::HANG;
use crate::pages::station::{Serving, Station};

const UNIT: &str = include_str!("../../systemd/halfrow-station.service");
/// How the unit starts the program, which systemd finds where it is installed.
const STARTS: &str = "ExecStart=halfrow-station";
/// The largest exposure that `systemd-analyze security` may report, of 10. It also counts access to boards, their groups and the
/// network.
const EXPOSURE: f64 = 2.0;

#[test]
fn the_unit_calls_the_program_as_it_is_called() {
    let arguments = UNIT.lines().find_map(|line| line.strip_prefix(STARTS)).unwrap();
    let nowhere = arguments.replace("/etc/halfrow", "/nowhere");
    let did: Did = Command::new(program()).args(nowhere.split_whitespace()).output().unwrap().into();
    assert_eq!(did.code, Some(2), "{did:?}");
    assert!(did.complained.contains("/nowhere/station.toml cannot be read"), "{did:?}");
}

/// The result of `systemd-analyze` for this unit.
fn analysed(unit: &str, how: &[&str]) -> Did {
    let folder = folder();
    let path = folder.path().join("halfrow-station.service");
    fs::write(&path, unit.replace(STARTS, &format!("ExecStart={}", program().display()))).unwrap();
    let did = Command::new("systemd-analyze").args(how).arg("--no-pager").arg(&path).output();
    did.unwrap_or_else(|_| panic!("systemd-analyze is missing; run: apt-get install systemd")).into()
}

#[test]
fn systemd_finds_nothing_wrong_with_the_unit() {
    let right = analysed(UNIT, &["verify"]);
    assert_eq!((right.code, right.complained.as_str()), (Some(0), ""), "{right:?}");
    // The control: a misspelt key is reported.
    let wrong = analysed(&UNIT.replace("WatchdogSec", "WatchdogSecs"), &["verify"]);
    assert!(wrong.complained.contains("WatchdogSecs"), "{wrong:?}");
}

#[test]
fn the_unit_leaves_open_what_lanes_need_and_little_else() {
    let did = analysed(UNIT, &["security", "--offline=true"]);
    let said = did.said.lines().last().unwrap_or_default();
    let level = said.rsplit(": ").next().and_then(|level| level.split_whitespace().next()?.parse().ok());
    let level: f64 = level.unwrap_or_else(|| panic!("{did:?}"));
    println!("exposure {level}");
    assert!(level <= EXPOSURE, "{did:?}");
}

/// As `nohup` does, so that the program outlives the terminal.
#[test]
fn a_signal_that_it_was_started_to_ignore_stays_ignored() {
    let station = Station::private(1);
    let serve = station.command();
    let mut shell = Command::new("sh");
    let ignoring = "trap '' HUP; exec \"$0\" \"$@\"";
    shell.args(["-c", ignoring]).arg(serve.get_program()).args(serve.get_args());
    let serving = Serving::of(&mut shell);
    assert_eq!([Signal::SIGHUP, Signal::SIGTERM].map(|signal| serving.ignores(signal)), [true, false]);
}

/// A copy of that one file has everything, and systemd regards the exit code as success.
#[test]
fn a_station_that_is_stopped_leaves_one_whole_file() {
    let station = Station::private(1);
    let code = station.serve().stopped_by(Signal::SIGTERM).unwrap();
    assert!(UNIT.lines().any(|line| line == format!("SuccessExitStatus={code}")), "{code}");
    let log = fs::metadata(station.path("data").join("station.db-wal"));
    assert!(log.map_or(0, |log| log.len()) == 0);
    assert!(!station.query("SELECT n FROM schema_version").is_empty());
}

/// Checking the whole database may take longer than systemd waits for a start.
#[test]
fn a_start_that_looks_at_all_of_the_database_says_so_and_asks_systemd_for_time() {
    let station = Station::private(1);
    drop(station.serve());
    let data = station.path("data");
    let log = fs::metadata(data.join("station.db-wal")).unwrap();
    assert!(log.len() > 32, "what is killed leaves its log");
    // As an earlier program leaves it.
    fs::write(data.join("station.lock"), "").unwrap();
    let place = station.path("notify");
    let systemd = UnixDatagram::bind(&place).unwrap();
    systemd.set_read_timeout(Some(HANG)).unwrap();
    let serving = Serving::of(station.command().env("NOTIFY_SOCKET", &place));
    assert!(
        serving.complained().contains("all of station.db is looked at first"),
        "{}",
        serving.complained()
    );
    let mut heard = vec![];
    // It then goes on to say that it works.
    while heard.last().is_none_or(|heard| heard != "WATCHDOG=1") {
        let mut buffer = [0; 64];
        let read = systemd.recv(&mut buffer).unwrap();
        heard.push(String::from_utf8(buffer[..read].to_vec()).unwrap());
    }
    let seconds = UNIT.lines().find_map(|line| line.strip_prefix("TimeoutStartSec=")).unwrap();
    assert_eq!(heard[0], format!("EXTEND_TIMEOUT_USEC={seconds}000000"));
    assert_eq!(heard[heard.len() - 2..], ["READY=1", "WATCHDOG=1"]);
    // A start that checks nothing prints nothing.
    drop(serving);
    assert_eq!(station.serve().complained(), "");
}
