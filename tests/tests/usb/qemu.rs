//! The link drives a chip that this project did not make.

use halfrow_tests::program::{Running, command};
use halfrow_tests::usb::{QEMU_CHIP, QemuBoard, QemuChipOut, verify};

#[test]
#[ignore = "needs scripts/in-linux"]
fn boards_behind_qemu_s_chip_are_told_apart() {
    let sound = QemuBoard::new("");
    let ended = verify(QEMU_CHIP).succeeded();
    assert!(
        ended.json()["link"]["name"].as_str().unwrap().contains("FT232, channel A, 3000000 baud"),
        "{ended:?}"
    );
    drop(sound);
    let _broken = QemuBoard::new(",fault=stuck-data");
    let ended = verify(QEMU_CHIP);
    assert_eq!(ended.code, Some(1), "{ended:?}");
    assert!(ended.headline().contains("data bit 5 stuck at 1"), "{ended:?}");
}

#[test]
#[ignore = "needs scripts/in-linux"]
fn qemu_s_chip_is_pulled_out_in_the_middle_and_comes_back() {
    let board = QemuBoard::new("");
    let call =
        ["verify", "--json", "--board", QEMU_CHIP, "--width", "128", "--height", "16", "--repeat", "99"];
    let run = Running::start(&mut command(call));
    board.said().wait_for_rows();
    let out = QemuChipOut::pull();
    let ended = run.end();
    assert_eq!(ended.code, Some(3), "{ended:?}");
    assert!(ended.headline().contains("went away at"), "{ended:?}");
    drop(board);
    drop(out);
    let _board = QemuBoard::new("");
    verify(QEMU_CHIP).succeeded();
}
