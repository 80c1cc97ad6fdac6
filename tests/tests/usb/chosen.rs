//! Which of several chips a target names.

use std::fs::File;

use halfrow_ft2232h::{ChipOptions, Plugged};
use halfrow_tests::program::halfrow;
use halfrow_tests::usb::{QemuBoard, chip, plug, serial_port, verify};
use serde_json::Value;

fn plug_second(serial: &str) -> Plugged {
    let options = ChipOptions { serial: serial.to_owned(), ..ChipOptions::default() };
    Plugged::new(chip(options, ""), 1).unwrap()
}

#[test]
#[ignore = "needs scripts/in-linux"]
fn of_two_boards_the_user_chooses_one() {
    let (first, second) = (plug(""), plug_second("HR000002"));
    let (first, second) = (first.bus_name(), second.bus_name());
    let ended = verify("usb");
    assert_eq!(ended.code, Some(2), "{ended:?}");
    let expected = format!(
        "several boards could be meant; choose one: usb:HR000001 (miniSpartan6+, FT2232H at {first}), usb:HR000002 \
         (miniSpartan6+, FT2232H at {second})"
    );
    assert_eq!(ended.headline(), expected);
    for target in ["usb:HR000002".to_owned(), format!("usb:{second}")] {
        let ended = verify(&target).succeeded();
        assert!(ended.json()["link"]["name"].as_str().unwrap().contains("HR000002"), "{ended:?}");
    }
}

#[test]
#[ignore = "needs scripts/in-linux"]
fn boards_of_one_name_are_told_by_their_places() {
    let (first, second) = (plug(""), plug_second("HR000001"));
    let ended = verify("usb:HR000001");
    assert_eq!(ended.code, Some(2), "{ended:?}");
    for board in [&first, &second] {
        let place = board.bus_name();
        assert!(ended.headline().contains(&format!("usb:{place} (")), "{ended:?}");
    }
    let target = format!("usb:{}", second.bus_name());
    let ended = verify(&target).succeeded();
    assert!(ended.json()["link"]["name"].as_str().unwrap().starts_with(&target), "{ended:?}");
    let listed = halfrow(["boards", "--json"]).json();
    let targets: Vec<_> =
        listed["boards"].as_array().unwrap().iter().filter_map(|board| board["target"].as_str()).collect();
    assert!(targets.contains(&&*target), "{targets:?}");
}

#[test]
#[ignore = "needs scripts/in-linux"]
fn a_name_that_nobody_has_gets_the_names_that_there_are() {
    let _board = plug("");
    let ended = verify("usb:HR000009");
    assert_eq!(ended.code, Some(3), "{ended:?}");
    assert!(ended.headline().contains("no FTDI chip is called `HR000009`"), "{ended:?}");
    assert!(ended.headline().contains("usb:HR000001 (miniSpartan6+, FT2232H at"), "{ended:?}");
}

#[test]
#[ignore = "needs scripts/in-linux"]
fn a_chip_that_boards_do_not_have_is_never_taken_unasked() {
    let _board = QemuBoard::new("");
    let ended = verify("usb");
    assert_eq!(ended.code, Some(2), "{ended:?}");
    assert!(ended.headline().contains("no FT2232H, FT4232H or FT232H is plugged in"), "{ended:?}");
    assert!(ended.headline().contains("usb:QEMU0001"), "{ended:?}");
}

#[test]
#[ignore = "needs scripts/in-linux"]
fn the_list_of_boards_says_what_is_there_and_what_answers() {
    let board = plug("");
    let listed = |arguments: &[&str]| {
        let list = halfrow(["boards", "--json"].into_iter().chain(arguments.iter().copied())).json();
        let is_it = |entry: &&Value| entry["target"] == "usb:HR000001";
        list["boards"].as_array().unwrap().iter().find(is_it).cloned().unwrap()
    };
    let seen = listed(&[]);
    assert_eq!((&seen["access"]["state"], &seen["answer"]), (&"free".into(), &Value::Null), "{seen}");
    assert_eq!(
        (&seen["usb"]["product"], &seen["usb"]["interface"]),
        (&"miniSpartan6+".into(), &1.into()),
        "{seen}"
    );
    let asked = listed(&["--ask"]);
    assert_eq!(asked["answer"]["state"], "board", "{asked}");
    let _port = File::open(serial_port(&board, 1)).unwrap();
    let held = listed(&[]);
    assert_eq!(held["access"]["state"], "busy", "{held}");
    assert_eq!(held["access"]["holders"][0]["process"], std::process::id(), "{held}");
}
