//! The same emulated chip behind the kernel's own driver, so it is not one that only this project's link accepts.

use halfrow_ft2232h::Plugged;
use halfrow_tests::scenarios::all;
use halfrow_tests::usb::{chip, is_quick, run_all, serial_port, uart, verify};

fn plug(options: &str) -> Plugged {
    Plugged::new(chip(uart(), options), 0).unwrap()
}

fn target(board: &Plugged) -> String {
    format!("serial:{},baud=3000000", serial_port(board, 1).display())
}

#[test]
#[ignore = "needs scripts/in-linux"]
fn every_eightieth_of_the_small_scenarios() {
    run_all(all().filter(is_quick).step_by(80), plug, target);
}

#[test]
#[ignore = "needs scripts/in-linux"]
fn a_board_that_is_pulled_out() {
    let board = plug(",fault=disconnect,byte=30000,toward=host");
    let ended = verify(&target(&board));
    assert_eq!(ended.code, Some(3), "{ended:?}");
    assert!(ended.headline().contains("the link broke"), "{ended:?}");
}
