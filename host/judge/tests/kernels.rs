//! The named kernels: what is true of each of them, and values found outside this code.

use halfrow::kernels::NamedKernel;
use halfrow::tables::KernelFile;
use halfrow_model::{BitDepth, Frame, Geometry, Kernel, Phase, TableSet, Taps, WEIGHT_ONE, correct};

const SHIPPED: [(NamedKernel, &str, Taps); 2] = [
    (NamedKernel::Sharp5, include_str!("../src/kernels/sharp5.json"), Taps::Five),
    (NamedKernel::Sharp7, include_str!("../src/kernels/sharp7.json"), Taps::Seven),
];

/// The weights of G0 to G6 at each node: the two that are not stored follow from the other five.
fn seven(kernel: &Kernel) -> impl Iterator<Item = [i32; 7]> {
    kernel.nodes().iter().map(|node| {
        let [g0, r1, g4, r5, g6] = node.map(i32::from);
        [g0, r1, WEIGHT_ONE - g0 - g4 - g6, -r1 - r5, g4, r5, g6]
    })
}

#[test]
fn every_name_is_read_back() {
    for kernel in NamedKernel::ALL {
        assert_eq!(kernel.name().to_uppercase().parse(), Ok(kernel));
    }
    let unknown = "sharp6".parse::<NamedKernel>().unwrap_err().to_string();
    assert!(NamedKernel::ALL.iter().all(|kernel| unknown.contains(kernel.name())), "{unknown}");
}

#[test]
fn the_files_of_fitted_kernels_tell_where_they_come_from() {
    for (named, text, taps) in SHIPPED {
        let file = KernelFile::parse(text).unwrap();
        assert_eq!(file.kernel.taps(), taps);
        let about = file.about.unwrap();
        for key in ["made_by", "images", "models", "ridge", "figures"] {
            assert!(about.contains_key(key), "{named}: {key}");
        }
        for image in about["images"].as_array().unwrap() {
            assert!(!image["name"].as_str().unwrap().starts_with("kodim"), "{named} was trained on {image}");
        }
    }
}

/// Light has no preferred direction: seen from the other side, G0 is G6, G2 is G4 and R1 is R5. Rounding leaves up to
/// four units in G2, which takes up the rounding of three weights.
#[test]
fn fitted_kernels_are_the_same_from_both_sides() {
    for (named, ..) in SHIPPED {
        let nodes: Vec<_> = seven(&named.kernel().unwrap()).collect();
        for (node, mirrored) in nodes.iter().zip(nodes.iter().rev()) {
            for (tap, weight) in node.iter().enumerate() {
                assert!((weight - mirrored[6 - tap]).abs() <= 4, "{named}: {node:?} {mirrored:?}");
            }
        }
    }
}

#[test]
fn a_flat_field_stays_as_it_is_under_every_kernel() {
    let geometry = Geometry::centred(64, 48, BitDepth::Twelve).unwrap();
    let lens = halfrow_model::Equidistant::from_radius(40.0).unwrap();
    let tables = TableSet::from_lens(geometry, &lens, None).unwrap();
    // Green 3000, red and blue 1000.
    let places = (0..48).flat_map(|row| (0..64).map(move |column| (row + column) % 2));
    let samples = places.map(|other| if other == 0 { 3000 } else { 1000 }).collect();
    let frame = Frame::new(64, BitDepth::Twelve, Phase::Grbg, samples).unwrap();
    for named in NamedKernel::ALL {
        assert_eq!(correct(&tables, &named.kernel().unwrap(), &frame).unwrap(), frame, "{named}");
    }
}

/// By hand, at x = 0, 1 and 2: Hermite's r1, g4, r5 minus f″/16384, where f″ is (−3x/4 + 1, −3x/2 + 3/2, 3x/4 − 1/2);
/// halves are rounded up.
#[test]
fn the_balanced_hermite_kernel_is_shifted_by_its_curvature() {
    let kernel = NamedKernel::HermiteBalanced.kernel().unwrap();
    assert_eq!(kernel.taps(), Taps::Five);
    assert_eq!(kernel.nodes()[0], [0, -1, -1, 1, 0]);
    assert_eq!(kernel.nodes()[32], [0, -2048, 8192, -2048, 0]);
    assert_eq!(kernel.nodes()[64], [0, 1, 16386, -1, 0]);
}
