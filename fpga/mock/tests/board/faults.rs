//! Faults of the core: each changes what it says, and nothing else.

use halfrow_mock::{BoardFault, FAULTS, Kernel, Node, Weight, board_fault, catalogue};
use halfrow_pipe::{FaultError, Parameters, Place, Range, TargetError, ValueError};

use crate::support::{binding, constant, core, fault, hermite, noise_row, row_out, run, unchanged};

/// What a core with a fault makes of a row of these samples, unstretched.
fn row_with(fault: BoardFault, kernel: Kernel, samples: Vec<u16>) -> Vec<u16> {
    let rows = [(samples, binding(64, 1 << 24, kernel))];
    row_out(&run(&mut core(12, 64, Some(fault)), &rows, 0), 64, 0)
}

#[test]
fn a_stuck_data_line_forces_a_bit() {
    let samples = noise_row(0, 64);
    let high: Vec<_> = samples.iter().map(|sample| sample | 32).collect();
    let low: Vec<_> = samples.iter().map(|sample| sample & !2048).collect();
    assert_eq!(row_with(fault("stuck-data", &[]), hermite(), samples.clone()), high);
    assert_eq!(row_with(fault("stuck-data", &[("bit", "11"), ("value", "0")]), hermite(), samples), low);
}

/// With address line 3 stuck, columns that differ only in it share a cell, and the later one stays there.
#[test]
fn a_stuck_address_line_makes_columns_share_a_cell() {
    let samples = noise_row(0, 64);
    let expected: Vec<_> = (0..64).map(|column: usize| samples[column | 8]).collect();
    assert_eq!(row_with(fault("stuck-address", &[]), hermite(), samples), expected);
}

/// The last column would come from column 64, for which column 62 stands in.
#[test]
fn a_tap_offset_shifts_the_row() {
    let samples = noise_row(0, 64);
    let expected: Vec<_> = (1..64).chain([62]).map(|column| samples[column]).collect();
    assert_eq!(row_with(fault("tap-offset", &[]), hermite(), samples), expected);
}

/// The mean of 0 and 1 rounds to 1 and truncates to 0.
#[test]
fn without_rounding_a_half_is_dropped() {
    let mean = constant(Node { g4: 1 << 13, ..Node::default() });
    let samples: Vec<_> = (0..64).map(|column| column / 2 % 2).collect();
    let healthy = [(samples.clone(), binding(64, 1 << 24, mean.clone()))];
    let rounded = row_out(&run(&mut core(12, 64, None), &healthy, 0), 64, 0);
    assert_eq!(rounded[..62], [1; 62]);
    assert_eq!(row_with(fault("no-rounding", &[]), mean, samples)[..62], [0; 62]);
}

#[test]
fn a_dead_tap_carries_zero() {
    let right = constant(Node { g4: 1 << 14, ..Node::default() });
    assert_eq!(row_with(fault("dead-tap", &[]), right, noise_row(0, 64)), [0; 64]);
}

#[test]
fn a_dead_tap_carries_another_taps_sample() {
    let samples = noise_row(0, 64);
    let shifted = row_with(fault("dead-tap", &[("tap", "2"), ("reads", "3")]), hermite(), samples.clone());
    assert_eq!(shifted[..63], samples[1..]);
}

/// A weight of -1 that is taken as 65535 is nearly 4, and the next sample of the colour is one more.
#[test]
fn a_weight_without_its_sign_is_large() {
    let least = constant(Node { g4: -1, ..Node::default() });
    let samples: Vec<_> = (0..64).map(|column| column / 2).collect();
    let larger: Vec<_> = samples.iter().map(|sample| sample + 4).collect();
    assert_eq!(row_with(fault("misread", &[]), least, samples)[..62], larger[..62]);
}

/// Nothing is stretched, so that every output is at node 0 of a kernel whose node 1 gives the next sample of the colour.
#[test]
fn a_board_that_begins_at_the_next_node_gives_what_that_one_says() {
    let mut kernel = constant(Node::default());
    kernel.nodes[1].g4 = 1 << 14;
    let samples = noise_row(0, 64);
    let next = row_with(fault("misread", &[("instead", "next-node")]), kernel, samples.clone());
    assert_eq!(next[..62], samples[2..]);
}

