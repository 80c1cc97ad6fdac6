//! The street: that it is what a camera would see, and that it measures the correction.

use halfrow_frames::street::edge_deviation;
use halfrow_frames::{Builtin, Scene};
use halfrow_model::{BitDepth, Colour, Equidistant, Frame, Geometry, Interpolant, Kernel, TableSet, correct};

fn street(scene: &Scene) -> Frame {
    Builtin::Street.render(scene).unwrap()
}

fn corrected(scene: &Scene, frame: &Frame) -> Frame {
    let tables = TableSet::from_lens(scene.geometry, &scene.lens, scene.centre_y).unwrap();
    correct(&tables, &Kernel::from(Interpolant::Hermite), frame).unwrap()
}

/// The outermost edge, at longitude −73.3°, bends by up to 102.1 columns. After the correction the edge at −48.8° is the worst,
/// with 26.9. Both numbers were computed outside this program, by bisecting Eq. 4.
#[test]
fn the_correction_straightens_the_houses() {
    let scene = Scene::default();
    let fisheye = street(&scene);
    let before = edge_deviation(&fisheye, &scene).unwrap();
    let after = edge_deviation(&corrected(&scene, &fisheye), &scene).unwrap();
    assert_eq!((before.edges, after.edges), (10, 10));
    assert!((before.max_px - 102.1).abs() < 0.5, "{before:?}");
    assert!((after.max_px - 26.9).abs() < 0.5, "{after:?}");
    assert!(before.mean_px > 3.0 * after.mean_px, "{before:?}, {after:?}");
}

#[test]
fn another_picture_has_no_edges_to_measure() {
    let scene = Scene { geometry: Geometry::centred(640, 360, BitDepth::Ten).unwrap(), ..Scene::default() };
    for other in [Builtin::Grey, Builtin::RampAcross] {
        assert_eq!(edge_deviation(&other.render(&scene).unwrap(), &scene), None);
    }
}

#[test]
fn the_optical_centre_moves_the_street() {
    let geometry = Geometry::centred(640, 100, BitDepth::Twelve).unwrap();
    let middle = Scene { geometry, ..Scene::default() };
    let aside =
        Scene { geometry: geometry.with_centre(339.5).unwrap(), centre_y: Some(59.5), ..Scene::default() };
    let (first, second) = (street(&middle), street(&aside));
    // The noise differs, as it is drawn in the order of the samples.
    let far = (0..80)
        .flat_map(|row| (0..600).map(move |column| (row, column)))
        .filter(|&(row, column)| first.row(row)[column].abs_diff(second.row(row + 10)[column + 20]) > 400);
    assert_eq!(far.count(), 0);
}

#[test]
fn no_light_comes_from_beyond_the_rim_of_the_lens() {
    // In the corners of the second frame, an angle that went on growing would be all the way round again.
    for (rim, width, height) in [(200.0, 640, 480), (50.0, 320, 240)] {
        let lens = Equidistant::from_radius(rim).unwrap();
        let geometry = Geometry::centred(width, height, BitDepth::Twelve).unwrap();
        let frame = street(&Scene { geometry, lens, ..Scene::default() });
        let centre = (width as f64 / 2.0 - 0.5, height as f64 / 2.0 - 0.5);
        let radius = |row: usize, column: usize| (column as f64 - centre.0).hypot(row as f64 - centre.1);
        for (row, samples) in frame.rows().enumerate() {
            // The black level is 1 % of full scale, and six of 8000 electrons are three steps.
            let outside = samples.iter().enumerate().filter(|(column, _)| radius(row, *column) > rim + 8.0);
            assert!(outside.map(|(_, &sample)| sample).all(|sample| (25..60).contains(&sample)), "row {row}");
        }
        assert!(frame.row(height / 2)[width / 2 - (0.75 * rim) as usize] > 100);
    }
}

#[test]
fn the_sky_is_blue_and_above_the_ground() {
    let scene = Scene::default();
    let frame = street(&scene);
    let mean = |rows: std::ops::Range<usize>, wanted: Colour| {
        let places = rows.flat_map(|row| (900..1000).map(move |column| (row, column)));
        let found: Vec<f64> = places
            .filter(|&(row, column)| scene.phase.colour(row, column) == wanted)
            .map(|(row, column)| frame.row(row)[column].into())
            .collect();
        found.iter().sum::<f64>() / found.len() as f64
    };
    assert!(mean(0..60, Colour::Blue) > 1.3 * mean(0..60, Colour::Red));
    assert!(mean(0..60, Colour::Green) > 3.0 * mean(1000..1060, Colour::Green));
}

/// The number of photons varies by its own square root. The difference of a sample between two exposures, of 8000 electrons at
/// full scale, has twice that variance plus twice the variance of the readout.
#[test]
fn the_noise_is_that_of_photons_and_reading_out() {
    let geometry = Geometry::centred(1920, 8, BitDepth::Twelve).unwrap();
    let scene = Scene { geometry, centre_y: Some(500.0), ..Scene::default() };
    let (first, second) = (street(&scene), street(&Scene { seed: 7, ..scene }));
    let step = 8000.0 / (4095.0 * 0.99);
    let (mut found, mut expected) = (0.0, 0.0);
    for (&a, &b) in first.samples().iter().zip(second.samples()).filter(|(a, _)| **a < 4000) {
        let (a, b) = (f64::from(a), f64::from(b));
        found += ((a - b) * step).powi(2);
        expected += (a + b - 2.0 * 40.95) * step + 2.0 * 36.0;
    }
    assert!((found / expected - 1.0).abs() < 0.05, "{}", found / expected);
}
