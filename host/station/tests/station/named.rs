//! What a person does enters the audit under that person's name.

use std::process::Command;

use crate::common::{Did, program};

/// Every act of a person, with all that it needs beside a name.
const ACTS: [&[&str]; 17] = [
    &["waive", "run", "--reason", "why", "--data", "."],
    &["rebind", "--serial", "CA1", "--reason", "why", "--data", "."],
    &["prune", "--data", "."],
    &["outbox", "release", "run", "--reason", "why", "--settings", "s.toml"],
    &["outbox", "again", "mes", "--reason", "why", "--settings", "s.toml"],
    &["outbox", "forget", "mes", "--reason", "why", "--settings", "s.toml"],
    &["plan", "publish", "plan.toml", "--key", "key", "--reason", "why", "--settings", "s.toml"],
    &["plan", "back", "CAM-A/final", "1", "--key", "key", "--reason", "why", "--settings", "s.toml"],
    &["plant", "forget", "12", "--reason", "why", "--settings", "s.toml"],
    &["plant", "prune", "--older-than", "400", "--reason", "why", "--settings", "s.toml"],
    &["job", "add", "--plan", "plan.toml", "--kind", "mock", "--settings", "s.toml"],
    &["job", "cancel", "job", "--reason", "why", "--settings", "s.toml"],
    &["job", "retry", "job", "--reason", "why", "--settings", "s.toml"],
    &["board", "share", "b", "--kind", "mock", "--board", "mock", "--settings", "s.toml"],
    &["board", "out", "b", "--reason", "why", "--settings", "s.toml"],
    &["board", "in", "b", "--reason", "why", "--settings", "s.toml"],
    &["board", "unshare", "b", "--reason", "why", "--settings", "s.toml"],
];

/// The handbook calls commands by `sudo -u halfrow`, and cron sets no USER at all.
#[test]
fn no_account_and_no_blank_stands_for_the_person_who_acts() {
    let folder = crate::common::folder();
    let did = |arguments: &[&str], user: &str| -> Did {
        let mut command = Command::new(program());
        command.args(arguments).env("USER", user).current_dir(folder.path());
        command.output().unwrap().into()
    };
    for act in ACTS {
        let unnamed = did(act, "halfrow");
        assert_eq!(unnamed.code, Some(2), "{act:?}: {unnamed:?}");
        assert!(unnamed.complained.contains("--operator <NAME>"), "{act:?}: {unnamed:?}");
        for blank in ["", " "] {
            let blank = did(&[act, &["--operator", blank]].concat(), "halfrow");
            assert!(blank.complained.contains("say who you are"), "{act:?}: {blank:?}");
        }
        let named = did(&[act, &["--operator", "engel"]].concat(), "halfrow");
        assert!(!named.complained.contains("--operator"), "{act:?}: {named:?}");
    }
}
