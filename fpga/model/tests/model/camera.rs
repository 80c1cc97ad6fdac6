//! Row factors of calibrated lenses against linear programming: SciPy 1.17.1 (HiGHS) and NumPy 2.4.6, written from the
//! definitions.

use halfrow_model::{
    BitDepth, CalibratedLens, Camera, CameraError, Equidistant, Geometry, LensError, Profile, Residual,
    RowFactor, TableSet,
};

use crate::calibrated::{DSL215_CENTRE, dsl215, kannala_brandt};

fn camera(size: (usize, usize), lens: CalibratedLens, centre: (f64, f64)) -> Camera {
    let geometry = Geometry::centred(size.0, size.1, BitDepth::Twelve).unwrap();
    Camera::new(geometry, lens, centre, 180.0).unwrap()
}

/// The paper's lens on its frame.
fn paper() -> Camera {
    let lens = Equidistant::from_radius(1106.697).unwrap();
    camera((1920, 1080), lens.into(), (959.5, 539.5))
}

/// The other lenses, on frames so small that a test can visit every pixel.
fn tenth() -> Camera {
    camera((128, 72), kannala_brandt(0.1), (60.3, 30.8))
}

fn fifth() -> Camera {
    let (column, row) = DSL215_CENTRE;
    camera((150, 96), dsl215().scaled(0.2).unwrap(), ((column + 0.5) * 0.2 - 0.5, (row + 0.5) * 0.2 - 0.5))
}

/// Checks that the row factors of the rows named in `expected` are within 2 of it: Q is rounded, and the program stops at 1e-7.
#[track_caller]
fn assert_row_factors(tables: &TableSet, expected: &[(usize, f64)]) {
    for &(row, factor) in expected {
        let found = f64::from(tables.row_factor(row).unwrap().get());
        assert!((found - factor).abs() < 2.0, "row {row}: {found} is not {factor}");
    }
}

/// The mean and the largest absolute value.
fn spread(residuals: &[f64]) -> (f64, f64) {
    let amounts = residuals.iter().map(|residual| residual.abs());
    (amounts.clone().sum::<f64>() / residuals.len() as f64, amounts.fold(0.0, f64::max))
}

fn residuals(camera: &Camera, tables: &TableSet) -> Vec<Residual> {
    let factors = tables.row_factors().unwrap().iter().enumerate();
    factors
        .flat_map(|(row, &factor)| {
            camera.targets(row).map(move |target| camera.residual(row, factor, target))
        })
        .collect()
}

#[track_caller]
fn assert_spread(camera: &Camera, tables: &TableSet, pixels: usize, columns: (f64, f64), rows: (f64, f64)) {
    let found = residuals(camera, tables);
    assert_eq!(found.len(), pixels);
    let found_columns = spread(&found.iter().map(|residual| residual.columns).collect::<Vec<_>>());
    let found_rows = spread(&found.iter().map(|residual| residual.rows).collect::<Vec<_>>());
    for ((mean, most), (expected_mean, expected_most)) in [(found_columns, columns), (found_rows, rows)] {
        assert!((mean - expected_mean).abs() < 1e-6, "mean {mean} is not {expected_mean}");
        // Half a unit of Q is 3e-6 of a pixel at the edge.
        assert!((most - expected_most).abs() < 5e-6, "largest {most} is not {expected_most}");
    }
}

#[test]
fn the_paper_s_rows_are_fitted_as_linear_programming_fits_them() {
    let expected = [(0, 14_124_828.212), (100, 15_052_944.671), (300, 16_278_900.409), (539, 16_777_213.850)];
    assert_row_factors(&paper().fitted(), &expected);
}

#[test]
fn eq_9_of_an_equidistant_lens_is_the_plain_table() {
    let lens = Equidistant::from_radius(1106.697).unwrap();
    let plain = TableSet::from_lens(Geometry::default(), &lens, None).unwrap();
    assert_eq!(paper().equation_9(), plain);
    assert_eq!(paper().rows_outside_circle(), 0);
}

#[test]
fn the_rows_of_measured_lenses_are_fitted_as_linear_programming_fits_them() {
    let expected = [(0, 15_212_578.787), (8, 15_926_773.115), (30, 16_776_167.975), (71, 14_081_257.058)];
    assert_row_factors(&tenth().fitted(), &expected);
    let expected = [(0, 13_162_999.784), (10, 14_661_803.723), (45, 16_776_790.707), (95, 12_415_174.488)];
    assert_row_factors(&fifth().fitted(), &expected);
    let full = camera((752, 480), dsl215(), DSL215_CENTRE);
    assert_row_factors(&full.fitted(), &[(0, 13_125_603.730), (150, 16_374_260.952), (479, 12_368_952.034)]);
}

/// Oblong pixels make the circle an ellipse: R is in columns, and y is counted in pixel widths.
#[test]
fn eq_9_of_measured_lenses_takes_r_from_90_degrees() {
    assert!((tenth().radius() - 82.486_596_644_624_63).abs() < 1e-9);
    assert_eq!(tenth().geometry().centre2(), 121);
    assert_row_factors(
        &tenth().equation_9(),
        &[(0, 15_549_370.794), (30, 16_776_417.927), (71, 14_623_893.114)],
    );
    assert!((fifth().radius() - 77.711_559_354_207_82).abs() < 1e-9);
    assert_row_factors(&fifth().equation_9(), &[(0, 13_600_525.311), (95, 12_939_033.903)]);
}

