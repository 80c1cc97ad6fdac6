//! Every path of the model that this processor has, against the oracle, bit for bit.

use std::io::Write as _;
use std::sync::Once;

use halfrow_model::{
    BitDepth, CorrectError, Corrector, Frame, FrameError, Geometry, Interpolant, Kernel, MAX_WIDTH,
    MIN_WIDTH, ModelPath, NODES, Phase, TableSet, correct, correct_row, source,
};
use proptest::prelude::*;

use crate::{ONE, row_factor};

/// The paths to compare with the oracle. Writes to stderr past the test harness, which hides what passing tests print, which
/// paths this processor cannot run.
#[allow(clippy::disallowed_methods)]
pub(crate) fn paths() -> impl Iterator<Item = ModelPath> {
    static SAID: Once = Once::new();
    SAID.call_once(|| {
        for path in ModelPath::ALL.into_iter().filter(|path| !path.is_available()) {
            let _ =
                writeln!(std::io::stderr(), "NOT TESTED: this processor cannot take the model's path {path}");
        }
    });
    ModelPath::available().filter(|&path| path != ModelPath::Reference)
}

/// Maps weights to weights of every size, to the limits only, or to sizes that keep g2 and r3 within 16 bits.
fn any_weight() -> impl Strategy<Value = fn(i16) -> i16> {
    prop::sample::select(vec![
        (|weight| weight) as fn(i16) -> i16,
        |weight| if weight < 0 { i16::MIN } else { i16::MAX },
        |weight| weight / 4,
    ])
}

pub(crate) fn any_kernel() -> impl Strategy<Value = Kernel> {
    let nodes = prop::collection::vec(any::<[i16; 5]>(), NODES);
    let random = (nodes, any_weight(), any::<bool>()).prop_map(|(nodes, weight, five)| {
        let node = |node: [i16; 5]| {
            let [g0, r1, g4, r5, g6] = node.map(weight);
            if five { [0, r1, g4, r5, 0] } else { [g0, r1, g4, r5, g6] }
        };
        Kernel::from_nodes(nodes.into_iter().map(node).collect()).unwrap()
    });
    prop_oneof![3 => random, 1 => prop::sample::select(Interpolant::ALL.to_vec()).prop_map(Kernel::from)]
}

/// Factors, with the least and the greatest drawn often.
fn any_factor() -> impl Strategy<Value = u32> {
    prop_oneof![6 => 1..=ONE, 1 => Just(1), 1 => Just(ONE), 1 => ONE - 64..=ONE]
}

/// Widths up to `widest`, whole blocks or not, and centres, with the outermost drawn often.
fn any_geometry(heights: std::ops::RangeInclusive<usize>, widest: usize) -> impl Strategy<Value = Geometry> {
    let depth = prop::sample::select(BitDepth::ALL.to_vec());
    (MIN_WIDTH / 2..=widest / 2, heights, depth, 0..=4_u32, any::<u32>()).prop_map(
        |(half, height, depth, place, centre)| {
            let last = 4 * half as u32 - 2;
            let centre2 = match place {
                0 => 0,
                1 => last,
                2 => last / 2,
                _ => centre % (last + 1),
            };
            Geometry::new(2 * half, height, depth, centre2).unwrap()
        },
    )
}

/// Samples from a seed: of every size, or only the least and the greatest.
pub(crate) fn samples(geometry: &Geometry, seed: u32) -> Vec<u16> {
    let max = geometry.depth().max();
    let count = (geometry.width() * geometry.height()) as u32;
    (0..count)
        .map(|index| ((index ^ seed).wrapping_mul(2_654_435_761).rotate_left(seed % 16) >> 16) as u16)
        .map(|sample| if seed.is_multiple_of(3) { sample % 2 * max } else { sample & max })
        .collect()
}

