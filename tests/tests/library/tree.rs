//! The dependencies of the library.

use std::process::Command;

/// Packages for programs that a person calls in a terminal.
const FOR_PROGRAMS: [&str; 9] = [
    "clap",
    "clap_builder",
    "indicatif",
    "signal-hook",
    "comfy-table",
    "anstream",
    "anstyle",
    "anyhow",
    "tracing-subscriber",
];

/// The names of all packages with which `package` is built.
fn tree(package: &str) -> Vec<String> {
    let listed = Command::new(env!("CARGO"))
        .args(["tree", "--offline", "--locked", "--edges", "normal", "--prefix", "none"])
        .args(["--format", "{p}", "--package", package])
        .current_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
        .output()
        .unwrap();
    assert!(listed.status.success(), "{}", String::from_utf8_lossy(&listed.stderr));
    let text = String::from_utf8(listed.stdout).unwrap();
    text.lines().filter_map(|line| line.split(' ').next()).map(str::to_owned).collect()
}

#[test]
fn the_library_brings_no_command_line_no_terminal_and_no_signals() {
    let with_library = tree("halfrow");
    assert!(with_library.contains(&"halfrow-model".to_owned()), "{with_library:?}");
    let with_program = tree("halfrow-cli");
    for package in FOR_PROGRAMS {
        assert!(!with_library.iter().any(|name| name == package), "the library comes with {package}");
        assert!(with_program.iter().any(|name| name == package), "the program does without {package}");
    }
}
