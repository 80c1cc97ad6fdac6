//! Tests that take an hour together, in parts of some minutes; `scripts/test-usb --long` boots for each part and remembers those
//! that have passed.

mod speed;

use halfrow_tests::scenarios::all;
use halfrow_tests::usb::{QEMU_CHIP, QemuBoard, of_boards, plug, run_all};

use crate::unplugged;

const PARTS: usize = 4;

fn behind_an_ft2232h(part: usize) {
    run_all(all().skip(part).step_by(PARTS), plug, |_| "usb".to_owned());
}

fn behind_qemu_s_chip(part: usize) {
    run_all(of_boards().skip(part).step_by(PARTS), QemuBoard::new, |_| QEMU_CHIP.to_owned());
}

macro_rules! parts {
    ($($name:ident: $part:literal),*) => {
        /// Part 0, 1 and so on, as many as there are, so that none is left out.
        const _: () = {
            let parts = [$($part),*];
            assert!(parts.len() == PARTS);
            let mut place = 0;
            while place < PARTS {
                assert!(parts[place] == place);
                place += 1;
            }
        };
        $(mod $name {
            #[test]
            #[ignore = "long"]
            fn of_all_scenarios_behind_an_ft2232h() {
                super::behind_an_ft2232h($part);
            }

            #[test]
            #[ignore = "long"]
            fn of_the_small_scenarios_behind_qemu_s_chip() {
                super::behind_qemu_s_chip($part);
            }

            #[test]
            #[ignore = "long"]
            fn of_two_hundred_places_to_pull_the_plug() {
                super::unplugged::anywhere($part, 200 / super::PARTS);
            }
        })*
    };
}

parts!(first_part: 0, second_part: 1, third_part: 2, fourth_part: 3);
