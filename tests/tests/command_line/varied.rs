//! What `verify` varies by itself, and what it reports as not exercised.

use halfrow_tests::program::{Folder, halfrow};
use serde_json::{Value, json};

use crate::small;

/// The settings in which the frames of a call differ from its tables.
fn variations(arguments: &[&str]) -> Vec<Value> {
    let said = halfrow(small("verify", arguments).into_iter().chain(["--json"])).json();
    assert_eq!(said["verdict"], "PASS", "{arguments:?}");
    let frames = said["frames"].as_array().unwrap();
    frames.iter().map(|frame| frame["variation"].clone()).filter(|variation| !variation.is_null()).collect()
}

fn centre() -> Value {
    json!({ "kind": "centre", "centre2": 0 })
}

fn depth(bits: u32) -> Value {
    json!({ "kind": "depth", "bits": bits })
}

#[test]
fn centre_and_depth_vary_unless_the_call_says_them() {
    assert_eq!(variations(&[]), [centre(), depth(8), depth(10)]);
    assert_eq!(variations(&["--bits", "12"]), [centre()]);
    assert_eq!(variations(&["--centre-x", "63.5"]), [depth(8), depth(10)]);
    assert_eq!(variations(&["--frame", "builtin:bars"]), [Value::Null; 0]);
}

#[test]
fn a_board_of_one_depth_has_no_other_one() {
    assert_eq!(variations(&["--board", "mock,depths=12"]), [centre()]);
}

#[test]
fn tables_of_a_file_stay_as_they_are() {
    let folder = Folder::new();
    folder.halfrow(small("tables", &["-o", "lens.json"])).succeeded();
    let said = folder.halfrow(["verify", "--json", "--tables", "lens.json", "--at-speed", "0"]).json();
    assert!(said["frames"].as_array().unwrap().iter().all(|frame| frame["variation"].is_null()));
    let codes: Vec<_> =
        said["not_exercised"].as_array().unwrap().iter().map(|part| part["code"].clone()).collect();
    assert!(codes.contains(&"one-centre".into()) && codes.contains(&"depths".into()), "{codes:?}");
}

#[test]
fn a_pass_says_in_words_what_it_did_not_exercise() {
    let ended = halfrow(small("verify", &["--at-speed", "0"]));
    let text = ended.stdout.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(text.contains("not exercised: address lines 7 to 10 of columns; "), "{text}");
    // Corners at full speed have what no streamed frame has.
    let whole = halfrow(small("verify", &[]));
    assert!(whole.code == Some(0) && !whole.stdout.contains("not exercised"), "{}", whole.stdout);
    let broken = halfrow(small("verify", &["--board", "mock,fault=stuck-data"]));
    assert!(!broken.stdout.contains("not exercised"), "{}", broken.stdout);
}

/// A recording of a program without variations does not mention them.
#[test]
fn a_recording_that_does_not_speak_of_variations_has_none() {
    let folder = Folder::new();
    let fixed = ["--bits", "12", "--centre-x", "63.5", "--record", "run.rec"];
    folder.halfrow(small("verify", &fixed)).succeeded();
    let path = folder.path().join("run.rec");
    let bytes = std::fs::read(&path).unwrap();
    let key = br#""vary":{"centre":false,"depth":false},"#;
    let at = bytes.windows(key.len()).position(|window| window == key).unwrap();
    std::fs::write(&path, [&bytes[..at], &bytes[at + key.len()..]].concat()).unwrap();
    let ended = folder.halfrow(["verify", "--json", "--board", "replay:run.rec"]);
    assert_eq!((ended.code, ended.json()["frames"].as_array().unwrap().len()), (Some(0), 16));
}

/// The frames that were streamed are smaller, so only frames at speed have such a row.
#[test]
fn a_row_that_is_lost_row_by_row_as_well_is_no_matter_of_timing() {
    let size = ["verify", "-q", "--width", "128", "--height", "32", "--radius", "60"];
    let ended = halfrow(size.into_iter().chain(["--board", "mock,fault=lost-row,row=40"]));
    assert_eq!(ended.code, Some(1), "{}", ended.stdout);
    let words = ended.stdout.split_whitespace().collect::<Vec<_>>().join(" ");
    for said in [
        "sent row by row, row 40 of it did not come back",
        "suspect a fault at full speed, of a board that does not bring row 40 back row by row either",
        "Next: Check the row banks and the row player",
    ] {
        assert!(words.contains(said), "{said}: {}", ended.stdout);
    }
    for said in ["could not be compared", "timing of the datapath"] {
        assert!(!words.contains(said), "{said}: {}", ended.stdout);
    }
}
