//! The mock's scenarios, behind chips.

use halfrow_tests::scenarios::all;
use halfrow_tests::usb::{QEMU_CHIP, QemuBoard, is_quick, of_boards, plug, run_all};

#[test]
#[ignore = "needs scripts/in-linux"]
fn every_eightieth_of_the_small_ones_behind_an_ft2232h() {
    // Those halfway between the ones that are judged behind the kernel's own driver.
    let quick = all().filter(is_quick).skip(40);
    run_all(quick.step_by(80), plug, |_| "usb".to_owned());
}

#[test]
#[ignore = "needs scripts/in-linux"]
fn every_eightieth_of_the_small_ones_behind_qemu_s_chip() {
    let quick = of_boards().filter(is_quick);
    run_all(quick.step_by(80), QemuBoard::new, |_| QEMU_CHIP.to_owned());
}
