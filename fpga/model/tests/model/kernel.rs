//! Interpolants (Eqs. 10, 11, 12, 14, 18) and their kernels.

use halfrow_model::{Interpolant, Kernel, KernelError, NODES, Taps};
use proptest::prelude::*;

/// What `interpolant` makes of the function `p` of the distance from G2, for both colours alike.
fn interpolate(interpolant: Interpolant, x: f64, p: impl Fn(f64) -> f64) -> f64 {
    interpolant.weights(x).iter().zip(-2_i8..).map(|(weight, m)| weight * p(f64::from(m))).sum()
}

/// A kernel of zeros except for `weight` at node 9, tap r5.
fn one_weight(weight: f64) -> Result<Kernel, KernelError> {
    let mut weights = vec![[0.0; 5]; NODES];
    weights[9][3] = weight;
    Kernel::from_weights(&weights)
}

#[test]
fn the_nearest_sample_changes_at_the_middle() {
    let [g2, g4] = [[0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0]];
    assert_eq!([0.0, 0.999].map(|x| Interpolant::Nearest.weights(x)), [g2; 2]);
    assert_eq!([1.0, 2.0].map(|x| Interpolant::Nearest.weights(x)), [g4; 2]);
    let kernel = Kernel::from(Interpolant::Nearest);
    assert_eq!(kernel.nodes()[31], [0; 5]);
    assert_eq!(kernel.nodes()[32], [0, 0, 16384, 0, 0]);
}

#[test]
fn hermites_slopes_are_those_of_the_other_colour() {
    let slope = |x: f64| {
        let (low, high) = (Interpolant::Hermite.weights(x - 1e-4), Interpolant::Hermite.weights(x + 1e-4));
        std::array::from_fn::<_, 7, _>(|tap| (high[tap] - low[tap]) / 2e-4)
    };
    // Eq. 14: G'(0) = (R3 − R1)/2, G'(2) = (R5 − R3)/2
    let expected = [(0.0, [0.0, -0.5, 0.0, 0.5, 0.0, 0.0, 0.0]), (2.0, [0.0, 0.0, 0.0, -0.5, 0.0, 0.5, 0.0])];
    for (x, expected) in expected {
        for (slope, expected) in slope(x).into_iter().zip(expected) {
            assert!((slope - expected).abs() < 1e-6, "{slope} is not {expected} at {x}");
        }
    }
}

#[test]
fn every_kernel_passes_the_samples_of_its_own_columns() {
    for interpolant in Interpolant::ALL {
        let kernel = Kernel::from(interpolant);
        assert_eq!(kernel.nodes()[0], [0; 5], "{interpolant}");
        assert_eq!(kernel.nodes()[64], [0, 0, 16384, 0, 0], "{interpolant}");
    }
}

#[test]
fn nodes_are_the_equations_in_units_of_2_to_the_minus_14() {
    // x = 1/2: Eq. 18 gives f_R1 = −9/64, f_G4 = 5/32, f_R5 = −3/64.
    assert_eq!(Kernel::from(Interpolant::Hermite).nodes()[16], [0, -2304, 2560, -768, 0]);
    // x = 1: Eq. 12 gives −1/16, 9/16, 9/16, −1/16.
    assert_eq!(Kernel::from(Interpolant::Keys).nodes()[32], [-1024, 0, 9216, 0, -1024]);
    assert_eq!(Kernel::from(Interpolant::Linear).nodes()[1], [0, 0, 256, 0, 0]);
}

#[test]
fn weights_are_rounded_half_up() {
    let rounded = |units: f64| one_weight(units / 16384.0).unwrap().nodes()[9][3];
    assert_eq!([1.5, -1.5, 0.49, -0.5, -0.51].map(rounded), [2, -1, 0, 0, -1]);
}

#[test]
fn a_weight_of_2_is_refused_with_its_node_and_tap() {
    let refused = Err(KernelError::Weight { node: 9, tap: "r5", weight: 2.0 });
    assert_eq!(one_weight(2.0), refused);
    assert!(one_weight(-2.0 - 1e-9).is_err());
    assert!(one_weight(1.999_95).is_err());
    assert!(one_weight(f64::NAN).is_err());
    assert_eq!(one_weight(-2.0).unwrap().nodes()[9], [0, 0, 0, i16::MIN, 0]);
    assert_eq!(one_weight(1.999_938_964_843_75).unwrap().nodes()[9], [0, 0, 0, i16::MAX, 0]);
}

#[test]
fn a_kernel_has_65_nodes() {
    assert_eq!(Kernel::from_nodes(vec![[0; 5]; 64]), Err(KernelError::Count(64)));
    assert_eq!(Kernel::from_weights(&[[0.0; 5]; 66]), Err(KernelError::Count(66)));
    let nodes = Kernel::from(Interpolant::Keys).nodes().to_vec();
    assert_eq!(Kernel::from_nodes(nodes), Ok(Kernel::from(Interpolant::Keys)));
}

#[test]
fn only_keys_needs_the_outer_taps() {
    let taps = Interpolant::ALL.map(|interpolant| Kernel::from(interpolant).taps());
    assert_eq!(taps, [Taps::Five, Taps::Five, Taps::Seven, Taps::Five]);
    for tap in [0, 4] {
        let mut nodes = vec![[0; 5]; NODES];
        nodes[64][tap] = -1;
        assert_eq!(Kernel::from_nodes(nodes).unwrap().taps(), Taps::Seven);
    }
}

#[test]
fn a_kernel_is_sent_node_by_node_little_endian() {
    let mut nodes = vec![[0; 5]; NODES];
    nodes[1] = [0x0123, -1, 2, 3, 4];
    let bytes = Kernel::from_nodes(nodes).unwrap().to_bytes();
    assert_eq!(bytes.len(), 650);
    assert_eq!(bytes[10..20], [0x23, 0x01, 0xFF, 0xFF, 2, 0, 3, 0, 4, 0]);
}

#[test]
fn interpolants_are_read_by_name() {
    for (name, interpolant) in ["nearest", "linear", "keys", "hermite"].into_iter().zip(Interpolant::ALL) {
        assert_eq!(name.to_uppercase().parse(), Ok(interpolant));
        assert_eq!(interpolant.to_string(), name);
    }
    assert!("cubic".parse::<Interpolant>().unwrap_err().to_string().contains("`cubic` is no interpolant"));
}

proptest! {
    #[test]
    fn a_flat_field_stays_flat_in_each_colour(x in 0.0..2.0, own in 0.0..1.0, other in 0.0..1.0) {
        for interpolant in Interpolant::ALL {
            let value = interpolate(interpolant, x, |m| if m.rem_euclid(2.0) == 0.0 { own } else { other });
            prop_assert!((value - own).abs() < 1e-12, "{}: {} is not {}", interpolant, value, own);
        }
    }

    #[test]
    fn the_cubics_reproduce_parabolas_and_linear_reproduces_lines(x in 0.0..2.0, a in -1.0..1.0, b in -1.0..1.0) {
        let parabola = |m: f64| a * m * m + b * m + 0.5;
        for interpolant in [Interpolant::Keys, Interpolant::Hermite] {
            prop_assert!((interpolate(interpolant, x, parabola) - parabola(x)).abs() < 1e-12, "{}", interpolant);
        }
        let line = |m: f64| b * m + 0.5;
        prop_assert!((interpolate(Interpolant::Linear, x, line) - line(x)).abs() < 1e-12);
    }
}
