//! Plans that were changed in the plant's database by somebody without a trusted key.

use std::fs;

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use halfrow::result::sha256;
use halfrow_station::published::{Bundle, SigningKey, Statement};
use halfrow_station::store::Plant;
use serde_json::{Value, json};

use super::plans::{IS_NEW, Published};
use crate::common::{PLAN, instead};

/// A second step, to follow the first.
const SECOND: &str = "\n[[step]]\nkind = \"verify\"\nname = \"second\"\nframes = [\"frames/a.pgm\"]\n";

/// Writes the plan of this version with a first step that names no file.
fn in_two_steps(made: &Published, version: &str) {
    made.plan(version, 2);
    let text = PLAN.replace("version = \"1\"", &format!("version = \"{version}\""));
    fs::write(made.path("plan.toml"), text + SECOND).unwrap();
}

/// Makes `change` to the bundle of the plan that holds, in the plant's database.
fn tampered(made: &Published, change: impl FnOnce(&mut Value)) {
    let mut plant = made.server.client("plant");
    let row = "SELECT sha256, text FROM bundle WHERE sha256 = (SELECT sha256 FROM publication ORDER BY number DESC LIMIT 1)";
    let row = plant.query_one(row, &[]).unwrap();
    let (hash, text): (String, String) = (row.get(0), row.get(1));
    let mut bundle = serde_json::from_str(&text).unwrap();
    change(&mut bundle);
    plant.execute("UPDATE bundle SET text = $2 WHERE sha256 = $1", &[&hash, &bundle.to_string()]).unwrap();
}

/// What is in the station's folder of plans, sorted.
fn kept(made: &Published) -> Vec<String> {
    let entries = fs::read_dir(made.path("data/plans")).unwrap();
    let mut names: Vec<_> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// The hash is that of the text followed by the files' names, but does not cover where one ends and the next begins.
#[test]
fn a_plan_that_was_cut_in_two_is_refused_until_it_is_published_again() {
    let made = Published::new();
    made.publish("engel.key");
    made.fetch();
    let before = kept(&made);
    in_two_steps(&made, "2");
    assert_eq!(made.publish("engel.key").said, "CAM-T/quick 2 holds, as number 2\n");
    tampered(&made, |bundle| {
        let text = bundle["text"].as_str().unwrap().to_owned();
        let at = text.rfind("\n[[step]]").unwrap();
        let file = format!("{}\n{}", &text[at + 1..], bundle["files"][0]["path"].as_str().unwrap());
        bundle["text"] = json!(&text[..at]);
        bundle["files"][0]["path"] = json!(file);
    });
    let refused = made.fetch();
    assert!(refused.code == Some(3) && refused.complained.contains("publish it again"), "{refused:?}");
    assert_eq!((made.held(), kept(&made)), (("1".to_owned(), 1), before), "nothing was changed");
    assert_eq!(made.publish("engel.key").said, "CAM-T/quick 2 holds, as number 3\n");
    assert_eq!(made.fetch().said, format!("CAM-T/quick 2, number 3, {IS_NEW}\n"));
    assert_eq!(made.held(), ("2".to_owned(), 2));
}

#[test]
fn publishing_again_puts_a_damaged_plan_right() {
    let made = Published::new();
    made.publish("engel.key");
    tampered(&made, |bundle| bundle["text"] = json!("nothing"));
    let refused = made.fetch();
    assert!(refused.code == Some(3) && refused.complained.contains("publish it again"), "{refused:?}");
    assert_eq!(made.publish("engel.key").said, "CAM-T/quick 1 holds, as number 2\n");
    assert_eq!(made.fetch().said, format!("CAM-T/quick 1, number 2, {IS_NEW}\n"));
}

/// It is signed, but the plan in it has another hash than the whole.
#[test]
fn a_plan_with_a_file_that_it_does_not_name_is_refused_before_anything_is_kept() {
    let made = Published::new();
    made.publish("engel.key");
    made.fetch();
    let before = kept(&made);
    let text = PLAN.replace("version = \"1\"", "version = \"2\"");
    let (name, content) = ("frames/b.pgm", b"anything");
    let hash = sha256([format!("{text}\n{name}\0{}", sha256([content]))]);
    let bundle = json!({ "schema": 1, "text": text, "files": [{ "path": name, "base64": BASE64_STANDARD.encode(content) }] });
    let bundle: Bundle = serde_json::from_value(bundle).unwrap();
    let key = SigningKey::load(made.path("engel.key").as_ref()).unwrap();
    let statement = Statement {
        schema: Statement::SCHEMA,
        product: "CAM-T".to_owned(),
        name: "quick".to_owned(),
        version: "2".to_owned(),
        sha256: hash,
        number: 2,
        operator: "engel".to_owned(),
        reason: "by another program".to_owned(),
        key: key.public(),
    };
    let signature = key.sign(&statement.text());
    let mut plant = Plant::connect(&made.server.address()).unwrap();
    assert!(plant.publish(&statement, &signature, Some(&bundle)).unwrap());
    let refused = made.fetch();
    assert!(refused.code == Some(3) && refused.complained.contains("has the hash"), "{refused:?}");
    assert_eq!((made.held(), kept(&made)), (("1".to_owned(), 1), before), "nothing was changed");
}

#[test]
fn a_plan_whose_files_have_control_characters_in_their_names_is_not_published() {
    let made = Published::new();
    fs::write(made.path("frames/a\nb.pgm"), fs::read(made.path("frames/a.pgm")).unwrap()).unwrap();
    instead(made.path("plan.toml"), "frames/a.pgm", "frames/a\\nb.pgm");
    let refused = made.publish("engel.key");
    assert!(refused.code == Some(2) && refused.complained.contains("control characters"), "{refused:?}");
    assert_eq!(made.server.rows("SELECT count(*) FROM publication"), [["0"]]);
}
