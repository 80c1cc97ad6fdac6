//! The same emulated chip behind the kernel's own driver, so it is not one that only this project's link accepts.

use std::fs::{self, Permissions};
use std::os::unix::fs::PermissionsExt as _;
use std::os::unix::process::CommandExt as _;
use std::path::Path;

use halfrow_ft2232h::{ChipOptions, Plugged};
use halfrow_tests::program::{command, finish};
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

#[test]
#[ignore = "needs scripts/in-linux"]
fn a_rate_that_is_not_the_board_s_is_counted_by_the_driver() {
    let options = ChipOptions { board_baud: Some(3_000_000), ..uart() };
    let board = Plugged::new(chip(options, ",speed=300000"), 0).unwrap();
    let ended = verify(&format!("serial:{}", serial_port(&board, 1).display()));
    assert_eq!(ended.code, Some(3), "{ended:?}");
    let said = ended.json();
    assert!(said["link"]["line_errors"]["framing"].as_u64().unwrap() > 0, "{ended:?}");
    assert!(said["remedy"].as_str().unwrap().contains("`baud=`"), "{ended:?}");
    // What was counted before belongs to the other run.
    let ended = verify(&target(&board)).succeeded();
    assert_eq!(ended.json()["link"]["line_errors"]["framing"], 0);
}

/// Whoever may open the port need not be root for this.
#[test]
#[ignore = "needs scripts/in-linux"]
fn a_chip_holds_bytes_back_no_longer_than_it_must() {
    let board = plug("");
    let port = serial_port(&board, 1);
    let folder = Path::new("/sys/bus/usb-serial/devices").join(port.file_name().unwrap());
    let milliseconds = || fs::read_to_string(folder.join("latency_timer")).unwrap();
    // What a chip has when it is plugged in, by FTDI's AN232B-04.
    assert_eq!(milliseconds().trim(), "16");
    fs::set_permissions(&port, Permissions::from_mode(0o666)).unwrap();
    finish(command(["info", "--board", &target(&board)]).uid(65534)).succeeded();
    assert_eq!(milliseconds().trim(), "1");
}
