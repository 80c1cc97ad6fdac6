//! Taps and the arithmetic after them.

use halfrow_model::Interpolant;

use crate::bench::{Bench, assert_named, fault, narrow, wide};

/// The taps in order.
const TAPS: [&str; 7] = ["G0", "R1", "G2", "R3", "G4", "R5", "G6"];

#[test]
fn a_window_that_is_off_is_named_with_its_offset() {
    for (columns, place) in [
        (-3, "3 columns to the left"),
        (-2, "2 columns to the left"),
        (-1, "one column to the left"),
        (1, "one column to the right"),
        (2, "2 columns to the right"),
        (3, "3 columns to the right"),
    ] {
        let place = format!("the window's read address, {place}");
        assert_named(&narrow(), &format!("tap-offset,columns={columns}"), &place);
        assert_named(&wide(), &format!("tap-offset,columns={columns}"), &place);
    }
}

#[test]
fn a_sum_that_is_not_rounded_is_named() {
    assert_named(&narrow(), "no-rounding", "the output's rounding");
    assert_named(&wide(), "no-rounding", "the output's rounding");
}

#[test]
fn every_dead_tap_of_hermite_is_named() {
    for tap in [1, 2, 3, 4, 5] {
        assert_named(&narrow(), &format!("dead-tap,tap={tap}"), &format!("tap {} stuck at 0", TAPS[tap]));
    }
}

#[test]
fn every_dead_tap_of_keys_is_named() {
    let bench = Bench::new(128, 16, 20.0, 128, Interpolant::Keys);
    for tap in [0, 2, 4, 6] {
        assert_named(&bench, &format!("dead-tap,tap={tap}"), &format!("tap {} stuck at 0", TAPS[tap]));
    }
}

#[test]
fn a_tap_that_carries_its_neighbour_is_named_with_it() {
    for (tap, other) in [(1, 0), (1, 2), (2, 1), (2, 3), (3, 2), (3, 4), (4, 3), (4, 5), (5, 4), (5, 6)] {
        let place = format!("tap {} reading {}", TAPS[tap], TAPS[other]);
        assert_named(&narrow(), &format!("dead-tap,tap={tap},reads={other}"), &place);
    }
}

/// The Hermite kernel has no weight for G0 or G6.
#[test]
fn a_dead_tap_that_nothing_weighs_is_not_suspected() {
    assert_eq!(narrow().diagnose(fault("dead-tap,tap=0")), []);
}
