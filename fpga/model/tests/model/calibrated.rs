//! Calibrated lenses against OpenCV's fisheye functions and against an evaluation of OCamCalib's in NumPy.

use std::f64::consts::{FRAC_PI_2, PI};

use halfrow_model::{CalibratedLens, Equidistant, LensError, Profile, exact};

/// A camera of 1280 x 720 with oblong, slanted pixels.
pub(crate) fn kannala_brandt(scale: f64) -> CalibratedLens {
    let pixels = [[552.25, 0.75], [0.0, 549.125]].map(|row| row.map(|entry| scale * entry));
    CalibratedLens::new(Profile::KannalaBrandt([-0.0125, 0.0031, -0.0042, 0.0007]), pixels).unwrap()
}

/// A Sunex DSL215 in front of a sensor of 752 x 480, as measured and published in BSD-3 licensed ctu-mrs/uvdar_core.
pub(crate) fn dsl215() -> CalibratedLens {
    let coefficients = vec![-2.595395e+02, 0.0, 1.626945e-03, -2.328091e-06, 6.601777e-09];
    let pixels = [[1.0, -0.000_158], [-0.000_012, 1.000_314]];
    CalibratedLens::new(Profile::Polynomial(coefficients), pixels).unwrap()
}

/// Column and row of the DSL215's axis on that sensor.
pub(crate) const DSL215_CENTRE: (f64, f64) = (364.430_465, 229.581_672);

#[track_caller]
fn assert_near(found: (f64, f64), expected: (f64, f64)) {
    let distance = (found.0 - expected.0).hypot(found.1 - expected.1);
    assert!(distance < 1e-9, "{found:?} is not {expected:?}");
}

/// `cv2.fisheye.projectPoints` of OpenCV 5.0.0 with alpha = 0.75/552.25, less the principal point.
#[test]
fn rays_land_where_opencv_puts_them() {
    let expected = [
        ([0.3, -0.2, 1.0], (158.632_664_504_782_04, -105.251_970_271_787_94)),
        ([1.0, 0.5, 0.1], (702.539_129_820_294_2, 349.044_831_180_790_9)),
        ([-2.0, 1.0, 0.5], (-646.609_681_994_019_7, 321.693_808_946_741_7)),
        ([0.01, 0.02, 1.0], (5.536_542_772_316_238, 10.980_601_534_440_211)),
    ];
    for (ray, place) in expected {
        assert_near(kannala_brandt(1.0).image_point(ray).unwrap(), place);
    }
    assert_eq!(kannala_brandt(1.0).image_point([0.0, 0.0, 2.0]), Some((0.0, 0.0)));
}

/// `cv2.fisheye.undistortPoints` of OpenCV 5.0.0, which knows no skew, to the precision at which it stops iterating.
#[test]
fn pixels_see_what_opencv_says() {
    let profile = Profile::KannalaBrandt([-0.0125, 0.0031, -0.0042, 0.0007]);
    let lens = CalibratedLens::new(profile, [[552.25, 0.0], [0.0, 549.125]]).unwrap();
    let expected = [
        ((100.0, 50.0), [-0.792_646_524_435_881_2, -0.453_783_491_420_064_6, 0.407_175_674_880_430_3]),
        ((1200.0, 700.0), [0.798_011_376_619_740_3, 0.491_087_564_433_764_7, 0.349_300_510_798_338_3]),
        ((641.5, 400.0), [0.0, 0.075_962_290_723_404_59, 0.997_110_691_141_185_6]),
    ];
    for ((column, row), ray) in expected {
        let found = lens.ray(column - 641.5, row - 358.25).unwrap();
        let distance = found.iter().zip(ray).map(|(found, expected)| (found - expected).abs()).sum::<f64>();
        assert!(distance < 1e-6, "{found:?} is not {ray:?}");
    }
}

/// OCamCalib's world2cam with `numpy.roots` of NumPy 2.4.6 on the direct polynomial: its row and column are our column and row.
#[test]
fn rays_land_where_ocamcalib_puts_them() {
    let expected = [
        ([0.3, -0.2, 1.0], (438.776_081_069_561_3, 180.006_694_688_212_58)),
        ([1.0, 0.5, 0.1], (694.224_633_244_282_1, 394.539_607_953_476_8)),
        ([-0.6, 0.8, -0.02], (128.597_972_329_792_04, 544.060_310_587_258_2)),
        ([-1.0, 0.0, 0.5], (82.693_613_065_804_53, 229.585_052_842_223_2)),
        ([0.0, -1.0, 1.0], (364.462_316_473_635_55, 27.926_766_947_795_187)),
    ];
    for (ray, (column, row)) in expected {
        let place = (column - DSL215_CENTRE.0, row - DSL215_CENTRE.1);
        assert_near(dsl215().image_point(ray).unwrap(), place);
    }
}

/// OCamCalib's cam2world in NumPy 2.4.6, its axes turned to right, down and ahead.
#[test]
fn pixels_see_what_ocamcalib_says() {
    let expected = [
        ((20.0, 10.0), [-0.839_873_215_891_424_4, -0.535_224_960_723_040_7, -0.090_261_966_781_232_45]),
        ((100.0, 400.0), [-0.796_281_775_553_732_7, 0.513_063_790_107_135_2, 0.320_469_782_044_246_7]),
        ((751.0, 0.0), [0.827_302_078_727_902, -0.491_212_402_974_642_9, -0.272_546_593_624_593_55]),
    ];
    for ((column, row), ray) in expected {
        let found = dsl215().ray(column - DSL215_CENTRE.0, row - DSL215_CENTRE.1).unwrap();
        assert!(found.iter().zip(ray).all(|(found, expected)| (found - expected).abs() < 1e-12), "{found:?}");
    }
}

