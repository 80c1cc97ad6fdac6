//! The constants of a build, given as text.

use halfrow_mock::{BurstBuild, Core, Depth, OptionError, Options, Settings, TapCount};
use halfrow_pipe::{BoardOptions, ValueError};

fn options(given: &[(&str, &str)]) -> Result<Options, OptionError> {
    let mut options = Options::default();
    for (key, value) in given {
        assert!(options.set(key, value)?, "{key} is no option");
    }
    options.check().map(|()| options)
}

#[test]
fn the_default_build_can_exist() {
    assert_eq!(Options::default().check(), Ok(()));
    assert_eq!(Options::default().ring_size(), 2048);
}

/// Every option, at a value that is not its default.
const GIVEN: &[(&str, &str)] = &[
    ("latency", "32"),
    ("ring", "4096"),
    ("least-blanking", "7"),
    ("row-banks-in", "2"),
    ("row-banks-out", "3"),
    ("table-banks", "1"),
    ("taps", "five"),
    ("max-width", "2592"),
    ("max-height", "1944"),
    ("depths", "8+12"),
    ("pixel-clock", "50000000"),
    ("serial", "144115188075855871"),
    ("bursts", "untrapped"),
    ("records", "65535"),
    ("least-frame-blanking", "4095"),
    ("entered", "no"),
    ("datapath2", "no"),
    ("entries", "4096"),
];

#[test]
fn every_option_is_set_by_its_name() {
    let expected = Options {
        latency: 32,
        ring: Some(4096),
        least_blanking: 7,
        row_banks_in: 2,
        row_banks_out: 3,
        table_banks: 1,
        taps: TapCount::Five,
        max_width: 2592,
        max_height: 1944,
        depths: vec![Depth::Eight, Depth::Twelve],
        pixel_clock: 50_000_000,
        // The largest number of 57 bits.
        serial: 0x01ff_ffff_ffff_ffff,
        bursts: BurstBuild::Untrapped,
        records: 65535,
        least_frame_blanking: 4095,
        entered: false,
        datapath2: false,
        entries: 4096,
    };
    assert_eq!(options(GIVEN), Ok(expected));
}

#[test]
fn a_key_that_is_no_option_is_left_to_others() {
    let mut options = Options::default();
    assert_eq!(options.set("fault", "late"), Ok(false));
    assert_eq!(options, Options::default());
}

#[test]
fn the_ring_grows_with_the_width() {
    assert_eq!(options(&[("max-width", "2592")]).unwrap().ring_size(), 4096);
    assert_eq!(options(&[("max-width", "64")]).unwrap().ring_size(), 64);
}

#[test]
fn the_order_of_ring_and_width_does_not_matter() {
    assert_eq!(
        options(&[("ring", "1024"), ("max-width", "640")]),
        options(&[("max-width", "640"), ("ring", "1024")]),
    );
}

#[test]
fn options_that_do_not_fit_each_other_are_refused() {
    let refusal = |given: &[_]| options(given).unwrap_err();
    assert_eq!(refusal(&[("ring", "3000")]), OptionError::RingNotPowerOfTwo { ring: 3000 });
    assert_eq!(refusal(&[("ring", "1024")]), OptionError::RingTooShort { ring: 1024, max_width: 2048 });
    assert_eq!(refusal(&[("max-width", "65")]), OptionError::OddWidth { max_width: 65 });
}

#[test]
fn values_out_of_range_are_refused_with_the_range() {
    let refusal = options(&[("latency", "33")]).unwrap_err();
    let expected = ValueError::OutOfRange { key: "latency", value: 33, least: 4, most: 32 };
    assert_eq!(refusal, OptionError::Value(expected));
    assert_eq!(refusal.to_string(), "latency=33 is out of range; give a number from 4 to 32");
}

#[test]
fn values_that_are_no_numbers_or_no_known_words_are_refused() {
    let refusal = |key, value| options(&[(key, value)]).unwrap_err().to_string();
    assert_eq!(refusal("ring", "big"), "ring=big is not a whole number; give one from 64 to 16384");
    assert_eq!(refusal("bursts", "yes"), "bursts=yes is not known; give one of no, untrapped, trapped");
    assert_eq!(refusal("entries", "2047"), "entries=2047 is out of range; give a number from 2048 to 65535");
    assert_eq!(refusal("datapath2", "1"), "datapath2=1 is not known; give one of no, yes");
    assert_eq!(refusal("records", "1"), "records=1 is out of range; give a number from 2 to 65535");
    assert_eq!(refusal("taps", "six"), "taps=six is not known; give one of five, seven");
    assert_eq!(refusal("depths", "8+9"), "depths=9 is not known; give one of 8, 10, 12");
}

#[test]
fn no_core_is_made_for_a_build_that_cannot_exist() {
    let impossible = Options { latency: 3, ..Options::default() };
    assert!(matches!(Core::new(&impossible, None), Err(OptionError::Value(ValueError::OutOfRange { .. }))));
    let impossible = Options { depths: Vec::new(), ..Options::default() };
    assert!(matches!(Core::new(&impossible, None), Err(OptionError::NoDepth)));
}

#[test]
fn a_width_that_no_build_has_is_told_and_not_computed_with() {
    let wide = Options { max_width: u16::MAX, ..Options::default() };
    assert!(wide.check().is_err());
    assert_eq!(wide.ring_size(), u16::MAX);
    let own = Settings { width: u16::MAX - 1, centre2: u16::MAX, ..Settings::at_power_up(&wide) };
    assert_eq!(own.check(&wide), Ok(()));
}
