//! A lens used for frames whose size is not that of the pictures it was calibrated with.

use halfrow::lenses::{LensContentError, LensFile, WrongShape};

use super::{OPENCV_YAML, described};

#[test]
fn frames_of_the_same_shape_take_the_lens_scaled() {
    let file = LensFile::parse(OPENCV_YAML).unwrap();
    let (lens, (column, row)) = file.for_frame(1920, 1080).unwrap();
    // By hand: 642 · 1.5 − 0.5 and 358.75 · 1.5 − 0.5, because a pixel's middle is half a pixel from its edge.
    assert_eq!((column, row), (962.5, 537.625));
    assert_eq!(lens, described(0.75).lens.scaled(1.5).unwrap());
    assert_eq!(file.for_frame(1280, 720).unwrap(), (described(0.75).lens, (641.5, 358.25)));
}

#[test]
fn frames_of_another_shape_are_refused_with_both_sizes() {
    let refused = LensFile::parse(OPENCV_YAML).unwrap().for_frame(1920, 1200).unwrap_err();
    let shape = WrongShape { columns: 1280, rows: 720, width: 1920, height: 1200 };
    assert_eq!(refused, LensContentError::Shape(shape));
    assert!(refused.to_string().contains("1280 x 720, and frames of 1920 x 1200"), "{refused}");
}

#[test]
fn frames_that_cannot_be_have_another_shape() {
    let file = LensFile::parse(OPENCV_YAML).unwrap();
    for (width, height) in [(usize::MAX, usize::MAX), (0, 0), (0, 720)] {
        let shape = WrongShape { columns: 1280, rows: 720, width, height };
        assert_eq!(file.for_frame(width, height), Err(LensContentError::Shape(shape)));
    }
}
