//! Target strings, already split by the host, that describe a wire, and others that do not.

use std::num::NonZeroU64;
use std::time::Duration;

use halfrow_mock::{ConnectError, OptionError, Options, connect};
use halfrow_pipe::{BoardOptions, FaultError, PipeOptions, PipeSetup, Place, TargetError, ValueError};

use crate::support::{refusal, wire};

#[test]
fn options_of_board_wire_and_faults_come_in_any_order() {
    let wire = wire(&[
        ("rate", "1e-4"),
        ("fault", "flip"),
        ("row", "7"),
        ("seed", "3"),
        ("latency", "10"),
        ("speed", "1200000"),
        ("delay", "0.001"),
        ("buffer", "4096"),
        ("fault", "lost-row"),
    ]);
    assert_eq!(wire.bytes_per_second(), Some(1.2e6));
}

#[test]
fn every_option_of_the_wire_is_set_by_its_name() {
    let mut options = PipeOptions::default();
    assert_eq!(options, PipeOptions { speed: None, delay: Duration::ZERO, buffer: 65536 });
    for (key, value) in [("speed", "300000"), ("delay", "1.5e-3"), ("buffer", "0")] {
        assert_eq!(options.set(key, value), Ok(true));
    }
    let delay = Duration::from_micros(1500);
    assert_eq!(options, PipeOptions { speed: NonZeroU64::new(300_000), delay, buffer: 0 });
    assert_eq!(options.set("latency", "12"), Ok(false));
}

#[test]
fn values_that_no_wire_can_have_are_refused() {
    let wrong = [
        ("speed", "0"),
        ("speed", "1.5"),
        ("delay", "-1"),
        ("delay", "61"),
        ("delay", "NaN"),
        ("delay", "inf"),
        ("delay", ""),
        ("buffer", "-1"),
    ];
    for (key, value) in wrong {
        let (error, text) = refusal(&[(key, value)]);
        assert!(matches!(error, TargetError::Pipe(_)), "{key}={value}: {text}");
        assert!(text.contains(&format!("{key}={value}")), "{text}");
    }
    assert_eq!(PipeOptions::default().set("delay", "-0"), Ok(true));
}

#[test]
fn an_unknown_key_is_refused_with_those_that_exist() {
    let (error, text) = refusal(&[("latencey", "10")]);
    assert!(matches!(error, TargetError::UnknownKey { key, .. } if key == "latencey"));
    for known in ["latency", "pixel-clock", "speed", "delay", "buffer", "fault"] {
        assert!(text.contains(known), "{text}");
    }
}

#[test]
fn a_parameter_without_its_fault_is_refused() {
    assert!(refusal(&[("rate", "0.1")]).1.contains("need fault=NAME"));
    let (error, text) = refusal(&[("fault", "reorder"), ("byte", "3")]);
    assert!(matches!(error, TargetError::UnknownKey { key, .. } if key == "byte"));
    assert!(text.contains("fault=reorder") && text.contains("packet=N"), "{text}");
    let (error, text) = refusal(&[("fault", "late"), ("row", "3")]);
    assert!(matches!(error, TargetError::UnknownKey { key, .. } if key == "row"));
    assert!(text.contains("fault=late"), "{text}");
}

#[test]
fn every_key_of_the_board_that_an_error_names_exists() {
    // A key with a refused value exists just as much as one with an accepted value.
    assert!(Options::KEYS.iter().all(|key| Options::default().set(key, "none") != Ok(false)));
    assert_eq!(Options::default().set("moon", "none"), Ok(false));
}

#[test]
fn a_key_that_is_given_twice_is_refused() {
    for options in [[("speed", "5"), ("speed", "5")], [("latency", "12"), ("latency", "13")]] {
        let key = options[0].0.to_owned();
        assert_eq!(refusal(&options).0, TargetError::Duplicate { key });
    }
    let options = [("fault", "flip"), ("seed", "1"), ("seed", "2")];
    assert_eq!(refusal(&options).0, TargetError::Duplicate { key: "seed".to_owned() });
}

#[test]
fn an_unknown_fault_is_refused_with_those_that_exist() {
    let (error, text) = refusal(&[("fault", "flop")]);
    assert!(matches!(error, TargetError::UnknownFault { name, .. } if name == "flop"));
    assert!(text.contains("flip") && text.contains("wrong-datapath"), "{text}");
}

#[test]
fn two_faults_of_the_same_part_are_refused() {
    for (first, second) in [("flip", "drop"), ("late", "no-rounding"), ("flip", "flip")] {
        let (error, _) = refusal(&[("fault", first), ("fault", second)]);
        assert_eq!(error, TargetError::TwoFaults { first: first.to_owned(), second: second.to_owned() });
    }
}

