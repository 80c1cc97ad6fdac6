//! Plans that the plant publishes: a station only takes what an engineer signed, and never anything older than it had.

use std::fs;
use std::path::PathBuf;
use std::process::Command;

use halfrow_station::settings::Settings;
use tempfile::TempDir;

use super::server::Server;
use crate::common::{Did, PLAN, instead, plant_settings, program};

pub(super) const IS_NEW: &str =
    "is new; a station at work goes on with the plan that it has until it is started again";

/// A picture of eight rows, which a plan names.
fn picture(level: u8) -> Vec<u8> {
    let mut bytes = b"P5\n64 8\n4095\n".to_vec();
    bytes.extend((0..64 * 8).flat_map(|at: u16| [level, (at % 251) as u8]));
    bytes
}

/// An engineer with a plan, and a station that gets it from the plant, in `own` of a folder.
pub(super) struct Published {
    pub(super) server: Server,
    folder: TempDir,
    trusted: String,
}

impl Published {
    pub(super) fn new() -> Self {
        let (server, folder) = (Server::prepared(), crate::common::folder());
        fs::create_dir_all(folder.path().join("own/frames")).unwrap();
        let made = Self { server, folder, trusted: String::new() };
        let trusted = made.did(&["plan", "key", &made.path("engel.key")]).said.trim().to_owned();
        assert!(trusted.starts_with("ed25519:"), "{trusted}");
        let made = Self { trusted, ..made };
        made.plan("1", 1);
        let plant = format!("{}trusts = [\"{}\"]\n", plant_settings(&made.server.url()), made.trusted);
        let lane = "[[lane]]\nname = \"1\"\nboard = \"mock\"\nplans = [\"plant:CAM-T/quick\"]\n";
        let text = format!("schema = 1\n[station]\nname = \"12\"\ndata = \"data\"\n{plant}{lane}");
        fs::write(made.path("station.toml"), text).unwrap();
        made
    }

    pub(super) fn path(&self, name: &str) -> String {
        self.folder.path().join("own").join(name).display().to_string()
    }

    /// Writes the plan in this version, with a picture of this level.
    pub(super) fn plan(&self, version: &str, level: u8) {
        let text = PLAN
            .replace("version = \"1\"", &format!("version = \"{version}\""))
            .replace("builtin:noise", "frames/a.pgm");
        fs::write(self.path("plan.toml"), text).unwrap();
        fs::write(self.path("frames/a.pgm"), picture(level)).unwrap();
    }

    pub(super) fn did(&self, arguments: &[&str]) -> Did {
        let mut command = Command::new(program());
        command.args(arguments).env("HALFROW_STATION_SETTINGS", self.path("station.toml"));
        command.output().unwrap().into()
    }

    pub(super) fn publish(&self, key: &str) -> Did {
        let (plan, key) = (self.path("plan.toml"), self.path(key));
        self.did(&[
            "plan",
            "publish",
            &plan,
            "--key",
            &key,
            "--reason",
            "better frames",
            "--operator",
            "engel",
        ])
    }

    fn back(&self, version: &str) -> Did {
        let key = self.path("engel.key");
        self.did(&[
            "plan",
            "back",
            "CAM-T/quick",
            version,
            "--key",
            &key,
            "--reason",
            "it was better",
            "--operator",
            "engel",
        ])
    }

    pub(super) fn fetch(&self) -> Did {
        self.did(&["plan", "fetch"])
    }

    /// The version of the plan in the station's settings, and the level of its picture.
    pub(super) fn held(&self) -> (String, u8) {
        let settings = Settings::load(self.path("station.toml").as_ref()).unwrap();
        let plan = &settings.plans[0];
        let picture = fs::read(plan.path.parent().unwrap().join("frames/a.pgm")).unwrap();
        (plan.plan.version.clone(), picture[13])
    }
}

/// Otherwise a terminal would hide what follows.
#[test]
fn a_name_that_a_terminal_would_obey_is_spelt_out() {
    let made = Published::new();
    instead(made.path("plan.toml"), "\"quick\"", "\"q\\u001b[8m\\nPASS\"");
    instead(made.path("plan.toml"), "version = \"1\"", "version = \"1\\u0007\"");
    instead(made.path("station.toml"), "CAM-T/quick", "CAM-T/q\\u001b[8m\\nPASS");
    let told = "CAM-T/q\\u{1b}[8m\\nPASS 1\\u{7}";
    assert_eq!(made.publish("engel.key").said, format!("{told} holds, as number 1\n"));
    assert_eq!(made.fetch().said, format!("{told}, number 1, {IS_NEW}\n"));
    let (name, key) = ("CAM-T/q\u{1b}[8m\nPASS", made.path("engel.key"));
    let back = made.did(&[
        "plan",
        "back",
        name,
        "1\u{7}",
        "--key",
        &key,
        "--reason",
        "as it was",
        "--operator",
        "engel",
    ]);
    assert_eq!(back.said, format!("{told} holds, as number 2\n"));
}