proptest! {
    #[test]
    fn every_path_corrects_a_row_as_the_oracle_does(
        geometry in any_geometry(1..=1, MAX_WIDTH), factor in any_factor(), kernel in any_kernel(), seed in any::<u32>(),
    ) {
        let row = samples(&geometry, seed);
        let mut expected = vec![0; geometry.width()];
        correct_row(&geometry, row_factor(factor), &kernel, &row, &mut expected);
        for path in paths() {
            let mut found = vec![0xffff; geometry.width()];
            Corrector::new(path, &kernel).unwrap().correct_row(&geometry, row_factor(factor), &row, &mut found);
            prop_assert_eq!(&found, &expected, "{}", path);
        }
    }

    #[test]
    fn every_path_corrects_a_frame_as_the_oracle_does(
        geometry in any_geometry(1..=5, 200), factors in prop::collection::vec(any_factor(), 5), mirrored in 0..=2_usize,
        kernel in any_kernel(), seed in any::<u32>(),
    ) {
        let height = geometry.height();
        // Each row's own factor, the mirrored row's, or one next to the mirrored row's.
        let factor = |row: usize| {
            let other = row.min(height - 1 - row);
            match mirrored {
                0 => factors[row],
                1 => factors[other],
                _ => (factors[other] ^ u32::from(row > other)).clamp(1, ONE),
            }
        };
        let tables = TableSet::from_units(geometry, &(0..height).map(factor).collect::<Vec<_>>()).unwrap();
        let frame = Frame::new(geometry.width(), geometry.depth(), Phase::Grbg, samples(&geometry, seed)).unwrap();
        let expected = correct(&tables, &kernel, &frame).unwrap();
        for path in ModelPath::available() {
            let mut found = vec![0xffff; frame.samples().len()];
            let mut corrector = Corrector::new(path, &kernel).unwrap();
            corrector.correct_into(&tables, &frame, &mut found).unwrap();
            prop_assert_eq!(&found[..], expected.samples(), "{}", path);
            let mut of_samples = vec![0xffff; found.len()];
            corrector.correct_samples(&tables, frame.samples(), &mut of_samples).unwrap();
            prop_assert_eq!(of_samples, found, "{}", path);
        }
    }

    #[test]
    fn every_path_finds_the_sources_that_the_oracle_finds(geometry in any_geometry(1..=1, MAX_WIDTH), factor in any_factor()) {
        let expected = sources(&geometry, factor);
        for path in ModelPath::available() {
            let corrector = Corrector::new(path, &Interpolant::Linear.into()).unwrap();
            let (mut bases, mut distances) = (vec![i16::MIN; geometry.width()], vec![0xffff; geometry.width()]);
            corrector.locate(&geometry, row_factor(factor), &mut bases, &mut distances);
            prop_assert_eq!(&bases, &expected.0, "{}", path);
            prop_assert_eq!(&distances, &expected.1, "{}", path);
        }
    }
}

/// The oracle's a and x of every column; x also determines n.
pub(crate) fn sources(geometry: &Geometry, factor: u32) -> (Vec<i16>, Vec<u16>) {
    let of = |column| {
        let source = source(geometry, row_factor(factor), column);
        let x = (source.node << 8) as u16 + source.fraction as u16;
        assert_eq!(source.column - source.base, i64::from(x >> 13));
        (source.base as i16, x)
    };
    (0..geometry.width()).map(of).unzip()
}

/// Neighbouring nodes that jump from one limit to the other, so that their differences take 17 bits, at every distance between.
#[test]
fn every_path_follows_the_steepest_kernels() {
    let node = |node: usize| {
        [0, 1, 2, 3, 4].map(|tap| if (node + tap).is_multiple_of(2) { i16::MIN } else { i16::MAX })
    };
    let all = (0..NODES).map(node);
    // Differences of 17 bits, while r3 fits 16.
    let fitting = (0..NODES).map(|node| [0, if node % 2 == 0 { -16_400 } else { 16_400 }, 0, 0, 0]);
    let five = all.clone().map(|[_, r1, g4, r5, _]| [0, r1, g4, r5, 0]);
    // The opposite: no differences, but r3 is 3.
    let level = (0..NODES).map(|_| [0, -24_576, 0, -24_576, 0]);
    for kernel in [all.collect(), five.collect(), fitting.collect(), level.collect()]
        .map(|nodes| Kernel::from_nodes(nodes).unwrap())
    {
        // Q = 2^24 − 2^12 moves x by one every two columns.
        for factor in [ONE - (1 << 12), ONE / 3] {
            let geometry = Geometry::new(MAX_WIDTH, 1, BitDepth::Twelve, 0).unwrap();
            for seed in [0, 1] {
                let row = samples(&geometry, seed);
                let mut expected = vec![0; MAX_WIDTH];
                correct_row(&geometry, row_factor(factor), &kernel, &row, &mut expected);
                for path in paths() {
                    let mut found = vec![0; MAX_WIDTH];
                    Corrector::new(path, &kernel).unwrap().correct_row(
                        &geometry,
                        row_factor(factor),
                        &row,
                        &mut found,
                    );
                    assert_eq!(found, expected, "{path}, Q = {factor}");
                }
            }
        }
    }
}