#[test]
fn parameters_out_of_range_are_refused_by_name() {
    let wrong = [
        ("flip", "rate", "1.01"),
        ("flip", "rate", "-0.1"),
        ("drop", "byte", "-1"),
        ("drop", "packet", "one"),
        ("stall", "seconds", "-1"),
        ("reorder", "toward", "nobody"),
        ("truncate", "seed", "4294967296"),
    ];
    for (fault, key, value) in wrong {
        let (error, text) = refusal(&[("fault", fault), (key, value)]);
        assert!(matches!(error, TargetError::Fault { place: Place::Pipe, .. }), "{text}");
        assert!(text.contains(&format!("fault={fault}")), "{text}");
        assert!(text.contains(&format!("{key}={value}")), "{text}");
    }
    let (error, _) = refusal(&[("fault", "lost-row"), ("row", "-1")]);
    assert!(matches!(error, TargetError::Fault { place: Place::Board, .. }));
}

#[test]
fn a_fault_strikes_at_one_place() {
    let (error, _) = refusal(&[("fault", "flip"), ("rate", "0.1"), ("byte", "3")]);
    let two_places = ValueError::TwoPlaces { first: "byte", second: "rate" };
    let expected = FaultError { fault: "flip".to_owned(), source: two_places };
    assert!(matches!(error, TargetError::Fault { source, .. } if source == expected));
}

#[test]
fn a_build_that_cannot_exist_is_refused() {
    let expected = OptionError::RingTooShort { ring: 1024, max_width: 2048 };
    assert_eq!(connect(&[("ring", "1024")]).unwrap_err(), ConnectError::Build(expected));
    assert!(matches!(refusal(&[("ring", "32")]).0, TargetError::Board(ValueError::OutOfRange { .. })));
}

#[test]
fn a_fault_of_a_part_that_the_build_has_not_got_is_refused() {
    let refused = |options: &[(&str, &str)]| match connect(options).unwrap_err() {
        ConnectError::Build(error) => error,
        ConnectError::Target(error) => panic!("{error}"),
    };
    let line = |bit| [("fault", "stuck-address"), ("bit", bit)];
    assert_eq!(refused(&line("11")), OptionError::NoAddressLine { bit: 11, last: 10 });
    assert!(connect(&line("10")).is_ok());
    let short = [("ring", "64"), ("max-width", "64"), ("fault", "stuck-address"), ("bit", "6")];
    assert_eq!(refused(&short), OptionError::NoAddressLine { bit: 6, last: 5 });
    let word = |weight, taps| [("fault", "kernel-word"), ("weight", weight), ("taps", taps)];
    for weight in ["g0", "g6"] {
        assert_eq!(refused(&word(weight, "five")), OptionError::NoWeight { weight });
        assert!(connect(&word(weight, "seven")).is_ok(), "{weight}");
    }
    for weight in ["r1", "g4", "r5"] {
        assert!(connect(&word(weight, "five")).is_ok(), "{weight}");
    }
    let claim = |latency| [("fault", "wrong-latency-claim"), ("latency", latency)];
    assert_eq!(refused(&claim("32")), OptionError::NoLongerLatency { claimed: 33, most: 32 });
    assert!(connect(&claim("31")).is_ok());
    for name in ["stale-table", "stale-table-hidden", "late-swap"] {
        assert_eq!(refused(&[("table-banks", "1"), ("fault", name)]), OptionError::NoOtherBank, "{name}");
    }
    for name in ["slow-path", "warm-bit", "late-swap", "hidden-pause"] {
        assert_eq!(refused(&[("fault", name), ("bursts", "no")]), OptionError::NoBursts, "{name}");
        assert!(connect(&[("fault", name), ("bursts", "untrapped")]).is_ok(), "{name}");
    }
}

#[test]
fn a_wire_to_another_board_takes_what_the_wire_takes_alone() {
    let fine = [("speed", "5"), ("fault", "flip"), ("rate", "0.1")];
    PipeSetup::from_options(&fine).unwrap();
    let (name, known) =
        ("late".to_owned(), "flip, drop, duplicate, reorder, stall, lose, truncate, disconnect".to_owned());
    assert_eq!(PipeSetup::from_options(&[("fault", "late")]), Err(TargetError::UnknownFault { name, known }));
    let error = PipeSetup::from_options(&[("latency", "12")]).unwrap_err();
    assert!(matches!(&error, TargetError::UnknownKey { known, .. } if !known.contains("latency")), "{error}");
}
