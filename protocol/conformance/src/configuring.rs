//! CONFIGURE: the limits of every field, and when it is refused.

use halfrow_protocol::message::{Configuration, RefusalCode, Request};

use crate::bench::{Bench, HELLO};
use crate::frames::{configuration, ready};
use crate::{Boards, Build, offered};

/// The builds whose limits are tried.
fn builds(on: &dyn Boards) -> Vec<Build> {
    let small =
        Build { max_width: 640, max_height: 480, least_blanking: 7, depths: &[8, 12], ..Build::default() };
    offered(on, [small, Build::default()])
}

/// A configuration at the limits of the build.
fn fine(build: &Build) -> Configuration {
    let (width, height, blanking) = (build.max_width, build.max_height, build.least_blanking);
    Configuration { width, height, centre2: 2 * width - 2, blanking, gap_seed: u32::MAX, bits: 12 }
}

/// Tries configurations on every build, and expects the same answer to all: done, or out of range with this field.
fn expect(
    on: &dyn Boards,
    expected: Option<u16>,
    configurations: impl Fn(&Build, Configuration) -> Vec<Configuration>,
) {
    for build in builds(on) {
        let mut bench = Bench::switched_on(on, &build);
        bench.greet(&HELLO);
        for wanted in configurations(&build, fine(&build)) {
            let refusal = bench.ask(&Request::Configure(wanted)).refusal();
            assert_eq!(refusal, expected.map(|field| (RefusalCode::Range, field)), "{wanted:?}");
        }
    }
}

pub(crate) fn values_at_their_limits_are_taken_and_the_reply_is_empty(on: &dyn Boards) {
    expect(on, None, |build, fine| {
        let blanking = build.least_blanking;
        let least = Configuration { width: 64, height: 1, centre2: 0, blanking, gap_seed: 0, bits: 8 };
        vec![least, fine, Configuration { blanking: u16::MAX, ..fine }]
    });
    assert_eq!(Bench::greeted(on).done(&Request::Configure(configuration(1))).payload, []);
}

pub(crate) fn a_width_that_is_odd_or_out_of_range_is_field_0(on: &dyn Boards) {
    expect(on, Some(0), |build, fine| {
        let most = build.max_width;
        let wrong = [0, 1, 62, 63, 65, most - 1, most + 1, most + 2, 2 * most, 65535];
        wrong.map(|width| Configuration { width, ..fine }).to_vec()
    });
}

pub(crate) fn a_height_out_of_range_is_field_1(on: &dyn Boards) {
    expect(on, Some(1), |build, fine| {
        [0, build.max_height + 1, 65535].map(|height| Configuration { height, ..fine }).to_vec()
    });
}

pub(crate) fn a_centre_outside_the_row_is_field_2(on: &dyn Boards) {
    expect(on, Some(2), |_, fine| {
        let wrong = [(fine.width, 2 * fine.width - 1), (64, 127), (64, 65535)];
        wrong.map(|(width, centre2)| Configuration { width, centre2, ..fine }).to_vec()
    });
}

pub(crate) fn too_little_blanking_is_field_3(on: &dyn Boards) {
    expect(on, Some(3), |build, fine| {
        (0..build.least_blanking).map(|blanking| Configuration { blanking, ..fine }).collect()
    });
}

pub(crate) fn a_depth_that_the_build_does_not_have_is_field_5(on: &dyn Boards) {
    expect(on, Some(5), |build, fine| {
        (0..=255)
            .filter(|bits| !build.depths.contains(bits))
            .map(|bits| Configuration { bits, ..fine })
            .collect()
    });
}

pub(crate) fn of_several_wrong_fields_bits_is_named_else_the_first(on: &dyn Boards) {
    let wrong = |fine: Configuration| Configuration { width: 63, height: 0, centre2: u16::MAX, ..fine };
    expect(on, Some(5), |build, fine| {
        let not_had = [0, 8, 9, 10, 12].into_iter().filter(|bits| !build.depths.contains(bits));
        not_had.map(|bits| Configuration { bits, ..wrong(fine) }).collect()
    });
    expect(on, Some(0), |_, fine| vec![wrong(fine)]);
    expect(on, Some(1), |_, fine| vec![Configuration { width: fine.width, ..wrong(fine) }]);
}

pub(crate) fn a_refused_configuration_leaves_the_one_before(on: &dyn Boards) {
    let mut bench = ready(on, &Build::default(), 1);
    bench.refused(&Request::Configure(Configuration { width: 128, bits: 9, ..configuration(1) }));
    assert_eq!(bench.send_all(1, [0]).len(), 1);
}

pub(crate) fn a_repeated_configuration_is_taken_and_changes_nothing(on: &dyn Boards) {
    let mut bench = ready(on, &Build::default(), 1);
    bench.done(&Request::Configure(configuration(1)));
    assert_eq!(bench.send_all(1, [0]).len(), 1);
}

pub(crate) fn nothing_is_configured_while_a_row_is_in_the_core(on: &dyn Boards) {
    let mut bench = ready(on, &Build::default(), 2);
    bench.send_all(2, [0]);
    assert_eq!(bench.refused(&Request::Configure(configuration(2))), (RefusalCode::Busy, 0));
}

pub(crate) fn nothing_is_configured_while_a_row_waits_in_an_input_bank(on: &dyn Boards) {
    let mut bench = ready(on, &Build::default(), 2);
    bench.send_all(2, [1]);
    assert_eq!(bench.refused(&Request::Configure(configuration(2))), (RefusalCode::Busy, 0));
}

pub(crate) fn nothing_is_configured_while_a_row_waits_for_its_acknowledgement(on: &dyn Boards) {
    let mut bench = ready(on, &Build::default(), 2);
    bench.send_all(2, [0, 1]);
    bench.window = 1;
    let wider = Request::Configure(Configuration { width: 128, ..configuration(2) });
    assert_eq!(bench.refused(&wider), (RefusalCode::Busy, 0));
    let again = bench.send_all(2, [1]);
    assert_eq!(again[0].row().place.width, 64);
    bench.window = 2;
    bench.done(&wider);
}
