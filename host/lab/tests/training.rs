//! Fitting kernels: the equations, checked with systems whose solution is known from elsewhere.

use halfrow::frames::preview::RgbImage;
use halfrow::kernels::NamedKernel;
use halfrow::progress::Silent;
use halfrow_lab::training::{Equations, TrainingError, measure, train};
use halfrow_model::{Interpolant, Kernel, NODES, Taps};

/// Outputs that a known kernel makes of invented taps: the equations give that kernel back, except for the ridge's effect.
#[test]
fn the_kernel_that_made_the_outputs_is_found_again() {
    for (named, taps) in [
        (NamedKernel::Interpolant(Interpolant::Keys), Taps::Seven),
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
    let none = RgbImage { width: 0, height: 0, data: Vec::new() };
    assert!(matches!(train(&[none], Taps::Five, &Silent), Err(TrainingError::Geometry(_))));
}

/// Samples between nodes 20 and 23 that no kernel reproduces exactly.
fn noisy_equations() -> Equations {
    let drawn = |place: u32, bits: u32| f64::from(place.wrapping_mul(2_654_435_761) >> (32 - bits));
    let mut equations = Equations::new();
    for place in 0..96_u32 {
        let taps: [f64; 7] = std::array::from_fn(|tap| drawn(7 * place + tap as u32, 12));
        let [_, s1, s2, _, s4, s5, _] = taps;
        let noise = drawn(1000 + place, 8) - 128.0;
        let wanted = 0.55 * s2 + 0.45 * s4 + 0.125 * (s1 - s5) + noise;
        equations.sample(20 + (place % 3) as usize, f64::from(place / 3 % 8) / 8.0, taps, wanted);
    }
    equations
}

/// Nodes 20 to 23, and the sum of squares that remains, by NumPy 2.4 (`numpy.linalg.lstsq` over the samples and one row for each
/// weight, which holds it to Hermite's by the ridge).
#[test]
fn the_fit_is_numpy_s() {
    let equations = noisy_equations();
    let found = [
        (
            Taps::Five,
            [
                [0, 2026, 7643, -2030, 0],
                [0, 2176, 6885, -2039, 0],
                [0, 2168, 7722, -2047, 0],
                [0, 1886, 6613, -2131, 0],
            ],
            453_895.121_507,
        ),
        (
            Taps::Seven,
            [
                [850, 2716, 7388, -2221, -478],
                [-191, 1886, 7313, -2026, -328],
                [-9, 2216, 7775, -2089, -93],
                [226, 1846, 6616, -1940, 161],
            ],
            384_755.078_525,
        ),
    ];
    let hermite = Kernel::from(Interpolant::Hermite);
    for (taps, nodes, left) in found {
        let kernel = equations.kernel(taps).unwrap();
        assert_eq!(kernel.nodes()[20..24], nodes);
        // No sample is near the other nodes, which stay Hermite's except for the rounding of halves.
        let others =
            |kernel: &Kernel| [&kernel.nodes()[..20], &kernel.nodes()[24..]].concat().into_flattened();
        let pairs = others(&kernel).into_iter().zip(others(&hermite));
        assert!(pairs.map(|(found, held)| (found - held).abs()).max() <= Some(1));
        assert!((equations.error(&kernel) - left).abs() < 1e-3, "{}", equations.error(&kernel));
    }
}

/// A picture of this size; `value` gives the brightness at each place.
fn grey(width: usize, height: usize, value: impl Fn(usize, usize) -> u32) -> RgbImage {
    let value = &value;
    let places = (0..height).flat_map(|row| (0..width).flat_map(move |column| [value(row, column); 3]));
    RgbImage { width, height, data: places.map(|value| (value % 256) as u8).collect() }
}

/// A sawtooth, which rises slowly to the right and falls at once.
fn saw_teeth(row: usize, column: usize) -> u32 {
    (20 + 19 * ((column + row / 3) % 11) + 3 * (row % 5)) as u32
}

/// Light has no preferred direction. Mirrored, s0 changes places with s6, s1 with s5, and s2, whose weight is 1 - g0 - g4 - g6,
/// with s4, at the node that is as far from the end as this one is from the beginning.
#[test]
fn a_fitted_kernel_is_the_same_from_both_sides_although_the_picture_is_not() {
    let kernel = train(&[grey(96, 64, saw_teeth)], Taps::Seven, &Silent).unwrap().kernel;
    let nodes: Vec<[i32; 5]> = kernel.nodes().iter().map(|node| node.map(i32::from)).collect();
    let apart = (0..NODES).map(|node| {
        let ([g0, r1, g4, r5, g6], seen) = (nodes[node], nodes[NODES - 1 - node]);
        let mirrored = [g6, r5, 16384 - g0 - g4 - g6, r1, g0];
        mirrored.iter().zip(seen).map(|(mirrored, seen)| (mirrored - seen).abs()).max().unwrap()
    });
    let farthest = apart.max().unwrap();
    assert!(farthest < 300, "{farthest}");
}

/// Noise, so that a picture of any size says the same about a kernel.
fn noise(width: usize, height: usize) -> RgbImage {
    grey(width, height, |row, column| {
        90 + (((row * 4096 + column) as u32).wrapping_mul(2_654_435_761) >> 8) % 20
    })
}

/// A picture with four times the pixels moves the kernel far less than four pictures with the same content.
#[test]
fn a_photograph_weighs_the_same_whatever_its_size() {
    let nodes = |photographs: &[RgbImage]| -> Vec<i32> {
        let kernel = train(photographs, Taps::Five, &Silent).unwrap().kernel;
        kernel.nodes().iter().flatten().map(|&weight| weight.into()).collect()
    };
    let (small, large, other) = (noise(96, 64), noise(192, 128), grey(96, 64, saw_teeth));
    let alike = nodes(&[small.clone(), other.clone()]);
    let apart = |nodes: Vec<i32>| -> i32 { nodes.iter().zip(&alike).map(|(a, b)| (a - b).abs()).sum() };
    let by_size = apart(nodes(&[large, other.clone()]));
    let by_number = apart(nodes(&[small.clone(), small.clone(), small.clone(), small, other]));
    assert!(4 * by_size < by_number, "{by_size}, {by_number}");
}

/// A step of one level in the middle. No lens moves it, Hermite's nodes keep it, and two outer taps with nearly the full weight
/// smear it.
#[test]
fn what_comes_back_exactly_by_hermite_alone_has_no_figure() {
    let step = grey(96, 64, |_, column| 90 + u32::from(column >= 48));
    let hermite = halfrow::kernels::stored;
    let weights: Vec<[f64; 5]> = (0..NODES)
        .map(|node| {
            let [_, r1, g4, r5, _] = hermite(Interpolant::Hermite.weights(node as f64 / 32.0));
            [0.9, r1, g4, r5, -0.9]
        })
        .collect();
    let gains = measure(&[step], &Kernel::from_weights(&weights).unwrap(), &Silent).unwrap();
    assert_eq!((gains[0].exact, gains[0].gain, gains[0].hermite), (1, None, None));
}
