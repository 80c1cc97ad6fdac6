//! A delay of half a row, exact to the clock.

use halfrow_mock::{Depth, Entering, GridShape, Options, RowBinding, RowValues};
use proptest::prelude::*;

use crate::support::{core, noise_row, run, unchanged};

/// Feeds `count` unstretched rows and checks that every sample leaves `width / 2 + latency` clocks after it entered.
fn every_sample_leaves_half_a_row_later(latency: u8, width: u16, ring: u16, blanking: usize, count: u32) {
    let rows: Vec<_> = (0..count).map(|row| (noise_row(row, width), unchanged(width))).collect();
    let outputs = run(&mut core(latency, ring, None), &rows, blanking);
    let mut outputs = outputs.into_iter();
    let delay = usize::from(width / 2) + usize::from(latency);
    for (index, (samples, _)) in rows.iter().enumerate() {
        let begin = index * (usize::from(width) + blanking);
        for (column, &sample) in samples.iter().enumerate() {
            let (clock, leaving) = outputs.next().unwrap();
            assert_eq!(clock, begin + column + delay, "row {index}, column {column}");
            assert_eq!((usize::from(leaving.column), leaving.sample), (column, sample));
        }
    }
    assert_eq!(outputs.next(), None);
}

#[test]
fn every_column_leaves_at_d_whatever_the_latency() {
    for latency in 4..=32 {
        every_sample_leaves_half_a_row_later(latency, 64, 64, 0, 3);
    }
}

#[test]
fn every_column_leaves_at_d_whatever_width_and_ring() {
    for (width, ring) in
        [(64, 64), (64, 4096), (66, 128), (640, 1024), (1920, 2048), (2048, 2048), (2592, 4096)]
    {
        every_sample_leaves_half_a_row_later(12, width, ring, 0, 3);
    }
}

#[test]
fn every_column_leaves_at_d_whatever_the_blanking() {
    for blanking in [0, 1, 7, 31, 32, 33, 44, 45, 64, 900] {
        every_sample_leaves_half_a_row_later(12, 64, 64, blanking, 3);
    }
}

proptest! {
    #[test]
    fn every_column_leaves_at_d(latency in 4_u8..=32, half in 32_u16..=200, ring in 9_u32..=12, blanking in 0_usize..300) {
        every_sample_leaves_half_a_row_later(latency, 2 * half, 1 << ring, blanking, 4);
    }

    #[test]
    fn no_input_makes_the_core_panic(
        width in 0_u16..=300,
        centre2: u16,
        factor: u32,
        inputs in prop::collection::vec((any::<u16>(), 0_u8..40), 0..600),
    ) {
        let mut binding = unchanged(64);
        (binding.width, binding.centre2, binding.depth) = (width, centre2, Depth::Eight);
        binding.values = factor.into();
        let mut core = core(4, 64, None);
        for (sample, kind) in inputs {
            let entering = Entering { sample, begins: (kind == 1).then_some(&binding) };
            let out = core.clock((kind > 0).then_some(entering));
            prop_assert!(out.is_none_or(|leaving| leaving.sample <= 255 && leaving.column < width));
        }
    }
}

proptest! {
    #[test]
    fn no_grid_makes_the_core_panic_or_late(
        v in 1_u8..=6, k in 5_u8..=6, half in 32_u16..=100, height in 1_u16..=70, centre2: u16, entry: u32, step: u32,
    ) {
        let (width, shape) = (2 * half, GridShape::new(v, k).unwrap());
        let grid = |index: usize| entry.wrapping_add(step.wrapping_mul(index as u32));
        let rows: Vec<_> = (0..3)
            .map(|row| {
                let values = RowValues::of_grid(shape, (width, height), row % height, grid);
                (noise_row(row.into(), width), RowBinding { values, centre2, ..unchanged(width) })
            })
            .collect();
        let outputs = run(&mut core(12, 256, None), &rows, 0);
        let delay = usize::from(half) + 12;
        let clocks: Vec<_> = outputs.iter().map(|(clock, _)| *clock).collect();
        prop_assert_eq!(clocks, (delay..delay + 3 * usize::from(width)).collect::<Vec<_>>());
    }
}

#[test]
fn a_core_without_samples_stays_silent() {
    let mut core = halfrow_mock::Core::new(&Options::default(), None).unwrap();
    assert!((0..5000).all(|_| core.clock(None).is_none()));
}
