//! Tells the library what it is built from: the commit, the compiler, and the system that it is for.

use std::env;
use std::fs;
use std::path::Path;
use std::process::Command;

/// Filled in by `git archive`, so that an archive knows its commit.
const ARCHIVED: &str = "commit.txt";
/// Where this package lies in its repository. A repository that it was copied into has commits of its own.
const PLACE: &str = "host/judge/";
/// Digits of an abbreviated commit.
const DIGITS: usize = 12;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed={ARCHIVED}");
    let commit = archived().or_else(checked_out).unwrap_or_else(|| "unknown".to_owned());
    println!("cargo::rustc-env=HALFROW_COMMIT={commit}");
    println!("cargo::rustc-env=HALFROW_TARGET={}", env::var("TARGET").unwrap_or_default());
    let compiler = env::var("RUSTC").ok().and_then(|rustc| said(Command::new(rustc).arg("--version")));
    println!("cargo::rustc-env=HALFROW_RUSTC={}", compiler.unwrap_or_else(|| "unknown".to_owned()));
}

fn archived() -> Option<String> {
    let commit = fs::read_to_string(ARCHIVED).ok()?;
    let abbreviated = commit.trim().get(..DIGITS)?;
    abbreviated.chars().all(|digit| digit.is_ascii_hexdigit()).then(|| abbreviated.to_owned())
}

/// The commit, where the build is optimised. Others are built anew at each change, mostly of what is in no commit, and need not be
/// built anew at each commit, too.
fn checked_out() -> Option<String> {
    if env::var("PROFILE").ok()? != "release" || git(&["rev-parse", "--show-prefix"])? != PLACE {
        return None;
    }
    // A worktree keeps them elsewhere. With a file that is not there, Cargo would build anew each time.
    let watched =
        ["HEAD", "logs/HEAD"].into_iter().filter_map(|name| git(&["rev-parse", "--git-path", name]));
    for path in watched.filter(|path| Path::new(path).exists()) {
        println!("cargo::rerun-if-changed={path}");
    }
    git(&["rev-parse", &format!("--short={DIGITS}"), "HEAD"])
}

fn git(arguments: &[&str]) -> Option<String> {
    said(Command::new("git").args(arguments))
}

fn said(command: &mut Command) -> Option<String> {
    let output = command.output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| text.trim().to_owned())
}