#[test]
fn a_plan_comes_to_the_station_with_its_files_and_an_older_one_can_hold_again() {
    let made = Published::new();
    let early = Settings::load(made.path("station.toml").as_ref()).unwrap_err().to_string();
    assert!(early.contains("station.toml:") && early.contains("plan fetch"), "{early}");
    assert!(made.fetch().complained.contains("the plant has no plan CAM-T/quick"));
    assert_eq!(made.publish("engel.key").said, "CAM-T/quick 1 holds, as number 1\n");
    assert_eq!(made.fetch().said, format!("CAM-T/quick 1, number 1, {IS_NEW}\n"));
    assert_eq!(made.held(), ("1".to_owned(), 1));
    assert_eq!(made.fetch().said, "CAM-T/quick 1, number 1\n");
    // A plan by which runs were judged keeps its content under its version.
    made.plan("1", 2);
    let taken = made.publish("engel.key");
    assert!(taken.code == Some(2) && taken.complained.contains("a version of its own"), "{taken:?}");
    made.plan("2", 2);
    assert_eq!(made.publish("engel.key").said, "CAM-T/quick 2 holds, as number 2\n");
    assert_eq!(made.held(), ("1".to_owned(), 1), "until it is fetched");
    made.fetch();
    assert_eq!(made.held(), ("2".to_owned(), 2));
    let unknown = made.back("9");
    assert!(unknown.code == Some(2) && unknown.complained.contains("never had a plan"), "{unknown:?}");
    assert_eq!(made.back("1").said, "CAM-T/quick 1 holds, as number 3\n");
    made.fetch();
    assert_eq!(made.held(), ("1".to_owned(), 1));
    let listed = made.did(&["plan", "published"]);
    assert!(listed.said.contains("CAM-T/quick") && listed.said.contains("it was better"), "{listed:?}");
    let (_folder, serving) = super::pages::served(&made.server);
    let page = super::pages::text(&serving.here(), "/");
    assert!(page.contains("Published plans") && page.contains("it was better"), "{page}");
    let acts = made.server.rows("SELECT act, subject, detail FROM audit WHERE act != 'command' ORDER BY id");
    assert_eq!(acts[0], ["publish plan", "CAM-T/quick 1", "better frames"]);
    assert_eq!(acts.len(), 3);
    let given = made.server.rows("SELECT subject FROM audit WHERE act = 'command' ORDER BY id");
    let last: Vec<_> = given.iter().flatten().map(String::as_str).skip(given.len() - 2).collect();
    assert_eq!(last, ["plan publish CAM-T/quick", "plan back CAM-T/quick 1"]);
}

/// The settings name plans that only a plant with tables can have.
#[test]
fn an_empty_database_is_prepared_by_the_settings_of_a_station_with_plans_of_the_plant() {
    let made = Published::new();
    let empty = "DROP SCHEMA public CASCADE; CREATE SCHEMA public";
    made.server.change(empty);
    assert!(made.fetch().complained.contains("plant prepare"));
    let prepared = made.did(&["plant", "prepare"]);
    assert_eq!(prepared.code, Some(0), "{prepared:?}");
    assert_eq!(made.did(&["plant", "check"]).code, Some(0));
    made.publish("engel.key");
    assert_eq!(made.fetch().said, format!("CAM-T/quick 1, number 1, {IS_NEW}\n"));
}

