//! What a chip is not set up for, or this user may not do.

use std::fs;
use std::os::unix::process::CommandExt as _;

use halfrow_ft2232h::{ChannelMode, ChipOptions, Eeprom, Plugged};
use halfrow_tests::program::{command, finish, halfrow};
use halfrow_tests::usb::{chip, plug, uart, verify};

#[test]
#[ignore = "needs scripts/in-linux"]
fn an_eeprom_that_contradicts_the_target_is_explained() {
    for (options, target, words) in [
        (ChipOptions::default(), "usb,mode=uart", "channel B of usb:HR000001 is a FIFO by its EEPROM"),
        (uart(), "usb,mode=fifo", "channel B of usb:HR000001 is a UART by its EEPROM"),
        (
            ChipOptions { eeprom: Eeprom::BLANK, ..uart() },
            "usb,mode=fifo",
            "is a UART, since its EEPROM is blank",
        ),
        (
            ChipOptions { eeprom: Eeprom::new(ChannelMode::Uart, ChannelMode::Cpu), ..uart() },
            "usb",
            "is a processor bus by its EEPROM",
        ),
        (
            ChipOptions { eeprom: Eeprom::new(ChannelMode::Uart, ChannelMode::Opto), ..uart() },
            "usb,mode=uart",
            "is a fast opto-isolated serial interface by its EEPROM",
        ),
    ] {
        let _board = Plugged::new(chip(options, ""), 0).unwrap();
        let ended = verify(target);
        assert_eq!(ended.code, Some(3), "{target}: {ended:?}");
        assert!(ended.headline().contains(words), "{target}: {ended:?}");
    }
}

#[test]
#[ignore = "needs scripts/in-linux"]
fn what_the_chip_cannot_do_is_a_wrong_call() {
    let _board = Plugged::new(chip(uart(), ""), 0).unwrap();
    for (target, words) in [
        ("usb,channel=d", "has no channel D"),
        ("usb,baud=7000000", "the nearest rates that it makes: 6000000 and 12000000"),
        ("usb,speed=5", "`speed=5` is not an option of `usb`"),
    ] {
        let ended = verify(target);
        assert_eq!(ended.code, Some(2), "{target}: {ended:?}");
        assert!(ended.headline().contains(words), "{target}: {ended:?}");
    }
}

/// A container whose /dev has no file of the device still sees it in /sys.
#[test]
#[ignore = "needs scripts/in-linux"]
fn a_device_that_the_program_is_not_given_is_not_said_to_be_unplugged() {
    let board = plug("");
    let number = |file: &str| {
        let told = fs::read_to_string(format!("/sys/bus/usb/devices/{}/{file}", board.bus_name())).unwrap();
        told.trim().parse::<u32>().unwrap()
    };
    fs::remove_file(format!("/dev/bus/usb/{:03}/{:03}", number("busnum"), number("devnum"))).unwrap();
    let ended = verify("usb");
    assert_eq!(ended.code, Some(3), "{ended:?}");
    assert!(ended.headline().contains("is plugged in, but this program is not given it"), "{ended:?}");
    let listed = halfrow(["boards", "--json"]).json();
    let mut listed = listed["boards"].as_array().unwrap().iter();
    let access = &listed.find(|board| board["target"] == "usb:HR000001").unwrap()["access"];
    assert_eq!(access["state"], "denied", "{access}");
    assert!(access["remedy"].as_str().unwrap().contains("container"), "{access}");
}

#[test]
#[ignore = "needs scripts/in-linux"]
fn a_user_without_permission_is_told_how_to_get_it() {
    let _board = plug("");
    let ended = finish(command(["verify", "--json", "--board", "usb"]).uid(65534));
    assert_eq!(ended.code, Some(3), "{ended:?}");
    assert!(ended.headline().contains("may not open the USB device usb:HR000001"), "{ended:?}");
}
