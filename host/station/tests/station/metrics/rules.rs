//! The example of alert rules, checked by `promtool`.

use std::fs;
use std::path::PathBuf;

use tempfile::TempDir;

use super::text::promtool;

/// The path of a file of the examples.
pub(super) fn example(name: &str) -> PathBuf {
    [env!("CARGO_MANIFEST_DIR"), "monitoring", name].iter().collect()
}

/// The rules and their tests, in a folder in which they may be changed.
fn copied() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for name in ["alerts.yml", "alerts-test.yml"] {
        fs::copy(example(name), folder.path().join(name)).unwrap();
    }
    folder
}

#[test]
fn every_alert_fires_when_it_should_and_else_not() {
    let folder = copied();
    let check = promtool(&["check", "rules", "alerts.yml"], folder.path(), "");
    assert_eq!(check.code, Some(0), "{check:?}");
    let test = || promtool(&["test", "rules", "alerts-test.yml"], folder.path(), "");
    let right = test();
    assert_eq!(right.code, Some(0), "{right:?}");
    let (rules, tests) = (folder.path().join("alerts.yml"), folder.path().join("alerts-test.yml"));
    let (text, tests) = (fs::read_to_string(&rules).unwrap(), fs::read_to_string(tests).unwrap());
    let alerts: Vec<_> = text.lines().filter_map(|line| line.trim().strip_prefix("- alert: ")).collect();
    assert!(alerts.len() >= 8, "{alerts:?}");
    // Each alert is seen to fire, and its test to fail when it does not.
    let never = text.replace("expr:", "expr: vector(0) > 1 #");
    // An expression that follows on lines of its own must still be one.
    let never = never.replace("vector(0) > 1 # |", "|\n          vector(0) > 1 and");
    fs::write(&rules, never).unwrap();
    let did = test();
    assert_eq!(did.code, Some(1), "{did:?}");
    for alert in alerts {
        assert!(tests.contains(&format!("alertname: {alert}\n")), "{alert} is not tested");
        let failed = format!("alertname: {alert},");
        let told = [&did.complained, &did.said].iter().any(|said| said.contains(&failed));
        assert!(told, "{alert} never fires, and its test passes: {did:?}");
    }
}
