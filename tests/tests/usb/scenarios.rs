//! The scenarios of the mock, behind chips.

use halfrow_tests::scenario::Scenario;
use halfrow_tests::scenarios::{BROKEN_BOARDS, MISFITS, SOUND_BOARDS, all};
use halfrow_tests::usb::{QEMU_CHIP, QemuBoard, is_quick, is_small, plug, run_all};

/// Those that say something about a board: QEMU's chip stays plugged in whatever becomes of the link behind it.
fn of_boards() -> impl Iterator<Item = &'static Scenario> {
    [SOUND_BOARDS, BROKEN_BOARDS, MISFITS].into_iter().flatten().filter(is_small)
}

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

#[test]
#[ignore = "long"]
fn every_one_behind_an_ft2232h() {
    run_all(all().filter(is_small), "usb", true, plug);
    run_all(all().filter(|scenario| !is_small(scenario)), "usb", false, plug);
}

#[test]
#[ignore = "long"]
fn every_small_one_behind_qemu_s_chip() {
    run_all(of_boards(), QEMU_CHIP, true, QemuBoard::new);
}
