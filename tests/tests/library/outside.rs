//! A program outside the workspace, with a link of its own.

use std::fs;
use std::path::Path;
use std::process::Command;

#[test]
#[ignore = "compiles the library with features of its own: scripts/soak properties"]
fn a_program_outside_judges_over_a_link_that_it_made_and_opens_again() {
    let tests = Path::new(env!("CARGO_MANIFEST_DIR"));
    let test = std::env::current_exe().unwrap();
    // target/PROFILE/deps/TEST
    let target = test.ancestors().nth(3).unwrap();
    // With the versions of the workspace, which are already downloaded; Cargo removes those that it does not need.
    fs::copy(tests.join("../Cargo.lock"), tests.join("outside/Cargo.lock")).unwrap();
    let ran = Command::new(env!("CARGO"))
        .args(["run", "--offline", "--quiet", "--target-dir"])
        .arg(target)
        .current_dir(tests.join("outside"))
        .output()
        .unwrap();
    let (said, told) = (String::from_utf8_lossy(&ran.stdout), String::from_utf8_lossy(&ran.stderr));
    assert!(ran.status.success(), "{told}");
    assert_eq!(said.trim_end(), "PASS equal 1", "{told}");
    assert!(told.contains("2 tries to open the link again"), "{told}");
}