#[test]
fn what_nobody_signed_who_is_trusted_is_not_taken() {
    let made = Published::new();
    made.publish("engel.key");
    made.fetch();
    // Somebody has another key, or changes the plant's database.
    made.did(&["plan", "key", &made.path("other.key")]);
    made.plan("2", 2);
    assert_eq!(made.publish("other.key").code, Some(0));
    let refused = |expected: &str| {
        let fetched = made.fetch();
        assert!(fetched.code == Some(3) && fetched.complained.contains(expected), "{expected}: {fetched:?}");
        assert_eq!(made.held(), ("1".to_owned(), 1));
    };
    refused("is not signed by a key of `trusts`");
    made.server.change(
        "UPDATE publication SET signature = (SELECT signature FROM publication WHERE number = 1) WHERE number = 2",
    );
    refused("is not signed by a key of `trusts`");
    made.server.change(
        "UPDATE publication SET statement = (SELECT replace(statement, '\"number\":1', '\"number\":2') FROM publication WHERE number = 1)
         WHERE number = 2",
    );
    refused("is not signed by a key of `trusts`");
    made.server.change("DELETE FROM publication WHERE number = 2");
    assert_eq!(made.publish("engel.key").said, "CAM-T/quick 2 holds, as number 2\n");
    made.server.change("UPDATE bundle SET text = replace(text, 'timeout = 60', 'timeout = 61')");
    refused("has the hash");
    made.server.change("UPDATE bundle SET text = 'nothing'");
    refused("is not a plan");
    // A statement that was valid once is refused after a later one.
    made.plan("3", 3);
    made.publish("engel.key");
    assert_eq!(made.fetch().said, format!("CAM-T/quick 3, number 3, {IS_NEW}\n"));
    made.server.change("DELETE FROM publication WHERE number > 1");
    let older = made.fetch();
    assert!(older.complained.contains("as its number 1, and here is number 3 already"), "{older:?}");
    assert_eq!(made.held(), ("3".to_owned(), 3));
}

/// A plant that is put back has lost statements, and gives their numbers again.
#[test]
fn a_plan_holds_again_once_it_was_published_as_often_as_numbers_are_missing() {
    let made = Published::new();
    for version in ["1", "2", "3"] {
        made.plan(version, 1);
        made.publish("engel.key");
    }
    made.fetch();
    made.server.change("DELETE FROM publication WHERE number > 1");
    made.plan("1", 1);
    for number in 2..=4 {
        let refused = made.fetch();
        assert!(refused.complained.contains("publish it again until its number is above 3"), "{refused:?}");
        assert_eq!(made.publish("engel.key").said, format!("CAM-T/quick 1 holds, as number {number}\n"));
    }
    assert_eq!(made.fetch().said, format!("CAM-T/quick 1, number 4, {IS_NEW}\n"));
}

/// As after the plant was put back, so that its number was given to another plan.
#[test]
fn another_plan_under_the_number_that_a_station_has_is_not_taken() {
    let made = Published::new();
    made.publish("engel.key");
    made.fetch();
    made.server.change("DELETE FROM publication");
    made.plan("2", 2);
    assert_eq!(made.publish("engel.key").said, "CAM-T/quick 2 holds, as number 1\n");
    let other = made.fetch();
    assert!(other.complained.contains("as its number 1, and here is number 1 already"), "{other:?}");
    assert_eq!(made.held(), ("1".to_owned(), 1));
}

/// What somebody who can write to the database, but has no trusted key, may try to make the engineer with the key sign.
#[test]
fn an_older_plan_holds_again_as_it_was_signed_or_not_at_all() {
    let made = Published::new();
    // Another plan of the same name and version is in the database.
    made.did(&["plan", "key", &made.path("other.key")]);
    made.plan("1", 9);
    made.publish("other.key");
    made.server.change("DELETE FROM publication");
    let other = made.server.rows("SELECT sha256 FROM bundle")[0][0].clone();
    made.plan("1", 1);
    made.publish("engel.key");
    made.plan("2", 2);
    made.publish("engel.key");
    made.server.change(&format!("UPDATE publication SET sha256 = '{other}' WHERE version = '1'"));
    assert_eq!(made.back("1").said, "CAM-T/quick 1 holds, as number 3\n");
    made.fetch();
    assert_eq!(made.held(), ("1".to_owned(), 1), "what was signed");
    let refused = |expected: &str| {
        let back = made.back("1");
        assert!(back.code == Some(3) && back.complained.contains(expected), "{expected}: {back:?}");
    };
    made.server.change(&format!(
        "UPDATE bundle SET text = replace(text, 'timeout = 60', 'timeout = 61') WHERE sha256 <> '{other}'"
    ));
    refused("has the hash");
    made.server.change(&format!(
        "UPDATE publication SET statement = regexp_replace(statement, '\"sha256\":\"[0-9a-f]*\"', '\"sha256\":\"{other}\"') WHERE version = '1'"
    ));
    refused("is signed neither by this key nor");
    made.server.change(
        "UPDATE publication SET statement = two.statement, signature = two.signature FROM publication two
            WHERE publication.version = '1' AND two.version = '2'",
    );
    refused("is signed neither by this key nor");
}

