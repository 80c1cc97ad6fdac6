//! Eqs. 6 to 9 and the paper's Fig. 5.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::lens::assert_close;
use halfrow_model::{Equidistant, exact, exact_inverse, simplified, simplified_inverse, stretch_factor};
use proptest::prelude::*;

fn lens() -> Equidistant {
    Equidistant::from_radius(50.0 * PI).unwrap()
}

/// Fig. 5: |exact − simplified| at R = 100 on the rows up to `rows` from the centre, averaged over 201 columns. Outside the
/// image circle and at its top and bottom points it counts as 0.
fn mean_error(rows: i32) -> f64 {
    let lens = Equidistant::from_radius(100.0).unwrap();
    let error = |x: i32, y: i32| {
        if x * x + y * y > 10_000 || y.abs() == 100 {
            return 0.0;
        }
        let (x, y) = (f64::from(x), f64::from(y));
        (exact(&lens, x, y).0 - simplified(lens.radius(), x, y).0).abs()
    };
    let sum: f64 = (-rows..=rows).flat_map(|y| (-100..=100).map(move |x| error(x, y))).sum();
    sum / (201.0 * f64::from(2 * rows + 1))
}

#[test]
fn the_simplified_projection_errs_by_2_38_pixels_on_average_as_in_fig_5() {
    assert!((mean_error(100) - 2.3853).abs() < 5e-5, "{}", mean_error(100));
}

#[test]
fn the_middle_16_to_9_errs_by_0_80_pixels_on_average_as_in_fig_5() {
    assert!((mean_error(56) - 0.8021).abs() < 5e-5, "{}", mean_error(56));
}

#[test]
fn on_the_axis_row_the_exact_projection_changes_nothing() {
    for x in [-300.0, -100.0, 0.0, 1e-9, 42.0, 157.0, 314.0] {
        let (x_u, y_u) = exact(&lens(), x, 0.0);
        assert_close(x_u, x);
        assert_eq!(y_u, 0.0);
    }
}

#[test]
fn beyond_90_degrees_the_exact_projection_goes_on() {
    // 120° off the axis, 30° below the horizontal; expected value from Python's math module.
    let (x_u, y_u) = exact(&lens(), 181.379_936_422_341_78, 104.719_755_119_659_75);
    assert_close(x_u, 215.879_893_034_246_4);
    assert_eq!(y_u, 104.719_755_119_659_75);
}

#[test]
fn the_exact_projection_rises_along_every_row() {
    for y in [0.0, 30.0, -100.0, 157.0] {
        let rim = (1e4 * PI * PI - y * y).sqrt();
        let projected: Vec<_> =
            (1..1000).map(|step| exact(&lens(), rim * f64::from(step) / 1000.0, y).0).collect();
        assert!(projected.is_sorted_by(|low, high| low < high), "row {y}");
    }
}

#[test]
fn the_exact_projection_has_no_inverse_at_the_poles_and_behind() {
    assert_eq!(exact_inverse(&lens(), 10.0, 100.0 * FRAC_PI_2), None);
    assert_eq!(exact_inverse(&lens(), 10.0, -200.0), None);
    assert_eq!(exact_inverse(&lens(), -100.0 * PI, 10.0), None);
    assert_eq!(exact_inverse(&lens(), f64::NAN, 10.0), None);
    assert_eq!(exact_inverse(&lens(), 10.0, f64::NAN), None);
    assert_eq!(exact_inverse(&lens(), 0.0, 10.0), Some((0.0, 10.0)));
}

#[test]
fn a_row_at_three_fifths_of_the_radius_is_stretched_by_five_quarters() {
    assert_close(stretch_factor(100.0, 60.0), 1.25);
    let (x_u, y_u) = simplified(100.0, -80.0, 60.0);
    assert_close(x_u, -100.0);
    assert_eq!(y_u, 60.0);
}

#[test]
fn a_row_outside_the_circle_is_not_stretched() {
    assert_eq!(stretch_factor(100.0, 100.0), 1.0);
    assert_eq!(stretch_factor(100.0, -250.0), 1.0);
    assert_eq!(simplified(100.0, 33.0, 101.0), (33.0, 101.0));
    assert_eq!(stretch_factor(100.0, 0.0), 1.0);
}

#[test]
fn the_papers_frame_is_stretched_by_at_most_1_146() {
    assert_close(stretch_factor(1106.697, 540.0), 1.145_635_410_361_653_5);
}

proptest! {
    #[test]
    fn the_exact_inverse_returns_to_the_point(r in 0.0..0.99 * PI, angle in -PI..PI) {
        let (x, y) = (100.0 * r * angle.cos(), 100.0 * r * angle.sin());
        prop_assume!(y.abs() < 99.0 * FRAC_PI_2);
        let (x_u, y_u) = exact(&lens(), x, y);
        let (back, row) = exact_inverse(&lens(), x_u, y_u).unwrap();
        prop_assert!((back - x).abs() < 1e-7, "{} is not {}", back, x);
        prop_assert_eq!(row, y);
    }

    #[test]
    fn the_simplified_inverse_returns_to_the_point(x in -2000.0..2000.0, y in -1200.0..1200.0) {
        let (x_u, y_u) = simplified(1106.697, x, y);
        let (back, row) = simplified_inverse(1106.697, x_u, y_u);
        prop_assert!((back - x).abs() < 1e-9);
        prop_assert_eq!(row, y);
    }
}
