//! Boards behind an FT2232H are judged like boards in this process.

use halfrow_ft2232h::{ChipOptions, Plugged};
use halfrow_tests::usb::{chip, uart, verify};

/// The board that is plugged in passes, and nothing from it came damaged.
fn passes_undamaged() {
    let ended = verify("usb");
    assert_eq!(
        (ended.code, ended.json()["link"]["damaged_in"].as_u64()),
        (Some(0), Some(0)),
        "{}",
        ended.headline()
    );
}

#[test]
#[ignore = "needs scripts/in-linux"]
fn a_sound_board_behind_a_uart_passes() {
    let _board = Plugged::new(chip(uart(), ",speed=1200000"), 0).unwrap();
    let ended = verify("usb").succeeded();
    assert!(ended.json()["link"]["name"].as_str().unwrap().contains("12000000 baud"), "{ended:?}");
}

/// A hub of USB 1.1, or an isolator, makes a fast chip send packets of 64 bytes.
#[test]
#[ignore = "needs scripts/in-linux"]
fn a_sound_board_at_a_port_of_full_speed_passes() {
    for options in [ChipOptions::default(), uart()] {
        let options = ChipOptions { is_slowed: true, ..options };
        let _board = Plugged::new(chip(options, ",speed=1000000"), 0).unwrap();
        passes_undamaged();
    }
}

#[test]
#[ignore = "needs scripts/in-linux"]
fn a_rate_that_is_not_the_board_s_is_seen_on_the_line() {
    let options = ChipOptions { board_baud: Some(3_000_000), ..uart() };
    let _board = Plugged::new(chip(options, ",speed=300000"), 0).unwrap();
    let ended = verify("usb");
    assert_eq!(ended.code, Some(3), "{ended:?}");
    let said = ended.json();
    assert!(said["link"]["line_errors"]["framing"].as_u64().unwrap() > 0, "{ended:?}");
    assert!(said["remedy"].as_str().unwrap().contains("`baud=`"), "{ended:?}");
    let ended = verify("usb,baud=3000000").succeeded();
    assert_eq!(ended.json()["link"]["line_errors"]["framing"], 0);
}

#[test]
#[ignore = "needs scripts/in-linux"]
fn what_lay_in_the_chip_before_does_no_harm() {
    let options = ChipOptions { stale: vec![0x55; 3000], ..ChipOptions::default() };
    let _board = Plugged::new(chip(options, ""), 0).unwrap();
    passes_undamaged();
}
