//! Fitting kernels: the equations, held to systems whose solution is known from outside.

use halfrow::frames::preview::RgbImage;
use halfrow::kernels::NamedKernel;
use halfrow::progress::Silent;
use halfrow::training::{Equations, TrainingError, solve, train};
use halfrow_model::Taps;

/// By hand: 4 2 / 2 5 times (1, −2) is (0, −8); 1 2 / 2 1 is not positive definite.
#[test]
fn a_system_is_solved_as_by_hand() {
    let solution = solve(&[4.0, 0.0, 2.0, 5.0], &[0.0, -8.0]).unwrap();
    assert!((solution[0] - 1.0).abs() < 1e-12 && (solution[1] + 2.0).abs() < 1e-12, "{solution:?}");
    assert_eq!(solve(&[1.0, 0.0, 2.0, 1.0], &[1.0, 1.0]), None);
    assert_eq!(solve(&[f64::NAN], &[1.0]), None);
}

/// Outputs that a known kernel makes of made-up taps: the equations give that kernel back, but for the ridge.
#[test]
fn the_kernel_that_made_the_outputs_is_found_again() {
    for (named, taps) in [
        (NamedKernel::Interpolant(halfrow_model::Interpolant::Keys), Taps::Seven),
        (NamedKernel::HermiteBalanced, Taps::Five),
    ] {
        let kernel = named.kernel().unwrap();
        let mut equations = Equations::new();
        for place in 0..64 * 64_u32 {
            let (node, share) = ((place / 64) as usize, f64::from(place % 8) / 8.0);
            let taps: [f64; 7] = std::array::from_fn(|tap| {
                f64::from((7 * place + tap as u32).wrapping_mul(2_654_435_761) >> 20)
            });
            let [s0, s1, s2, s3, s4, s5, s6] = taps;
            let [g0, r1, g4, r5, g6] = std::array::from_fn(|tap| {
                let [low, high] = [node, node + 1].map(|node| f64::from(kernel.nodes()[node][tap]) / 16384.0);
                low + (high - low) * share
            });
            let wanted =
                s2 + g0 * (s0 - s2) + g4 * (s4 - s2) + g6 * (s6 - s2) + r1 * (s1 - s3) + r5 * (s5 - s3);
            equations.sample(node, share, taps, wanted);
        }
        let found = equations.kernel(taps).unwrap();
        let pairs = found.nodes().iter().flatten().zip(kernel.nodes().iter().flatten());
        let farthest = pairs.map(|(found, made)| (i32::from(*found) - i32::from(*made)).abs()).max();
        assert!(farthest <= Some(2), "{named}: {farthest:?}");
        assert!(equations.error(&kernel).abs() < 1e-3, "{}", equations.error(&kernel));
    }
}

#[test]
fn a_photograph_without_detail_determines_no_kernel() {
    let flat = RgbImage { width: 64, height: 64, data: vec![90; 3 * 64 * 64] };
    let refused = train(&[flat], Taps::Five, &Silent).unwrap_err();
    assert!(matches!(refused, TrainingError::Singular), "{refused}");
    let small = RgbImage { width: 32, height: 32, data: vec![90; 3 * 32 * 32] };
    assert!(matches!(train(&[small], Taps::Five, &Silent), Err(TrainingError::Geometry(_))));
}
