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

/// What the program that `unit` starts does where its settings are not there.
fn without_settings(unit: &str) -> Did {
    let arguments = unit.lines().find_map(|line| line.strip_prefix(STARTS)).unwrap();
    let nowhere = arguments.replace("/etc/halfrow", "/nowhere");
    Command::new(program()).args(nowhere.split_whitespace()).output().unwrap().into()
}

#[test]
fn the_unit_calls_the_program_as_it_is_called() {
    let did = without_settings(UNIT);
    assert_eq!(did.code, Some(2), "{did:?}");
    assert!(did.complained.contains("/nowhere/station.toml cannot be read"), "{did:?}");
}

/// The unit that the commands of docs/plant.md make of the station's.
fn of_plant(page: &str) -> String {
    let folder = folder();
    let [from, to] = ["from", "to"].map(|name| folder.path().join(name));
    fs::write(&from, UNIT).unwrap();
    let lines = page.lines().skip_while(|line| !line.starts_with("    sed "));
    let commands: Vec<_> = lines.take_while(|line| !line.starts_with("    systemctl")).collect();
    let here = commands
        .join("\n")
        .replace("/lib/systemd/system/halfrow-station.service", from.to_str().unwrap())
        .replace("/etc/systemd/system/halfrow-plant.service", to.to_str().unwrap());
    assert!(Command::new("sh").args(["-ec", &here]).status().unwrap().success());
    fs::read_to_string(to).unwrap()
}

/// The pages of a plant tell systemd nothing, and write to a folder of their own.
#[test]
fn the_unit_of_a_plant_is_started_without_news_and_may_write_to_the_folder_of_its_settings() {
    let page = include_str!("../../../../docs/plant.md");
    let unit = of_plant(page);
    let did = without_settings(&unit);
    assert!(did.complained.contains("/nowhere/plant.toml cannot be read"), "{did:?}");
    let value = |key: &str| unit.lines().find_map(|line| line.strip_prefix(key));
    assert_eq!((value("Type="), value("WatchdogSec=")), (Some("exec"), None));
    let data = format!("\ndata = \"/var/lib/{}\"", value("StateDirectory=").unwrap());
    let (_, settings) = page.split_once("name = \"north\"").unwrap();
    assert!(settings.contains(&data), "{data}");
    let did = analysed(&unit, &["verify"]);
    assert_eq!((did.code, did.complained.as_str()), (Some(0), ""), "{did:?}");
    assert_eq!(value("ProtectSystem="), Some("strict"), "the control");
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