/// The next number is one more than the last that was signed with a trusted key.
#[test]
fn a_plan_gets_no_number_that_nobody_signed_who_is_trusted() {
    let made = Published::new();
    made.publish("engel.key");
    made.server.change(
        "UPDATE publication SET statement = replace(statement, '\"number\":1', '\"number\":9223372036854775807')",
    );
    made.plan("2", 2);
    let refused = || {
        let did = made.publish("engel.key");
        assert!(
            did.code == Some(3) && did.complained.contains("is signed neither by this key nor"),
            "{did:?}"
        );
    };
    refused();
    made.server.change("DELETE FROM publication");
    made.did(&["plan", "key", &made.path("other.key")]);
    made.publish("other.key");
    made.plan("3", 3);
    refused();
    assert_eq!(made.publish("other.key").said, "CAM-T/quick 3 holds, as number 2\n");
}

#[test]
fn what_was_kept_is_looked_at_again_whenever_it_is_used() {
    let made = Published::new();
    made.publish("engel.key");
    made.fetch();
    let settings = PathBuf::from(made.path("station.toml"));
    let file = Settings::load(&settings).unwrap().plans[0].path.clone();
    let text = fs::read_to_string(&file).unwrap();
    fs::write(&file, text.replace("timeout = 60", "timeout = 61")).unwrap();
    let changed = Settings::load(&settings).unwrap_err().to_string();
    assert!(changed.contains("is not as it was published"), "{changed}");
    assert_eq!(made.fetch().said, "CAM-T/quick 1, number 1\n");
    assert_eq!(fs::read_to_string(&file).unwrap(), text, "it is whole again");
    fs::remove_file(file.parent().unwrap().join("frames/a.pgm")).unwrap();
    made.fetch();
    assert_eq!(made.held(), ("1".to_owned(), 1));
    // A key that is no longer trusted.
    let mut other = fs::read_to_string(&settings).unwrap();
    let key = made.did(&["plan", "key", &made.path("other.key")]).said.trim().to_owned();
    other = other.replace(&made.trusted, &key);
    fs::write(&settings, other).unwrap();
    let untrusted = Settings::load(&settings).unwrap_err().to_string();
    assert!(untrusted.contains("does not trust any more"), "{untrusted}");
}

/// Settings and `plan back` name a plan by its product and its name, with a slash between.
#[test]
fn a_plan_whose_product_has_a_slash_is_not_published() {
    let made = Published::new();
    let text = fs::read_to_string(made.path("plan.toml")).unwrap();
    for (product, name, code) in [("CAM/T", "quick", 2), ("CAM-T", "quick/final", 0)] {
        let renamed =
            text.replace("\"CAM-T\"", &format!("\"{product}\"")).replace("\"quick\"", &format!("\"{name}\""));
        fs::write(made.path("plan.toml"), renamed).unwrap();
        let did = made.publish("engel.key");
        assert_eq!(did.code, Some(code), "{did:?}");
        assert_eq!(did.complained.contains("a product without a slash"), code == 2, "{did:?}");
    }
    instead(made.path("station.toml"), "CAM-T/quick", "CAM-T/quick/final");
    assert_eq!(made.fetch().said, format!("CAM-T/quick/final 1, number 1, {IS_NEW}\n"));
}

#[test]
fn what_is_no_plan_of_its_own_folder_or_no_key_is_refused() {
    let made = Published::new();
    fs::write(made.path("../outside.pgm"), picture(9)).unwrap();
    instead(made.path("plan.toml"), "frames/a.pgm", "../outside.pgm");
    let outside = made.publish("engel.key");
    assert!(
        outside.code == Some(2) && outside.complained.contains("lies outside of its folder"),
        "{outside:?}"
    );
    made.plan("1", 1);
    let no_key = made.publish("plan.toml");
    assert!(no_key.code == Some(2) && no_key.complained.contains("chmod 600"), "{no_key:?}");
    let folder = made.publish("frames");
    assert!(
        folder.code == Some(2) && folder.complained.contains("frames is a folder, and no file"),
        "{folder:?}"
    );
    let again = made.did(&["plan", "key", &made.path("engel.key")]);
    assert!(again.code == Some(2) && again.complained.contains("not there yet"), "{again:?}");
    let settings = fs::read_to_string(made.path("station.toml")).unwrap();
    fs::write(made.path("station.toml"), settings.replace("ed25519:", "rsa:")).unwrap();
    assert!(made.fetch().complained.contains("is no public key"));
    fs::write(made.path("station.toml"), settings.replace("plant:CAM-T/quick", "plant:quick")).unwrap();
    let no_name = Settings::load(made.path("station.toml").as_ref()).unwrap_err().to_string();
    assert!(no_name.contains("write plant:PRODUCT/NAME"), "{no_name}");
}