/// With a weight of 1 on R1, an output is G2 + R1 - R3. Left of column 0, column 1 must stand in for R1 and is R3 as well.
#[test]
fn the_nearest_sample_beyond_an_edge_has_the_other_colour() {
    let slope = constant(Node { r1: 1 << 14, ..Node::default() });
    let samples: Vec<_> = (0..64).map(|column| 1000 + 7 * (column % 2)).collect();
    let row = row_with(fault("misread", &[("instead", "nearest-edge")]), slope, samples.clone());
    assert_eq!((row[0], &row[1..63]), (993, &samples[1..63]));
}

#[test]
fn a_late_board_is_one_clock_late_and_otherwise_right() {
    let samples = noise_row(0, 64);
    let rows = [(samples.clone(), unchanged(64))];
    let outputs = run(&mut core(12, 64, Some(fault("late", &[]))), &rows, 0);
    assert_eq!((outputs[0].0, outputs[63].0), (45, 108));
    assert_eq!(row_out(&outputs, 64, 0), samples);
}

#[test]
fn faults_outside_the_core_leave_it_as_it_is() {
    let samples = noise_row(0, 64);
    for name in ["wrong-latency-claim", "wrong-datapath", "stale-table", "lost-row"] {
        assert_eq!(row_with(fault(name, &[]), hermite(), samples.clone()), samples, "{name}");
    }
    for instead in ["reversed-pairs", "reversed-entries", "long-runs"] {
        let misread = fault("misread", &[("instead", instead)]);
        assert_eq!(row_with(misread, hermite(), samples.clone()), samples, "{instead}");
    }
}

/// Values of a parameter, at least one of which is not its default.
fn samples_of(range: Range) -> Vec<String> {
    match range {
        Range::Whole(least, most) => vec![least.to_string(), most.to_string()],
        Range::Decimal(least, most) => vec![least.to_string(), most.to_string()],
        Range::Words(words) => words.iter().copied().map(str::to_owned).collect(),
    }
}

#[test]
fn without_parameters_the_defaults_of_the_table_hold() {
    for fault in FAULTS {
        let defaults = fault.info.parameters.iter();
        let mut defaults: Parameters =
            defaults.filter_map(|it| Some((it.key.to_owned(), it.default?.to_owned()))).collect();
        let default = fault.make(&mut Parameters::new()).unwrap();
        assert_eq!(fault.make(&mut defaults), Ok(default), "{}", fault.info.name);
    }
}

#[test]
fn every_parameter_of_the_table_is_of_use_in_all_of_its_range() {
    for fault in FAULTS {
        let default = fault.make(&mut Parameters::new()).unwrap();
        for parameter in fault.info.parameters {
            let made = |text: String| {
                let mut given = Parameters::from([(parameter.key.to_owned(), text)]);
                fault.make(&mut given).unwrap()
            };
            let changes =
                samples_of(parameter.range).into_iter().map(made).filter(|made| *made != default).count();
            assert_ne!(changes, 0, "{} of {} changes nothing", parameter.key, fault.info.name);
        }
    }
}

#[test]
fn no_name_is_in_the_catalogue_twice() {
    let names: std::collections::BTreeSet<_> = catalogue().map(|info| info.name).collect();
    assert_eq!(names.len(), catalogue().count());
}

#[test]
fn a_fault_takes_its_own_parameters_and_leaves_the_others() {
    let given = [("row", "7"), ("latency", "9"), ("hidden", "true")];
    let mut parameters = given.map(|(key, value)| (key.to_owned(), value.to_owned())).into();
    let row_factor = FAULTS.iter().find(|fault| fault.info.name == "row-factor").unwrap();
    let fault = row_factor.make(&mut parameters).unwrap();
    assert_eq!(fault, BoardFault::RowFactor { row: 7, bit: 18, hidden: true });
    assert_eq!(parameters, Parameters::from([("latency".to_owned(), "9".to_owned())]));
}

#[test]
fn a_kernel_word_is_named_by_node_and_weight() {
    let named = fault("kernel-word", &[("node", "64"), ("weight", "r5"), ("bit", "15")]);
    assert_eq!(named, BoardFault::KernelWord { node: 64, weight: Weight::R5, bit: 15, hidden: false });
}

#[test]
fn a_parameter_out_of_range_is_refused_with_its_range() {
    let source = ValueError::OutOfRange { key: "bit", value: 12, least: 0, most: 11 };
    let source = FaultError { fault: "stuck-data".to_owned(), source };
    let refused = board_fault(&[("fault", "stuck-data"), ("bit", "12")]);
    assert_eq!(refused, Err(TargetError::Fault { place: Place::Board, source }));
}
