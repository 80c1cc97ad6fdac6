//! The same chip behind the kernel's own driver: it is not one that only this project's link believes in.

use halfrow_ft2232h::Plugged;
use halfrow_tests::scenarios::all;
use halfrow_tests::usb::{chip, is_quick, sentence, serial_port, uart, verify};

fn plug(options: &str) -> Plugged {
    Plugged::new(chip(uart(), options), 0).unwrap()
}

fn target(board: &Plugged) -> String {
    format!("serial:{},baud=3000000", serial_port(board, 1).display())
}

#[test]
#[ignore = "needs scripts/in-linux"]
fn every_eightieth_of_the_small_scenarios() {
    let mut surprises = Vec::new();
    for scenario in all().filter(is_quick).step_by(80) {
        let board = plug(scenario.options);
        surprises.extend(scenario.judge(&target(&board), "mock behind ftdi_sio: ").err());
    }
    let surprises: Vec<_> = surprises.iter().map(ToString::to_string).collect();
    assert!(surprises.is_empty(), "{}", surprises.join("\n"));
}

#[test]
#[ignore = "needs scripts/in-linux"]
fn a_board_that_is_pulled_out() {
    let board = plug(",fault=disconnect,byte=30000,toward=host");
    let ended = verify(&target(&board));
    assert_eq!(ended.code, Some(3), "{ended:?}");
    assert!(sentence(&ended).contains("the link broke"), "{ended:?}");
}
