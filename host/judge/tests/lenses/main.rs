//! Lens files of each program, and what is wrong with some in the wild.

// clippy.toml allows this inside #[test] functions, but not in functions that several tests call.
#![allow(clippy::unwrap_used)]

mod refusals;
mod seen;
mod sizes;

use halfrow::lenses::{LensFile, LensModel};
use halfrow_model::{CalibratedLens, Profile};
use proptest::prelude::*;

/// Written by OpenCV 4.10.0's `cv2.FileStorage`.
const OPENCV_YAML: &str = include_str!("files/opencv-4.10.yml");
/// Written by OpenCV 4.10.0's `cv2.FileStorage`.
const OPENCV_JSON: &str = include_str!("files/opencv-4.10.json");
/// Written by OpenCV 5.0.0's `cv2.FileStorage`, with a header of YAML 1.2.
const OPENCV_5_YAML: &str = include_str!("files/opencv-5.0.yml");
/// In the layout of ROS's `camera_calibration_parsers`.
const CAMERA_INFO: &str = include_str!("files/camera_info.yaml");
/// In the layout of Kalibr's camchain.
const CAMCHAIN: &str = include_str!("files/camchain.yaml");
/// In the layout of OCamCalib's `export_data.m`, with numbers measured at a Sunex DSL215, published by ctu-mrs/uvdar_core under
/// BSD-3.
const DSL215: &str = include_str!("files/dsl215.txt");

/// The lens that all files but the last describe.
fn described(skew: f64) -> LensFile {
    let profile = Profile::KannalaBrandt([-0.0125, 0.0031, -0.0042, 0.0007]);
    LensFile {
        model: LensModel::OpenCvFisheye,
        lens: CalibratedLens::new(profile, [[552.25, skew], [0.0, 549.125]]).unwrap(),
        centre: (641.5, 358.25),
        size: Some((1280, 720)),
    }
}

/// `text` with `old`, which occurs once, replaced by `new`.
#[track_caller]
fn with(text: &str, old: &str, new: &str) -> String {
    assert_eq!(text.matches(old).count(), 1, "{old}");
    text.replace(old, new)
}

#[test]
fn every_program_s_file_gives_the_same_lens() {
    for text in [OPENCV_YAML, OPENCV_JSON, OPENCV_5_YAML, CAMERA_INFO] {
        assert_eq!(LensFile::parse(text).unwrap(), described(0.75));
    }
    assert_eq!(LensFile::parse(CAMCHAIN).unwrap(), described(0.0));
}

#[test]
fn ocamcalib_s_rows_come_before_its_columns() {
    let file = LensFile::parse(DSL215).unwrap();
    let coefficients = vec![-2.595395e+02, 0.0, 1.626945e-03, -2.328091e-06, 6.601777e-09];
    let pixels = [[1.0, -0.000_158], [-0.000_012, 1.000_314]];
    let lens = CalibratedLens::new(Profile::Polynomial(coefficients), pixels).unwrap();
    let expected = LensFile {
        model: LensModel::OCamCalib,
        lens,
        centre: (364.430_465, 229.581_672),
        size: Some((752, 480)),
    };
    assert_eq!(file, expected);
}

#[test]
fn line_ends_and_byte_order_marks_of_other_systems_change_nothing() {
    for text in [OPENCV_YAML, OPENCV_JSON, CAMERA_INFO, CAMCHAIN, DSL215] {
        let plain = LensFile::parse(text).unwrap();
        let windows = format!("\u{feff}{}", text.replace('\n', "\r\n"));
        assert_eq!(LensFile::parse(&windows).unwrap(), plain);
    }
}

