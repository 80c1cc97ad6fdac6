//! CONFIGURE: the limits of every field, and when it is refused.

use halfrow_mock::{Depth, Options};
use halfrow_protocol::message::{Configuration, RefusalCode, Request};

use crate::bench::{Bench, HELLO};
use crate::frames::{configuration, ready};

fn build() -> Options {
    let depths = vec![Depth::Eight, Depth::Twelve];
    Options { max_width: 640, max_height: 480, least_blanking: 7, depths, ..Options::default() }
}

/// A configuration that the build can just have.
const FINE: Configuration =
    Configuration { width: 640, height: 480, centre2: 1278, blanking: 7, gap_seed: u32::MAX, bits: 12 };

/// What the board says to these configurations.
fn refusals(configurations: impl IntoIterator<Item = Configuration>) -> Vec<Option<(RefusalCode, u16)>> {
    let mut bench = Bench::switched_on(&build(), None);
    bench.greet(&HELLO);
    configurations.into_iter().map(|wanted| bench.ask(&Request::Configure(wanted)).refusal()).collect()
}

#[test]
fn values_at_their_limits_are_taken_and_the_reply_is_empty() {
    let least = Configuration { width: 64, height: 1, centre2: 0, blanking: 7, gap_seed: 0, bits: 8 };
    let most = Configuration { blanking: u16::MAX, ..FINE };
    assert_eq!(refusals([least, FINE, most]), [None; 3]);
    assert_eq!(Bench::greeted().done(&Request::Configure(configuration(1))).payload, []);
}

#[test]
fn a_width_that_is_odd_or_out_of_range_is_field_0() {
    let wrong = [0, 1, 62, 63, 65, 639, 641, 642, 65535].map(|width| Configuration { width, ..FINE });
    assert_eq!(refusals(wrong), [Some((RefusalCode::Range, 0)); 9]);
}

#[test]
fn a_height_out_of_range_is_field_1() {
    let wrong = [0, 481, 65535].map(|height| Configuration { height, ..FINE });
    assert_eq!(refusals(wrong), [Some((RefusalCode::Range, 1)); 3]);
}

#[test]
fn a_centre_outside_the_row_is_field_2() {
    let wrong = [(640, 1279), (64, 127), (64, 65535)];
    let wrong = wrong.map(|(width, centre2)| Configuration { width, centre2, ..FINE });
    assert_eq!(refusals(wrong), [Some((RefusalCode::Range, 2)); 3]);
}

#[test]
fn too_little_blanking_is_field_3() {
    let wrong = [0, 6].map(|blanking| Configuration { blanking, ..FINE });
    assert_eq!(refusals(wrong), [Some((RefusalCode::Range, 3)); 2]);
}

#[test]
fn a_depth_that_the_build_does_not_have_is_field_5() {
    let wrong = [0, 7, 9, 10, 11, 13, 16, 255].map(|bits| Configuration { bits, ..FINE });
    assert_eq!(refusals(wrong), [Some((RefusalCode::Range, 5)); 8]);
}

#[test]
fn a_refused_configuration_leaves_the_one_before() {
    let mut bench = ready(&Options::default(), 1);
    bench.refused(&Request::Configure(Configuration { width: 128, bits: 9, ..configuration(1) }));
    assert_eq!(bench.send_all(1, [0]).len(), 1);
}

#[test]
fn a_repeated_configuration_is_taken_and_changes_nothing() {
    let mut bench = ready(&Options::default(), 1);
    bench.done(&Request::Configure(configuration(1)));
    assert_eq!(bench.send_all(1, [0]).len(), 1);
}

#[test]
fn nothing_is_configured_while_a_row_is_in_the_core() {
    let mut bench = ready(&Options::default(), 2);
    bench.send_all(2, [0]);
    assert_eq!(bench.refused(&Request::Configure(configuration(2))), (RefusalCode::Busy, 0));
}

#[test]
fn nothing_is_configured_while_a_row_waits_in_an_input_bank() {
    let mut bench = ready(&Options::default(), 2);
    bench.send_all(2, [1]);
    assert_eq!(bench.refused(&Request::Configure(configuration(2))), (RefusalCode::Busy, 0));
}

#[test]
fn nothing_is_configured_while_a_row_waits_for_its_acknowledgement() {
    let mut bench = ready(&Options::default(), 2);
    bench.send_all(2, [0, 1]);
    bench.window = 1;
    let wider = Request::Configure(Configuration { width: 128, ..configuration(2) });
    assert_eq!(bench.refused(&wider), (RefusalCode::Busy, 0));
    let again = bench.send_all(2, [1]);
    assert_eq!(again[0].row().place.width, 64);
    bench.window = 2;
    bench.done(&wider);
}
