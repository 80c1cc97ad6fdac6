//! The integer datapath against values by hand, and its invariants.

use halfrow_model::{
    BitDepth, Colour, CorrectError, Frame, Geometry, Interpolant, Kernel, NODES, Phase, Source, TableSet,
    correct, correct_row, source, source_by_entry,
};
use proptest::prelude::*;

use crate::{ONE, row_factor};

/// One row of 64 columns, 12 bits.
fn geometry(centre2: u32) -> Geometry {
    Geometry::new(64, 1, BitDepth::Twelve, centre2).unwrap()
}

/// `row` stretched to twice its width around column `centre2` / 2.
fn double(geometry: &Geometry, interpolant: Interpolant, row: &[u16]) -> [u16; 64] {
    let mut output = [0; 64];
    correct_row(geometry, row_factor(ONE / 2), &interpolant.into(), row, &mut output);
    output
}

/// A row of zeros except for these samples.
fn row_of(samples: &[(usize, u16)]) -> [u16; 64] {
    let mut row = [0; 64];
    samples.iter().for_each(|&(column, sample)| row[column] = sample);
    row
}

#[test]
fn a_source_is_found_as_by_hand() {
    // C = 63, Q = 2^23: the source of column 5 is 31.5 + (5 − 31.5)/2 = 18.25, its base the odd column 17.
    let expected = Source { base: 17, column: 18, node: 40, fraction: 0 };
    assert_eq!(source(&geometry(63), row_factor(ONE / 2), 5), expected);
    // Worked example of DATAPATH.md.
    let expected = Source { base: 7, column: 8, node: 43, fraction: 153 };
    assert_eq!(source(&geometry(63), row_factor(14_648_488), 5), expected);
}

#[test]
fn a_source_left_of_an_odd_columns_first_colour_has_its_base_outside() {
    let expected = Source { base: -1, column: 0, node: 48, fraction: 0 };
    assert_eq!(source(&geometry(0), row_factor(ONE / 2), 1), expected);
}

/// C = 254, Q = 2^23: the source of column 6 is 127 + (6 − 127)/2 = 66.5, in a row of 64 columns.
#[test]
fn about_a_centre_beyond_the_row_a_source_is_found_as_by_hand() {
    let expected = Source { base: 66, column: 66, node: 16, fraction: 0 };
    assert_eq!(source_by_entry(254, ONE / 2, 6), expected);
    let tables = TableSet::from_units(geometry(63), &[ONE / 2]).unwrap();
    assert_eq!(tables.values_about(254, 0).unwrap().source(6), expected);
}

#[test]
fn an_unstretched_row_passes_through() {
    let row: [u16; 64] = std::array::from_fn(|column| (column * 1777 % 4096) as u16);
    for interpolant in Interpolant::ALL {
        let mut output = [0; 64];
        correct_row(&geometry(29), row_factor(ONE), &interpolant.into(), &row, &mut output);
        assert_eq!(output, row, "{interpolant}");
    }
}

#[test]
fn a_ramp_doubled_has_half_the_slope() {
    let row: [u16; 64] = std::array::from_fn(|column| 16 * column as u16);
    // The source of column j is 15.75 + j/2. All sources are inside the row and on a node.
    let expected: [u16; 64] = std::array::from_fn(|column| 252 + 8 * column as u16);
    for interpolant in [Interpolant::Linear, Interpolant::Keys, Interpolant::Hermite] {
        assert_eq!(double(&geometry(63), interpolant, &row), expected, "{interpolant}");
    }
}

#[test]
fn left_of_the_row_its_first_samples_stand_in() {
    let row = row_of(&[(0, 100), (1, 1000), (2, 740)]);
    // Source 0.5: taps 100 1000 100 1000 740 at x = 1.5, and f_R5(1.5) = −9/64: 1000 − 640 · 9/64.
    assert_eq!(double(&geometry(0), Interpolant::Hermite, &row)[1], 910);
}

#[test]
fn right_of_the_row_its_last_samples_stand_in() {
    let row = row_of(&[(61, 740), (62, 1000), (63, 100)]);
    // Source 62.5: taps 740 1000 100 1000 100 at x = 0.5, and f_R1(0.5) = −9/64.
    assert_eq!(double(&geometry(126), Interpolant::Hermite, &row)[62], 910);
}

#[test]
fn what_leaves_the_range_of_the_depth_is_clamped() {
    for depth in BitDepth::ALL {
        let geometry = Geometry::new(64, 1, depth, 64).unwrap();
        // Column 34 comes from column 33, half-way between 32 and 34, where Keys has the weights −1, 9, 9, −1 sixteenths.
        let dark = row_of(&[(30, depth.max()), (36, depth.max())]);
        let bright = row_of(&[(32, depth.max()), (34, depth.max())]);
        assert_eq!(double(&geometry, Interpolant::Keys, &dark)[34], 0);
        assert_eq!(double(&geometry, Interpolant::Keys, &bright)[34], depth.max());
    }
}

#[test]
fn the_clamp_takes_back_only_what_leaves_the_range() {
    // 9/16 of 4080 and 9/16 of 3200 add up to 4095; with 3201 it is 4095.56, which is clamped.
    for (sample, expected) in [(3198, 4094), (3200, 4095), (3201, 4095)] {
        let row = row_of(&[(32, 4080), (34, sample)]);
        assert_eq!(double(&geometry(64), Interpolant::Keys, &row)[34], expected);
    }
}

#[test]
fn half_a_unit_is_rounded_up() {
    let row = row_of(&[(32, 7), (34, 8)]);
    assert_eq!(double(&geometry(64), Interpolant::Linear, &row)[34], 8);
}

