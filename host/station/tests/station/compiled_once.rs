//! The station is not in a first build of the project, and building it compiles nothing again that `halfrow` is made of.
//!
//! Cargo compiles a crate once for each set of features. `cargo tree` says what a selection of packages asks for.

use std::collections::{BTreeMap, BTreeSet};
use std::process::Command;

/// Crates with their versions, and the sets of features with which each is compiled.
type Crates = BTreeMap<String, BTreeSet<String>>;

fn tree(selection: &[&str]) -> Crates {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let output = Command::new(cargo)
        .current_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
        .args([
            "tree",
            "--offline",
            "--locked",
            "--edges",
            "normal,build",
            "--prefix",
            "none",
            "--format",
            "{p}|{f}",
        ])
        .args(selection)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let mut crates = Crates::new();
    for line in String::from_utf8(output.stdout).unwrap().lines() {
        let Some((name, features)) = line.split_once('|') else { continue };
        let features = features.trim_end_matches(" (*)").to_owned();
        crates.entry(name.to_owned()).or_default().insert(features);
    }
    crates
}

#[test]
fn the_default_members_have_nothing_of_the_station() {
    let everybody = tree(&[]);
    assert!(everybody.len() > 100, "{everybody:?}");
    let ours = everybody.keys().filter(|name| name.starts_with("halfrow-station") || name.contains("sqlite"));
    assert_eq!(ours.collect::<Vec<_>>(), Vec::<&String>::new());
}

#[test]
fn what_halfrow_is_made_of_is_compiled_once_for_both_programs() {
    let (everybody, station) = (tree(&[]), tree(&["--package", "halfrow-station"]));
    let halfrow = tree(&["--package", "halfrow-cli"]);
    let shared: Vec<_> = halfrow.keys().filter(|name| station.contains_key(*name)).collect();
    assert!(shared.len() > 80, "{shared:?}");
    for name in shared {
        let (first, again) = (&everybody[name], &station[name]);
        assert_eq!(first, again, "{name} is compiled twice; name its features in the workspace's Cargo.toml");
    }
}

/// The comparison sees another set of features: without the other default members `halfrow-frames` has fewer.
#[test]
fn a_crate_with_other_features_would_be_seen() {
    let (everybody, alone) = (tree(&[]), tree(&["--package", "halfrow-frames"]));
    let differing = alone.iter().filter(|(name, features)| everybody[*name] != **features);
    assert!(differing.count() > 0);
}
