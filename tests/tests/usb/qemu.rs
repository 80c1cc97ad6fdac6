//! The link drives a chip that somebody else wrote.

use std::thread;
use std::time::Duration;

use halfrow_tests::usb::{QEMU_CHIP, QemuBoard, plug_qemu_chip, sentence, unplug_qemu_chip, verify};

#[test]
#[ignore = "needs scripts/in-linux"]
fn boards_behind_qemu_s_chip_are_told_apart() {
    let sound = QemuBoard::new("");
    let ended = verify(QEMU_CHIP);
    assert_eq!(ended.code, Some(0), "{ended:?}");
    assert!(
        ended.json()["link"]["name"].as_str().unwrap().contains("FT232, channel A, 3000000 baud"),
        "{ended:?}"
    );
    drop(sound);
    let _broken = QemuBoard::new(",fault=stuck-data");
    let ended = verify(QEMU_CHIP);
    assert_eq!(ended.code, Some(1), "{ended:?}");
    assert!(sentence(&ended).contains("data bit 5, stuck at 1"), "{ended:?}");
}

#[test]
#[ignore = "needs scripts/in-linux"]
fn qemu_s_chip_is_pulled_out_in_the_middle_and_comes_back() {
    let board = QemuBoard::new("");
    let run = thread::spawn(|| verify(QEMU_CHIP));
    thread::sleep(Duration::from_millis(700));
    unplug_qemu_chip();
    let ended = run.join().unwrap();
    assert_eq!(ended.code, Some(3), "{ended:?}");
    assert!(sentence(&ended).contains("went away at"), "{ended:?}");
    drop(board);
    plug_qemu_chip();
    let _board = QemuBoard::new("");
    let ended = verify(QEMU_CHIP);
    assert_eq!(ended.code, Some(0), "{ended:?}");
}
