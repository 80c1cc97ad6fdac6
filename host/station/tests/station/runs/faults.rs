//! Faults of the program itself and of its environment: the exit code is still a documented one.

use std::ffi::OsStr;
use std::fs::{self, File};
use std::os::unix::ffi::OsStrExt as _;
use std::process::Command;

use super::bench::{Did, PLAN, Station, program};

/// Rust's hash maps panic on a system without randomness, so this makes any program panic.
fn without_randomness(arguments: &[&str]) -> Did {
    Command::new("strace")
        .args(["-f", "-qq", "-o", "/dev/null", "-e", "inject=getrandom:error=EIO"])
        .arg(program())
        .args(arguments)
        .env_remove("RUST_BACKTRACE")
        .output()
        .unwrap()
        .into()
}

#[test]
fn a_panic_is_an_error_that_says_what_happened() {
    let station = Station::with(PLAN);
    station.run("CAT00001", "mock");
    let (data, plan) =
        (station.data().display().to_string(), station.path("plan.toml").display().to_string());
    for call in [["check", "--data", &data], ["plan", "check", &plan]] {
        let did = without_randomness(&call);
        assert_eq!(did.code, Some(3), "{did:?}");
        assert!(
            did.complained
                .starts_with("error: the program itself has failed: failed to generate random data (")
        );
        assert!(did.complained.ends_with("report this line with the call that led to it\n"), "{did:?}");
    }
}

#[test]
fn help_that_stdout_does_not_take_is_an_error() {
    for (stdout, code) in [("/dev/full", 3), ("/dev/null", 0)] {
        let stdout = File::options().write(true).open(stdout).unwrap();
        let did: Did = Command::new(program()).arg("--help").stdout(stdout).output().unwrap().into();
        assert_eq!(did.code, Some(code), "{did:?}");
    }
}

/// Every board would be an ERROR, and nobody would know of what.
#[test]
fn a_plan_or_a_folder_whose_path_is_no_text_is_refused_before_anything_is_judged() {
    let station = Station::with(PLAN);
    let folder = station.path("").join(OsStr::from_bytes(b"m\xf6bel"));
    fs::create_dir(&folder).unwrap();
    fs::copy(station.path("plan.toml"), folder.join("plan.toml")).unwrap();
    let refused = |arguments: &[&OsStr]| {
        let did: Did = Command::new(program()).args(arguments).output().unwrap().into();
        let is_named = did.complained.contains("bel") && did.complained.contains("is not UTF-8");
        assert!(did.code == Some(2) && is_named, "{did:?}");
    };
    let arguments = station.run_arguments("CAT00001", "mock");
    for path in ["plan.toml", "data"] {
        let (was, is) = (station.path(path), folder.join(path));
        let instead = |word| if was.as_os_str() == word { is.as_os_str() } else { word };
        let arguments: Vec<_> = arguments.iter().map(|word| instead(OsStr::new(word))).collect();
        refused(&arguments);
        assert!(!station.data().exists(), "nothing was begun");
    }
    let did = station.run("CAT00001", "mock");
    assert_eq!(did.code, Some(0), "{did:?}");
    let (data, copy) = (station.data(), folder.join("copy"));
    refused(&[OsStr::new("backup"), copy.as_os_str(), OsStr::new("--data"), data.as_os_str()]);
}

/// A lane that reads its own path as text would panic.
#[test]
fn a_program_whose_folder_is_no_text_judges_boards() {
    let station = Station::with(PLAN);
    let folder = station.path("").join(OsStr::from_bytes(b"m\xf6bel"));
    fs::create_dir(&folder).unwrap();
    let copy = folder.join("halfrow-station");
    // Written by another process, so that no process started by other tests has the file open when it is run.
    assert!(Command::new("cp").arg(program()).arg(&copy).status().unwrap().success());
    let did: Did =
        Command::new(copy).args(station.run_arguments("CAT00001", "mock")).output().unwrap().into();
    assert_eq!(did.code, Some(0), "{did:?}");
}