/// From the same NumPy program: r at 45°, 60° and 90°. An equidistant lens would have 259.54 · π/2 = 407.7 at 90°; this one is
/// 4.7 % short of it.
#[test]
fn the_dsl215_images_90_degrees_short_of_equidistant() {
    let radii = [(PI / 4.0, 201.591_605_288_144_34), (PI / 3.0, 267.114_339_895_304_98)];
    for (angle, radius) in radii.into_iter().chain([(FRAC_PI_2, 388.557_796_771_038_6)]) {
        assert!((dsl215().column(angle).unwrap() - radius).abs() < 1e-9, "{:?}", dsl215().column(angle));
    }
    assert_eq!(dsl215().focal_length(), 259.5395);
}

#[test]
fn an_equidistant_lens_is_straightened_as_by_eqs_5_to_7() {
    let plain = Equidistant::from_radius(1106.697).unwrap();
    let lens = CalibratedLens::from(plain);
    for (x, y) in [(-900.0, -500.0), (12.5, 300.0), (700.0, -1.0), (0.0, 40.0)] {
        let (column, _) = lens.straightened(lens.ray(x, y).unwrap()).unwrap();
        assert!((column - exact(&plain, x, y).0).abs() < 1e-9);
    }
}

#[test]
fn on_the_horizon_and_on_the_axis_s_meridian_nothing_moves() {
    let lens = dsl215().scaled(2.0).unwrap();
    for angle in [-1.5, -0.4, 0.3, 1.2_f64] {
        let (column, row) = lens.straightened([angle.sin(), 0.0, angle.cos()]).unwrap();
        assert_eq!((column, row), (lens.column(angle.abs()).unwrap().copysign(angle), 0.0));
        let (column, row) = lens.straightened([0.0, angle.sin(), angle.cos()]).unwrap();
        let down = lens.image_point([0.0, angle.sin(), angle.cos()]).unwrap().1;
        assert!(column == 0.0 && (row - down).abs() < 1e-9);
    }
}

/// By `numpy.polynomial` of NumPy 2.4.6, the slope of r is 0 at θ = 64.778 470 316°.
#[test]
fn a_profile_ends_where_it_turns_back() {
    let profile = Profile::KannalaBrandt([0.1, -0.2, 0.05, -0.02]);
    let lens = CalibratedLens::new(profile, [[500.0, 0.0], [0.0, 500.0]]).unwrap();
    assert!((lens.widest().to_degrees() - 64.778_470_316).abs() < 1e-8, "{}", lens.widest().to_degrees());
    let rim = lens.column(lens.widest()).unwrap();
    assert!(lens.ray(rim - 0.001, 0.0).is_some() && lens.ray(rim + 0.001, 0.0).is_none());
    assert_eq!(lens.column(1.2), None);
}

#[test]
fn rays_return_to_their_pixels() {
    for lens in [kannala_brandt(1.0), dsl215()] {
        for (x, y) in [(0.0, 0.0), (1e-9, 0.0), (-310.0, 200.0), (5.0, -239.0), (380.0, 0.25)] {
            assert_near(lens.image_point(lens.ray(x, y).unwrap().map(|part| 3.0 * part)).unwrap(), (x, y));
        }
    }
}

#[test]
fn what_is_no_lens_is_refused() {
    let square = [[500.0, 0.0], [0.0, 500.0]];
    let new = |profile, pixels| CalibratedLens::new(profile, pixels).unwrap_err();
    let equidistant = Profile::Equidistant;
    assert!(matches!(new(Profile::KannalaBrandt([f64::NAN; 4]), square), LensError::Coefficient(_)));
    assert!(matches!(
        new(equidistant.clone(), [[f64::INFINITY, 0.0], [0.0, 1.0]]),
        LensError::Coefficient(_)
    ));
    assert!(matches!(new(equidistant.clone(), [[-500.0, 0.0], [0.0, 500.0]]), LensError::Mirrored { .. }));
    assert!(matches!(new(equidistant.clone(), [[500.0, 0.0], [0.0, 0.0]]), LensError::Mirrored { .. }));
    assert!(matches!(new(equidistant.clone(), [[1.0, 2.0], [2.0, 1.0]]), LensError::Mirrored { .. }));
    for huge in [1e300, 1e-300] {
        let pixels = [[huge, 0.0], [0.0, huge]];
        let refused = new(equidistant.clone(), pixels);
        assert!(!matches!(refused, LensError::Axis), "{refused}");
    }
    for coefficients in [vec![], vec![0.0], vec![259.5], vec![259.5, 0.0, -0.001]] {
        assert_eq!(new(Profile::Polynomial(coefficients), square), LensError::Axis);
    }
    assert!(matches!(new(Profile::KannalaBrandt([1e308; 4]), square), LensError::Axis));
    assert!(dsl215().scaled(0.0).is_err() && dsl215().scaled(f64::NAN).is_err());
}