#[test]
fn keys_may_be_spelt_in_every_way_that_programs_do() {
    let spelt = "%YAML:1.0\nImage_Width: 1280\nimageHeight: 720\nCamera-Matrix: !!opencv-matrix\n   rows: 3\n   \
                 cols: 3\n   dt: f\n   data: [ 552.25, 0.75, 641.5, 0, 549.125, 358.25, 0, 0, 1 ]\n\
                 distCoeffs: [[-0.0125], [3.1e-3], [-4.2E-03], [.7e-3]]\n";
    assert_eq!(LensFile::parse(spelt).unwrap(), described(0.75));
    let message = "width: 1280\nheight: 720\ndistortion_model: equidistant\nD: [-0.0125, 0.0031, -0.0042, 0.0007]\n\
                   K: [552.25, 0.75, 641.5, 0.0, 549.125, 358.25, 0.0, 0.0, 1.0]\nR: [1, 0, 0, 0, 1, 0, 0, 0, 1]\n";
    assert_eq!(LensFile::parse(message).unwrap(), described(0.75));
    let json = "{\n\t\"K\": [[552.25, 0.75, 641.5], [0, 549.125, 358.25], [0, 0, 1]],\n\t\"image_size\": [1280, 720],\n\
                \t\"D\": [-0.0125, 0.0031, -0.0042, 0.0007],\n\t\"rms\": .Nan\n}";
    assert_eq!(LensFile::parse(json).unwrap(), described(0.75));
}

#[test]
fn a_file_that_does_not_say_its_size_is_taken_as_the_frame_s() {
    let unsaid = with(&with(OPENCV_YAML, "image_width: 1280\n", ""), "image_height: 720\n", "");
    assert_eq!(LensFile::parse(&unsaid).unwrap().size, None);
    let zero = with(
        &with(CAMERA_INFO, "image_width: 1280", "image_width: 0"),
        "image_height: 720",
        "image_height: 0",
    );
    assert_eq!(LensFile::parse(&zero).unwrap().size, None);
    let (lens, centre) = LensFile::parse(&unsaid).unwrap().for_frame(1920, 1200).unwrap();
    assert_eq!((lens, centre), (described(0.75).lens, (641.5, 358.25)));
}

/// The direct polynomial is complete; the inverse is only a fit to it.
#[test]
fn ocamcalib_s_inverse_polynomial_may_be_missing() {
    let inverse = DSL215.lines().find(|line| line.starts_with("10 ")).unwrap();
    assert_eq!(LensFile::parse(&with(DSL215, inverse, "")).unwrap(), LensFile::parse(DSL215).unwrap());
}

#[test]
fn ocamcalib_s_comments_may_be_missing_or_stand_behind_numbers() {
    let plain: String =
        DSL215.lines().filter(|line| !line.starts_with('#')).map(|line| format!("{line}\n")).collect();
    assert_eq!(LensFile::parse(&plain).unwrap(), LensFile::parse(DSL215).unwrap());
    let noted = with(DSL215, "480 752", "480 752 % of the sensor");
    assert_eq!(LensFile::parse(&noted).unwrap(), LensFile::parse(DSL215).unwrap());
}

/// Reads `bytes` as a lens file: the body of a fuzzer. It must return.
fn fuzz_parse(bytes: &[u8]) {
    if let Ok(file) = LensFile::parse(&String::from_utf8_lossy(bytes)) {
        std::hint::black_box(file.for_frame(1920, 1080).is_ok());
    }
}

proptest! {
    #[test]
    fn whatever_is_cut_or_changed_the_reader_returns(
        which in 0_usize..6,
        start in 0.0..1.0_f64,
        length in 0_usize..40,
        put in "[-0-9.e:\\[\\]{}#%!&* \n\t,nax]{0,12}",
    ) {
        let text = [OPENCV_YAML, OPENCV_JSON, OPENCV_5_YAML, CAMERA_INFO, CAMCHAIN, DSL215][which];
        let from = (start * text.len() as f64) as usize;
        let mut bytes = text.as_bytes().to_vec();
        bytes.splice(from..(from + length).min(text.len()), put.into_bytes());
        fuzz_parse(&bytes);
    }

    #[test]
    fn whatever_the_bytes_are_the_reader_returns(bytes: Vec<u8>) {
        fuzz_parse(&bytes);
    }
}
