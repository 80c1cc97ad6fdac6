//! The integers against double precision.

use crate::lens::assert_close;
use crate::scenes::{frame, golden_samples, natural};
use halfrow_model::{
    BitDepth, CorrectError, Equidistant, Frame, FrameError, Geometry, Interpolant, Phase, TableSet, correct,
    correct_real, round_to_frame,
};

/// The row of the axis, below the 100 rows of the frame: they are 441 to 540 rows above it, where the paper's lens stretches
/// most.
const TOP: Option<f64> = Some(540.0);

fn top() -> Geometry {
    Geometry::centred(1920, 100, BitDepth::Twelve).unwrap()
}

/// |integer − rounded real| of every sample.
fn differences(frame: &Frame, interpolant: Interpolant) -> Vec<u16> {
    let lens = Equidistant::default();
    let tables = TableSet::from_lens(top(), &lens, TOP).unwrap();
    let integer = correct(&tables, &interpolant.into(), frame).unwrap();
    let real = correct_real(&top(), &lens, TOP, interpolant, frame).unwrap();
    let real = round_to_frame(&real, frame).unwrap();
    integer.samples().iter().zip(real.samples()).map(|(a, b)| a.abs_diff(*b)).collect()
}

#[test]
fn natural_frames_differ_by_at_most_one() {
    for interpolant in [Interpolant::Linear, Interpolant::Keys, Interpolant::Hermite] {
        let differences = differences(&natural(&top()), interpolant);
        let equal = differences.iter().filter(|&&difference| difference == 0).count();
        assert!(differences.iter().all(|&difference| difference <= 1), "{interpolant}");
        assert!(equal * 100 >= differences.len() * 97, "{interpolant}: {equal} of {}", differences.len());
    }
}

#[test]
fn adversarial_frames_differ_by_at_most_two() {
    let extreme = golden_samples(&top()).iter().map(|sample| (sample & 1) * 4095).collect();
    let frame = frame(&top(), extreme);
    for interpolant in [Interpolant::Keys, Interpolant::Hermite] {
        let differences = differences(&frame, interpolant);
        assert!(differences.iter().all(|&difference| difference <= 2), "{interpolant}");
    }
}

#[test]
fn a_real_sample_is_neither_rounded_nor_clamped() {
    // R = 5 and y = 4 give 1/k = 3/5; with the centre at column 29, column 38 comes from 34.4.
    let geometry = Geometry::new(64, 1, BitDepth::Eight, 58).unwrap();
    let lens = Equidistant::from_radius(5.0).unwrap();
    let mut samples = vec![0; 64];
    (samples[33], samples[34], samples[36], samples[37]) = (10, 255, 255, 1);
    let frame = Frame::new(64, BitDepth::Eight, Phase::Grbg, samples).unwrap();
    let real = |interpolant| correct_real(&geometry, &lens, Some(-4.0), interpolant, &frame).unwrap();
    // Eq. 18 at x = 0.4, R1 R3 R5 = 10 0 1: 255 − 0.128 · 10 − 0.032 · 1.
    assert_close(real(Interpolant::Hermite)[38], 253.688);
    // Eq. 12 at x = 0.4, G0 = G6 = 0: 255 · (0.912 + 0.168).
    assert_close(real(Interpolant::Keys)[38], 275.4);
}

#[test]
fn rounding_is_half_up_and_clamped() {
    let like = Frame::new(2, BitDepth::Eight, Phase::Rggb, vec![0; 2]).unwrap();
    let rounded = round_to_frame(&[-3.0, 0.49, 2.5, 254.5, 255.4, 1e9], &like).unwrap();
    assert_eq!(rounded.samples(), [0, 0, 3, 255, 255, 255]);
    assert_eq!((rounded.phase(), rounded.height()), (Phase::Rggb, 3));
    assert_eq!(round_to_frame(&[1.0], &like), Err(FrameError::Ragged { samples: 1, width: 2 }));
}

#[test]
fn a_frame_of_another_depth_is_refused() {
    let frame = Frame::new(1920, BitDepth::Ten, Phase::Grbg, vec![0; 192_000]).unwrap();
    let refused = correct_real(&top(), &Equidistant::default(), TOP, Interpolant::Hermite, &frame);
    assert_eq!(refused, Err(CorrectError::Depth { frame: 10, tables: 12 }));
}
