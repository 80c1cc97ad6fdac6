//! Where the program is; it is rebuilt if one of its sources is newer.
//!
//! `cargo test --workspace` has built it before the tests run, with the same features. `cargo test -p halfrow-tests` has not, and
//! an outdated program must not be tested.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::SystemTime;

/// Names the program where there is no Cargo: in the virtual machine that `scripts/in-linux` boots.
const PROGRAM: &str = "HALFROW_TEST_PROGRAM";

/// The program that belongs to this test: of the same target folder and profile.
pub(super) fn program() -> PathBuf {
    if let Some(program) = std::env::var_os(PROGRAM) {
        return program.into();
    }
    let test = std::env::current_exe().unwrap();
    // target/PROFILE/deps/TEST
    let folder = test.ancestors().nth(2).unwrap();
    let program = folder.join("halfrow");
    if !is_fresh(&program) {
        build(folder);
    }
    assert!(program.is_file(), "{} was not built", program.display());
    program
}

fn build(folder: &Path) {
    let profile = match folder.file_name().and_then(|name| name.to_str()) {
        Some("debug") | None => "dev",
        Some(profile) => profile,
    };
    let mut cargo = Command::new(env!("CARGO"));
    // With the same choice of packages as whoever built this test: on its own, all its dependencies would be built once more,
    // with fewer features.
    cargo.args(["build", "--locked", "--bin", "halfrow", "--test", "command_line", "--profile", profile]);
    cargo
        .arg("--target-dir")
        .arg(folder.parent().unwrap())
        .args(
            cfg!(feature = "sim")
                .then_some(["--workspace", "--features=halfrow-tests/sim"])
                .into_iter()
                .flatten(),
        )
        .current_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/.."));
    let built = cargo.output().unwrap();
    assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
}

/// Whether the program exists and none of the sources that Cargo lists for it is newer.
fn is_fresh(program: &Path) -> bool {
    let noted = fs::read_to_string(program.with_extension("d")).unwrap_or_default();
    let Some((_, sources)) = noted.trim_end().split_once(": ") else { return false };
    // A space inside a path is written as `\ `.
    let sources = sources.replace("\\ ", "\0");
    let built = changed(program);
    sources.split(' ').all(|source| {
        let source = source.replace('\0', " ");
        changed(Path::new(&source)).is_some_and(|source| Some(source) <= built)
    })
}

/// When a file was last written; none if it does not exist.
fn changed(file: &Path) -> Option<SystemTime> {
    fs::metadata(file).and_then(|found| found.modified()).ok()
}
