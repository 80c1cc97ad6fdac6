//! Eqs. 1 to 4.

use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2, FRAC_PI_4, FRAC_PI_6, PI};

use halfrow_model::{Equidistant, LensError};
use proptest::prelude::*;

/// A lens of f = 100 pixels, so that 100 pixels are one radian.
fn lens() -> Equidistant {
    Equidistant::from_radius(50.0 * PI).unwrap()
}

pub(crate) fn assert_close(actual: f64, expected: f64) {
    assert!((actual - expected).abs() <= 1e-9 * expected.abs().max(1.0), "{actual} is not {expected}");
}

#[test]
fn the_papers_lens_has_a_radius_of_1106_697_pixels() {
    let lens = Equidistant::default();
    assert!((lens.radius() - 1106.697).abs() < 5e-4);
    assert!((lens.focal_length() - 704.545_454_5).abs() < 1e-7);
    let from_data_sheet = Equidistant::from_focal_length(1.55, 2.2, 180.0).unwrap();
    assert_close(from_data_sheet.radius(), lens.radius());
    assert_close(from_data_sheet.focal_length(), lens.focal_length());
}

#[test]
fn a_wider_field_of_view_widens_the_circle_and_keeps_the_focal_length() {
    let lens = Equidistant::from_focal_length(1.0, 10.0, 270.0).unwrap();
    assert_close(lens.focal_length(), 100.0);
    assert_close(lens.radius(), 75.0 * PI);
    assert_eq!(Equidistant::from_both(lens.focal_length(), lens.radius()), Ok(lens));
}

#[test]
fn the_radius_is_where_90_degrees_land() {
    let [u, v, w] = lens().ray(lens().radius(), 0.0).unwrap();
    assert_close(u, 1.0);
    assert_eq!(v, 0.0);
    assert!(w.abs() < 1e-15);
}

#[test]
fn the_centre_looks_straight_ahead() {
    assert_eq!(lens().ray(0.0, 0.0), Some([0.0, 0.0, 1.0]));
    assert_eq!(lens().image_point([0.0, 0.0, 3.0]), (0.0, 0.0));
}

#[test]
fn a_diagonal_ray_at_45_degrees_has_a_latitude_of_30_degrees() {
    let edge = 100.0 * FRAC_PI_4 * FRAC_1_SQRT_2;
    let direction = lens().spherical(edge, edge);
    // sin φ = sin 45° · sin 45°, tan θ = tan 45° · cos 45°
    assert_close(direction.latitude, FRAC_PI_6);
    assert_close(direction.longitude, FRAC_1_SQRT_2.atan());
}

#[test]
fn beyond_90_degrees_the_ray_comes_from_behind() {
    // 120° off the axis, 30° below the horizontal; expected values from Python's math module.
    let (x, y) = (181.379_936_422_341_78, 104.719_755_119_659_75);
    let [u, v, w] = lens().ray(x, y).unwrap();
    assert_close(u, 0.75);
    assert_close(v, 0.433_012_701_892_219_3);
    assert_close(w, -0.5);
    let direction = lens().spherical(x, y);
    assert_close(direction.longitude, 2.158_798_930_342_464);
    assert_close(direction.latitude, 0.447_832_396_928_932_45);
}

#[test]
fn straight_back_is_imaged_on_the_rim() {
    let (x, y) = lens().image_point([0.0, 0.0, -2.0]);
    assert_close(x, 100.0 * PI);
    assert_eq!(y, 0.0);
    assert!(lens().ray(314.1, 0.0).is_some());
    assert_eq!(lens().ray(0.0, 314.2), None);
}

#[test]
fn figures_of_no_lens_are_refused_by_name() {
    for radius in [0.0, -1.0, 0.5, 2e9, f64::INFINITY] {
        assert_eq!(Equidistant::from_radius(radius), Err(LensError::Radius(radius)));
        assert_eq!(Equidistant::from_both(40.0, radius), Err(LensError::Radius(radius)));
    }
    assert!(matches!(Equidistant::from_radius(f64::NAN), Err(LensError::Radius(_))));
    for focal_length in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(Equidistant::from_both(focal_length, 40.0), Err(LensError::Radius(_))));
    }
    let new = Equidistant::from_focal_length;
    assert_eq!(new(0.0, 2.2, 180.0), Err(LensError::FocalLength(0.0)));
    assert_eq!(new(1.55, -2.2, 180.0), Err(LensError::PixelPitch(-2.2)));
    assert_eq!(new(1.55, 2.2, 360.5), Err(LensError::FieldOfView(360.5)));
    assert!(new(1.55, 2.2, 360.0).is_ok());
    assert_eq!(new(1.55, 2.2, 0.0), Err(LensError::FieldOfView(0.0)));
    assert!(matches!(new(1e12, 1.0, 180.0), Err(LensError::Radius(_))));
}

proptest! {
    #[test]
    fn a_ray_has_unit_length_and_returns_to_its_point(r in 0.0..0.999 * PI, angle in -PI..PI) {
        let (x, y) = (100.0 * r * angle.cos(), 100.0 * r * angle.sin());
        let ray = lens().ray(x, y).unwrap();
        prop_assert!((ray.iter().map(|part| part * part).sum::<f64>() - 1.0).abs() < 1e-12);
        let (back_x, back_y) = lens().image_point(ray.map(|part| 7.0 * part));
        prop_assert!((back_x - x).abs() < 1e-6 && (back_y - y).abs() < 1e-6);
    }

    #[test]
    fn inside_90_degrees_longitude_and_latitude_are_the_printed_equation(r in 0.01..0.999 * FRAC_PI_2, angle in -PI..PI) {
        let (x, y) = (100.0 * r * angle.cos(), 100.0 * r * angle.sin());
        let direction = lens().spherical(x, y);
        prop_assert!((direction.longitude - (angle.cos() * r.tan()).atan()).abs() < 1e-9);
        prop_assert!((direction.latitude - (angle.sin() * r.sin()).asin()).abs() < 1e-6);
    }
}