#[test]
fn weights_are_interpolated_between_nodes_with_rounding() {
    // C = 0, Q = 2^24 − 3·2^17: column 2 comes from 2 − 0.046875. So x = 1.953125 from base 0, half-way from node 62 to 63.
    let mut nodes = vec![[0; 5]; NODES];
    (nodes[62][2], nodes[63][2]) = (4095, 4096);
    let kernel = Kernel::from_nodes(nodes).unwrap();
    let row = row_of(&[(2, 2)]);
    let mut output = [0; 64];
    correct_row(&geometry(0), row_factor(ONE - 3 * (1 << 17)), &kernel, &row, &mut output);
    // The weight is 4096, not 4095.5 or 4095: only with 4096 is 2 · weight / 2^14 the half that rounds up to 1.
    assert_eq!(output[2], 1);
}

#[test]
fn every_phase_keeps_its_colours() {
    let geometry = Geometry::centred(64, 2, BitDepth::Ten).unwrap();
    let tables = TableSet::from_units(geometry, &[9_999_999; 2]).unwrap();
    for phase in Phase::ALL {
        let sample = |place: usize| match phase.colour(place / 64, place % 64) {
            Colour::Red => 100,
            Colour::Green => 600,
            Colour::Blue => 1023,
        };
        let frame = Frame::new(64, BitDepth::Ten, phase, (0..128).map(sample).collect()).unwrap();
        for interpolant in Interpolant::ALL {
            assert_eq!(correct(&tables, &interpolant.into(), &frame).as_ref(), Ok(&frame));
        }
    }
}

#[test]
fn each_row_is_corrected_with_its_own_row_factor() {
    let geometry = Geometry::centred(64, 2, BitDepth::Twelve).unwrap();
    let tables = TableSet::from_units(geometry, &[ONE, ONE / 2]).unwrap();
    let row = row_of(&[(20, 3000), (41, 2000)]);
    let frame = Frame::new(64, BitDepth::Twelve, Phase::Grbg, [row, row].concat()).unwrap();
    let corrected = correct(&tables, &Interpolant::Keys.into(), &frame).unwrap();
    assert_eq!(corrected.row(0), row);
    assert_eq!(corrected.row(1), double(&geometry, Interpolant::Keys, &row));
    assert_ne!(corrected.row(1), row);
}

#[test]
fn a_frame_of_another_size_or_depth_is_refused() {
    let tables = TableSet::from_units(geometry(63), &[1]).unwrap();
    let kernel = Kernel::from(Interpolant::Linear);
    let frame = Frame::new(64, BitDepth::Twelve, Phase::Grbg, vec![0; 128]).unwrap();
    let size = CorrectError::Size { frame_width: 64, frame_height: 2, width: 64, height: 1 };
    assert_eq!(correct(&tables, &kernel, &frame), Err(size));
    let frame = Frame::new(64, BitDepth::Eight, Phase::Grbg, vec![0; 64]).unwrap();
    assert_eq!(correct(&tables, &kernel, &frame), Err(CorrectError::Depth { frame: 8, tables: 12 }));
}

fn any_kernel() -> impl Strategy<Value = Kernel> {
    prop::collection::vec(any::<[i16; 5]>(), NODES).prop_map(|nodes| Kernel::from_nodes(nodes).unwrap())
}

proptest! {
    #[test]
    fn sources_stay_inside_the_row_and_never_jump(centre2 in 0_u32..=126, factor in 1..=ONE) {
        let sources: Vec<_> = (0..64).map(|column| source(&geometry(centre2), row_factor(factor), column)).collect();
        for (column, source) in sources.iter().enumerate() {
            prop_assert!((0..64).contains(&source.column));
            prop_assert!((source.column - 1..=source.column).contains(&source.base));
            prop_assert_eq!(source.base.rem_euclid(2), column as i64 % 2);
            prop_assert!(source.node < 64 && (0..256).contains(&source.fraction));
        }
        prop_assert!(sources.windows(2).all(|pair| (0..=1).contains(&(pair[1].column - pair[0].column))));
    }

    #[test]
    fn a_source_is_within_its_resolution_of_the_real_one(centre2 in 0_u32..=126, factor in 1..=ONE, column in 0_usize..64) {
        let centre = f64::from(centre2) / 2.0;
        let real = centre + (column as f64 - centre) * f64::from(factor) / f64::from(ONE);
        let found = source(&geometry(centre2), row_factor(factor), column);
        let position = found.base as f64 + found.node as f64 / 32.0 + f64::from(found.fraction) / 8192.0;
        prop_assert!((position - real).abs() <= 1.0 / 16384.0);
    }

    #[test]
    fn a_flat_field_stays_flat_to_the_bit_under_any_kernel(
        kernel in any_kernel(), centre2 in 0_u32..=126, factor in 1..=ONE, own in 0_u16..=4095, other in 0_u16..=4095,
    ) {
        let row: [u16; 64] = std::array::from_fn(|column| if column % 2 == 0 { own } else { other });
        let mut output = [0; 64];
        correct_row(&geometry(centre2), row_factor(factor), &kernel, &row, &mut output);
        prop_assert_eq!(output, row);
    }

    #[test]
    fn no_weights_and_no_samples_overflow(
        kernel in any_kernel(), factor in 1..=ONE, row in prop::collection::vec(prop::sample::select(vec![0_u16, 4095]), 64),
    ) {
        let mut output = [0; 64];
        correct_row(&geometry(63), row_factor(factor), &kernel, &row, &mut output);
        prop_assert!(output.iter().all(|&sample| sample <= 4095));
    }
}
