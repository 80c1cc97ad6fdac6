//! The limits of a frame and its edges.

use halfrow_model::{BitDepth, Geometry, GeometryError};

fn centred(width: usize, height: usize) -> Result<Geometry, GeometryError> {
    Geometry::centred(width, height, BitDepth::Ten)
}

#[test]
fn the_default_is_the_papers_frame() {
    assert_eq!(Ok(Geometry::default()), Geometry::centred(1920, 1080, BitDepth::Twelve));
    assert_eq!(Geometry::default().centre2(), 1919);
}

#[test]
fn a_width_is_even_and_from_64_to_2592() {
    for width in [0, 1, 62, 63, 65, 2591, 2593, 2594, usize::MAX] {
        assert_eq!(centred(width, 1), Err(GeometryError::Width(width)));
    }
    assert!(centred(64, 1).is_ok() && centred(2592, 1).is_ok());
}

#[test]
fn a_height_is_from_1_to_2048() {
    for height in [0, 2049] {
        assert_eq!(centred(64, height), Err(GeometryError::Height(height)));
    }
    assert!(centred(64, 2048).is_ok());
}

#[test]
fn the_optical_centre_stays_inside_the_frame() {
    let new = |centre2| Geometry::new(64, 1, BitDepth::Ten, centre2);
    assert!(new(0).is_ok() && new(126).is_ok());
    assert_eq!(new(127), Err(GeometryError::Centre { column: 63.5, last: 63 }));
}

#[test]
fn a_centre_is_rounded_to_half_a_column() {
    let centre2 = |column| centred(64, 1).unwrap().with_centre(column).map(|geometry| geometry.centre2());
    assert_eq!(centre2(31.5), Ok(63));
    assert_eq!(centre2(31.74), Ok(63));
    assert_eq!(centre2(31.75), Ok(64));
    assert_eq!(centre2(-0.25), Ok(0));
    assert_eq!(centre2(63.2), Ok(126));
    assert_eq!(centre2(63.25), Err(GeometryError::Centre { column: 63.25, last: 63 }));
    assert!(centre2(f64::NAN).is_err());
}

#[test]
fn rows_are_counted_from_the_middle_unless_told_otherwise() {
    let geometry = centred(64, 4).unwrap();
    assert_eq!([0, 1, 2, 3].map(|row| geometry.row_offset(row, None)), [-1.5, -0.5, 0.5, 1.5]);
    assert_eq!(geometry.row_offset(3, Some(-2.25)), 5.25);
}

#[test]
fn outside_the_row_the_nearest_column_of_the_same_colour_stands_in() {
    let geometry = centred(64, 1).unwrap();
    let columns = [-3, -2, -1, 0, 1, 62, 63, 64, 65, 66, 67].map(|column| geometry.sample_column(column));
    assert_eq!(columns, [1, 0, 1, 0, 1, 62, 63, 62, 63, 62, 63]);
}