#[test]
fn what_remains_is_what_numpy_finds_at_every_pixel() {
    let (camera, rows) = (tenth(), (1.158_241_784_1, 7.770_492_0));
    assert_spread(&camera, &camera.equation_9(), 8750, (0.407_197_600_3, 2.325_895_912_6), rows);
    assert_spread(&camera, &camera.fitted(), 8750, (0.123_621_333_4, 0.854_832_933_8), rows);
    let (camera, rows) = (fifth(), (2.286_629_296_9, 13.422_402_8));
    assert_spread(&camera, &camera.equation_9(), 13_276, (0.754_928_549_8, 4.402_600_947_4), rows);
    assert_spread(&camera, &camera.fitted(), 13_276, (0.434_122_577_4, 2.774_459_535_0), rows);
}

#[test]
fn rows_without_a_sample_in_the_circle_are_not_stretched() {
    let lens = Equidistant::from_radius(40.0).unwrap();
    let camera = camera((64, 100), lens.into(), (31.5, 49.5));
    // |y| is 0.5, 1.5, … 49.5; ten of the 50 rows on either side have a |y| of 40.5 or more.
    assert_eq!(camera.rows_outside_circle(), 20);
    assert!((0..10).all(
        |row| camera.fitted().row_factor(row) == Some(RowFactor::ONE) && camera.targets(row).count() == 0
    ));
    assert_eq!(camera.equation_9().row_factor(9), Some(RowFactor::ONE));
}

#[test]
fn a_narrower_field_of_view_narrows_the_circle() {
    let geometry = Geometry::centred(752, 480, BitDepth::Eight).unwrap();
    let camera = Camera::new(geometry, dsl215(), DSL215_CENTRE, 120.0).unwrap();
    assert!((camera.radius() - 267.114_339_895).abs() < 1e-8);
    let axis: Vec<_> = camera.targets(230).map(|target| target.column).collect();
    assert_eq!((axis[0], axis[axis.len() - 1]), (98, 631));
}

#[test]
fn a_profile_that_turns_back_inside_the_frame_is_refused_and_outside_of_it_taken() {
    let lens = |f: f64| {
        CalibratedLens::new(Profile::KannalaBrandt([0.1, -0.2, 0.05, -0.02]), [[f, 0.0], [0.0, f]]).unwrap()
    };
    let geometry = Geometry::centred(640, 480, BitDepth::Eight).unwrap();
    let new = |f: f64, field| Camera::new(geometry, lens(f), (319.5, 239.5), field);
    let refused = new(300.0, 180.0).unwrap_err();
    assert!(
        matches!(refused, CameraError::Lens(LensError::TurnsBack { angle }) if (angle - 64.778).abs() < 1e-3)
    );
    // Twice the angle is 129.556.
    assert!(refused.to_string().ends_with("give a field of view below 129.5 degrees"), "{refused}");
    assert!(new(300.0, 129.5).is_ok());
    let far = new(900.0, 180.0).unwrap();
    assert!((far.radius() - 450.0 * std::f64::consts::PI).abs() < 1e-9);
    assert!(far.fitted().row_factors().unwrap().iter().all(|&factor| factor < RowFactor::ONE));
}

/// The profile rises to 0.963353 f, by its values in steps of 1e-5. From an axis 100.5 columns and 80.5 rows inside one corner
/// of the frame, the other corners are 411, 544 and 670 pixels away.
#[test]
fn a_profile_that_turns_back_before_one_corner_alone_is_refused() {
    let geometry = Geometry::centred(640, 480, BitDepth::Eight).unwrap();
    for centre in [(100.5, 80.5), (538.5, 80.5), (100.5, 398.5), (538.5, 398.5)] {
        let new = |farthest: f64| {
            let f = farthest / 0.963_353;
            let profile = Profile::KannalaBrandt([0.1, -0.2, 0.05, -0.02]);
            let lens = CalibratedLens::new(profile, [[f, 0.0], [0.0, f]]).unwrap();
            Camera::new(geometry, lens, centre, 180.0)
        };
        assert!(matches!(new(669.0), Err(CameraError::Lens(LensError::TurnsBack { .. }))), "{centre:?}");
        assert!(new(671.0).is_ok(), "{centre:?}");
    }
}

#[test]
fn a_lens_that_is_not_before_the_frame_is_refused() {
    let geometry = Geometry::centred(752, 480, BitDepth::Eight).unwrap();
    let new = |centre, field| Camera::new(geometry, dsl215(), centre, field).unwrap_err();
    assert!(matches!(new((752.0, 10.0), 180.0), CameraError::Geometry(_)));
    assert!(matches!(new((f64::NAN, 10.0), 180.0), CameraError::Geometry(_)));
    assert!(matches!(new((10.0, f64::INFINITY), 180.0), CameraError::CentreRow(_)));
    for factor in [1e-4, 1e9, 1e90] {
        let lens = dsl215().scaled(factor).unwrap();
        let refused = Camera::new(geometry, lens, (10.0, 10.0), 180.0).unwrap_err();
        assert!(matches!(refused, CameraError::Lens(LensError::Radius(_))), "{factor}: {refused}");
    }
    for field in [0.0, -1.0, 361.0, f64::NAN] {
        assert!(matches!(new((10.0, 10.0), field), CameraError::Lens(LensError::FieldOfView(_))));
    }
}
