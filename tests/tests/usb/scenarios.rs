//! The scenarios of the mock, behind chips.

use halfrow_tests::scenarios::all;
use halfrow_tests::usb::{QEMU_CHIP, QemuBoard, is_quick, of_boards, plug, run_all};

#[test]
#[ignore = "needs scripts/in-linux"]
fn every_sixth_of_the_small_ones_behind_an_ft2232h() {
    let quick = all().filter(is_quick);
    run_all(quick.step_by(6), "usb", true, plug);
}

#[test]
#[ignore = "needs scripts/in-linux"]
fn every_twelfth_of_the_small_ones_behind_qemu_s_chip() {
    let quick = of_boards().filter(is_quick);
    run_all(quick.step_by(12), QEMU_CHIP, true, QemuBoard::new);
}
