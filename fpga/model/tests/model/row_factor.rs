//! The row factor: which words are one, and how it is displayed.

use halfrow_model::{RowFactor, RowFactorError};

use crate::ONE;

#[test]
fn a_row_factor_is_above_zero_and_at_most_one() {
    for units in [1, 2, 14_648_488, ONE - 1, ONE] {
        assert_eq!(RowFactor::new(units).map(RowFactor::get), Ok(units));
        assert_eq!(RowFactor::try_from(units).map(u32::from), Ok(units));
    }
    for units in [0, ONE + 1, 1 << 25, u32::MAX] {
        assert_eq!(RowFactor::new(units), Err(RowFactorError { units }));
    }
    let refused = RowFactorError { units: 0 }.to_string();
    assert!(refused.starts_with("0 is no row factor, which is 1 to 16777216; give 2^24 / k"), "{refused}");
}

/// The decimals are `units` / 2^24 as `bc` prints them.
#[test]
fn a_row_factor_is_shown_as_its_fraction() {
    let shown = |units| RowFactor::new(units).unwrap().to_string();
    assert_eq!(shown(ONE), "1");
    assert_eq!(shown(ONE / 4 * 3), "0.75");
    assert_eq!(shown(ONE / 1024), "0.0009765625");
    assert_eq!(format!("{:.6}", RowFactor::new(14_648_488).unwrap()), "0.873118");
}

#[test]
fn the_nearest_row_factor_rounds_halves_up_and_stays_in_the_range() {
    let unit = f64::from(ONE).recip();
    for (shrink, units) in
        [(0.5, ONE / 2), (2.5 * unit, 3), (2.49 * unit, 2), (0.0, 1), (1.0, ONE), (1.1, ONE)]
    {
        assert_eq!(RowFactor::nearest(shrink).get(), units, "{shrink}");
    }
}

#[test]
fn half_way_to_another_row_factor_is_rounded_down() {
    let midpoint = |units| RowFactor::new(units).unwrap().midpoint(RowFactor::ONE).get();
    assert_eq!([1, 3, ONE].map(midpoint), [ONE / 2, ONE / 2 + 1, ONE]);
}