/// A corrector carries nothing over from one row to the next, whether that is narrower or wider.
#[test]
fn a_corrector_goes_on_with_other_widths() {
    let kernel = Kernel::from(Interpolant::Keys);
    for path in paths() {
        let mut corrector = Corrector::new(path, &kernel).unwrap();
        for width in [MAX_WIDTH, MIN_WIDTH, 200, MIN_WIDTH, MAX_WIDTH] {
            let geometry = Geometry::centred(width, 1, BitDepth::Twelve).unwrap();
            let row = samples(&geometry, width as u32);
            let (mut expected, mut found) = (vec![0; width], vec![0; width]);
            correct_row(&geometry, row_factor(ONE - 5), &kernel, &row, &mut expected);
            corrector.correct_row(&geometry, row_factor(ONE - 5), &row, &mut found);
            assert_eq!(found, expected, "{path}, {width} columns");
        }
    }
}

#[test]
fn a_frame_that_the_tables_are_not_for_is_refused_by_every_path() {
    let tables = TableSet::from_units(Geometry::centred(64, 2, BitDepth::Twelve).unwrap(), &[1; 2]).unwrap();
    let frame = Frame::new(64, BitDepth::Ten, Phase::Grbg, vec![0; 128]).unwrap();
    for path in ModelPath::available() {
        let mut corrector = Corrector::new(path, &Interpolant::Linear.into()).unwrap();
        let depth = CorrectError::Depth { frame: 10, tables: 12 };
        assert_eq!(corrector.correct(&tables, &frame), Err(depth));
    }
}

/// Wherever the first of two such samples is: rows are taken alternately from the top and from the bottom.
#[test]
fn a_sample_that_the_depth_cannot_hold_is_named_by_every_path() {
    let geometry = Geometry::centred(64, 5, BitDepth::Ten).unwrap();
    let tables = TableSet::from_units(geometry, &[ONE; 5]).unwrap();
    for path in ModelPath::available() {
        let mut corrector = Corrector::new(path, &Interpolant::Linear.into()).unwrap();
        for (row, column) in [(0, 0), (1, 63), (2, 7), (3, 32), (4, 62)] {
            let (mut samples, mut output) = (vec![1023; 5 * 64], vec![0; 5 * 64]);
            samples[row * 64 + column] = 1024;
            samples[5 * 64 - 1] = u16::MAX;
            let refused = FrameError::TooBright { row, column, value: 1024, max: 1023, bits: 10 };
            assert_eq!(corrector.correct_samples(&tables, &samples, &mut output), Err(refused.clone()));
            assert_eq!(Frame::new(64, BitDepth::Ten, Phase::Grbg, samples), Err(refused));
        }
    }
}

#[test]
fn a_path_is_known_by_its_name() {
    for path in ModelPath::ALL {
        assert_eq!(path.name().to_uppercase().parse(), Ok(path));
    }
    let error = "sse2".parse::<ModelPath>().unwrap_err().to_string();
    assert!(error.ends_with("use reference, scalar, avx2 or avx512"), "{error}");
}

#[test]
fn what_the_processor_lacks_is_refused_and_what_it_has_is_taken() {
    assert!(ModelPath::best().is_available());
    for path in ModelPath::ALL {
        let corrector = Corrector::new(path, &Interpolant::Linear.into());
        assert_eq!(corrector.map(|corrector| corrector.path()).ok(), path.is_available().then_some(path));
    }
}
