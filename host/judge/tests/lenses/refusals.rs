//! Files that hold no lens of these kinds are refused with what they are and what to do.

use std::path::Path;

use halfrow::lenses::{LensContentError, LensFile, LensFileError};

use super::{CAMCHAIN, CAMERA_INFO, DSL215, OPENCV_JSON, OPENCV_YAML, with};

fn refusal(text: &str) -> LensContentError {
    LensFile::parse(text).unwrap_err()
}

/// Asserts that the refusal of `text`, with `old`, which occurs once, replaced by `new`, contains `sentence`.
#[track_caller]
fn says(text: &str, old: &str, new: &str, sentence: &str) {
    let refused = refusal(&with(text, old, new)).to_string();
    assert!(refused.contains(sentence), "{new}: {refused}");
}

#[test]
fn other_distortion_models_are_refused_by_name() {
    for name in ["plumb_bob", "rational_polynomial", "radtan", "fov", "none"] {
        let sentence = format!("its model is {name}, and a fisheye lens needs `equidistant`");
        says(CAMERA_INFO, "distortion_model: equidistant", &format!("distortion_model: {name}"), &sentence);
    }
    for name in ["omni", "ds", "eucm"] {
        says(
            CAMCHAIN,
            "camera_model: pinhole",
            &format!("camera_model: {name}"),
            &format!("its model is {name}"),
        );
    }
    says(OPENCV_YAML, "image_width: 1280", "xi: 1.2", "omnidirectional (it has `xi`)");
    says(OPENCV_YAML, "image_width: 1280", "fisheye_model: 0", "`fisheye_model` is 0");
    assert!(
        LensFile::parse(&with(OPENCV_YAML, "image_width: 1280", "image_width: 1280\nfisheye_model: 1"))
            .is_ok()
    );
}

#[test]
fn coefficients_of_other_models_are_refused_by_their_number() {
    let four = "[-0.0125, 0.0031, -0.0042, 0.0007]";
    let of = |count: usize| format!("[{}]", vec!["0.01"; count].join(", "));
    says(
        CAMCHAIN,
        four,
        &of(5),
        "it has 5 distortion coefficients (plumb_bob, k1 k2 p1 p2 k3), and OpenCV's fisheye",
    );
    says(CAMCHAIN, four, &of(8), "it has 8 distortion coefficients (rational_polynomial)");
    says(CAMCHAIN, four, &of(3), "it has 3 distortion coefficients, and");
    says(CAMCHAIN, four, &of(0), "it has 0 distortion coefficients, and");
}

#[test]
fn numbers_that_are_none_are_refused_with_their_key() {
    for (word, found) in
        [(".Nan", ".Nan"), (".nan", "NaN"), (".Inf", "inf"), ("1e999", "inf"), ("~", "empty or no number")]
    {
        let sentence = format!("`camera_matrix` is {found}, not a finite number");
        says(OPENCV_YAML, "549.125", word, &sentence);
    }
    says(OPENCV_JSON, "549.125", "\"many\"", "`camera_matrix` is many, not a finite number");
    says(CAMCHAIN, "-0.0125", "1e308", "no ray farther out than the axis");
    says(
        CAMCHAIN,
        "[552.25, 549.125, 641.5, 358.25]",
        "552.25",
        "`intrinsics` is 552.25, not a matrix or a list",
    );
}

#[test]
fn matrices_of_no_camera_are_refused() {
    says(OPENCV_YAML, "0., 0., 1. ]", "0., 0., 2. ]", "not [fx, skew, cx; 0, fy, cy; 0, 0, 1]");
    says(OPENCV_YAML, "0., 549.125", "0.5, 549.125", "not [fx, skew, cx; 0, fy, cy; 0, 0, 1]");
    says(OPENCV_YAML, ", 0., 0., 1. ]", " ]", "not [fx, skew, cx; 0, fy, cy; 0, 0, 1]");
    says(CAMCHAIN, "552.25, ", "", "not [fx, skew, cx; 0, fy, cy; 0, 0, 1]");
    says(
        OPENCV_YAML,
        "camera_matrix",
        "projection",
        "it has no camera matrix: none of the keys camera_matrix, K",
    );
    says(OPENCV_YAML, "distortion_coefficients", "other", "it has no distortion coefficients");
}

#[test]
fn pictures_that_are_mirrored_or_upside_down_are_refused() {
    says(OPENCV_YAML, "552.25", "-552.25", "mirrored, upside down or flat");
    says(OPENCV_YAML, "549.125", "-549.125", "mirrored, upside down or flat");
    says(DSL215, "1.000314", "-1.000314", "mirrored, upside down or flat");
    says(OPENCV_YAML, "549.125", "0.", "fx and fy are 552.25 and 0 pixels, and neither can be 0");
}

#[test]
fn an_axis_outside_the_pictures_is_refused() {
    says(OPENCV_YAML, "641.5", "1641.5", "column 1641.5, row 358.25, outside its pictures of 1280 x 720");
    says(
        DSL215,
        "229.581672 364.430465",
        "529.581672 364.430465",
        "column 364.430465, row 529.581672, outside",
    );
}

/// Places are counted from the middle of the first pixel to that of the last.
#[test]
fn an_axis_in_the_middle_of_an_outer_pixel_is_inside_the_pictures() {
    let centred = |row: &str, column: &str| {
        LensFile::parse(&with(DSL215, "229.581672 364.430465", &format!("{row} {column}")))
    };
    assert_eq!(centred("0", "751").unwrap().centre, (751.0, 0.0));
    assert_eq!(centred("479", "0").unwrap().centre, (0.0, 479.0));
    for (row, column) in [("-0.5", "0"), ("0", "-0.5"), ("479.5", "0"), ("0", "751.5")] {
        let refused = centred(row, column).unwrap_err();
        assert!(matches!(refused, LensContentError::Centre { .. }), "{row} {column}: {refused}");
    }
}

/// What is added is 20 (x + pi / 3) (x + pi / 6): nothing at 30 and 60 degrees from the axis, where x is -pi / 3 and -pi / 6,
/// and 11 pixels at 90 degrees, where x is 0. Pictures of 480 rows show up to 240 pixels from the axis, and of these angles
/// only 30 degrees is within that.
#[test]
fn ocamcalib_s_inverse_polynomial_is_looked_at_inside_the_pictures_alone() {
    let poor = with(DSL215, "388.557547 220.910537 -10.127377", "399.523774 252.326464 9.872623");
    says(&poor, "480 752", "2000 2000", "off the direct one at 90 degrees");
    assert!(LensFile::parse(&poor).is_ok());
}

#[test]
fn image_sizes_that_cannot_be_are_refused() {
    for size in ["[1280]", "[1280.5, 720]", "[0, 720]", "[1e9, 720]", "[-1280, 720]"] {
        says(CAMCHAIN, "[1280, 720]", size, "not two whole numbers from 1 to 65535");
    }
    says(DSL215, "480 752", "480 0", "not two whole numbers");
}

/// Taken for none at all, it would let the lens through unscaled for frames of any size.
#[test]
fn half_an_image_size_is_refused() {
    let rows = "it has no image height: none of the keys image_height, height; add one";
    says(OPENCV_YAML, "image_height: 720\n", "", rows);
    says(CAMERA_INFO, "image_height: 720", "image_hight: 720", rows);
    let columns = "it has no image width: none of the keys image_width, width; add one";
    says(OPENCV_YAML, "image_width: 1280\n", "", columns);
}

#[test]
fn several_cameras_are_refused() {
    let second = CAMCHAIN.replace("cam0", "cam1");
    let refused = refusal(&format!("{CAMCHAIN}{second}"));
    assert_eq!(refused, LensContentError::Cameras("cam0, cam1".to_owned()));
}

#[test]
fn a_matrix_and_four_numbers_must_say_the_same() {
    let matrix = |cx: f64| format!("[552.25, 0, {cx}, 0, 549.125, 358.25, 0, 0, 1]");
    let both = |cx: f64| format!("{CAMCHAIN}  camera_matrix: {}\n", matrix(cx));
    let four = "[552.25, 549.125, 641.5, 358.25]";
    let nine = |cx: f64| with(&both(641.5), four, &matrix(cx));
    for same in [both(641.5), nine(641.5)] {
        assert_eq!(LensFile::parse(&same), LensFile::parse(CAMCHAIN));
    }
    let (first, second) = ("camera_matrix".to_owned(), "intrinsics".to_owned());
    let twice = LensContentError::Twice { first, second };
    for other in [both(600.0), nine(600.0), with(&both(641.5), four, "[552.25, 641.5, 358.25]")] {
        assert_eq!(refusal(&other), twice);
    }
}

#[test]
fn files_of_other_kinds_are_refused() {
    assert_eq!(refusal("<?xml version=\"1.0\"?>\n<opencv_storage>\n"), LensContentError::Xml);
    assert_eq!(refusal(""), LensContentError::Empty);
    assert_eq!(refusal("\n \n# nothing\n"), LensContentError::Empty);
    assert_eq!(refusal("[1, 2]"), LensContentError::NoKeys);
    assert_eq!(refusal("lens"), LensContentError::NoKeys);
    assert!(matches!(refusal("{}"), LensContentError::Missing { .. }));
}

#[test]
fn what_breaks_off_is_refused_with_its_line() {
    let half = |text: &str| refusal(&text[..text.len() / 2]);
    assert!(matches!(half(OPENCV_JSON), LensContentError::Syntax { .. }), "{:?}", half(OPENCV_JSON));
    assert!(matches!(half(OPENCV_YAML), LensContentError::Missing { .. } | LensContentError::Syntax { .. }));
    let end = DSL215.find("\n#center").unwrap();
    assert_eq!(refusal(&DSL215[..end]), LensContentError::Lines { found: 2 });
    says(DSL215, "21.586002 3.593416", "", "line 7: 9 numbers instead of 11 for the inverse polynomial");
    says(DSL215, " 6.601777e-09", "", "line 3: 5 numbers instead of 6 for the direct polynomial");
    says(DSL215, "229.581672 ", "", "line 11: 1 numbers instead of 2 for the centre's row and column");
    says(DSL215, "-0.000158", "", "line 15: 2 numbers instead of 3 for the affine parameters");
    assert!(matches!(
        refusal(
            "{
\"K\": 1]"
        ),
        LensContentError::Syntax { line: 2, .. }
    ));
}

#[test]
fn ocamcalib_s_numbers_are_looked_at() {
    for word in ["nan", "inf", "1e999", "0x10", "row"] {
        says(DSL215, "1.626945e-03", word, &format!("line 3: {word:?} is no finite number"));
    }
    says(DSL215, "-2.595395e+02", "2.595395e+02", "begins with 259.5395, and OCamCalib's begin below zero");
    says(DSL215, "388.557547", "488.557547", "the inverse polynomial is");
    says(DSL215, "388.557547 220.910537", "220.910537 388.557547", "off the direct one at 30 degrees");
    assert_eq!(refusal("1 0\n229 364\n1 0 0\n480 752\n"), LensContentError::Sign(0.0));
}

#[test]
fn ocamcalib_s_counts_are_counts() {
    for (count, found) in [("2.5", "2.5"), ("0", "0"), ("1e30", "1e30"), ("-5", "-5"), ("65", "65")] {
        let text = format!("{count} -259 1 2\n229 364\n1 0 0\n480 752\n");
        let sentence = format!(
            "line 1: the direct polynomial begins with {found}, in place of the number of coefficients that follow, from 1 to 64"
        );
        let refused = refusal(&text).to_string();
        assert!(refused.contains(&sentence), "{count}: {refused}");
    }
    let many = format!("10000 -259{}\n229 364\n1 0 0\n480 752\n", " 0".repeat(9_999));
    assert!(matches!(refusal(&many), LensContentError::Count { line: 1, .. }));
}

#[test]
fn too_many_lines_do_not_break_off() {
    let refused = refusal(&format!("{DSL215}\n1 2 3\n")).to_string();
    assert!(refused.starts_with("it has 6 lines of numbers instead of 5 ("), "{refused}");
}

#[test]
fn ocamcalib_s_file_is_known_behind_comments_of_matlab() {
    for (old, new) in [("#polynomial", "%polynomial"), ("", "% made by export_data.m\n")] {
        assert_eq!(LensFile::parse(&DSL215.replacen(old, new, 1)), LensFile::parse(DSL215), "{new}");
    }
    assert!(matches!(refusal("% nothing\n"), LensContentError::Empty));
}

#[test]
fn hostile_yaml_is_refused_and_does_no_harm() {
    for nested in ["[", "{a: ", "- ", "? ", "- ? "] {
        let refused = refusal(&nested.repeat(100_000));
        assert!(matches!(refused, LensContentError::Syntax { line: 1, .. }), "{nested}: {refused}");
    }
    let flat = refusal(&format!("cam0:\n  a: {}1{}\n", "[".repeat(30), "]".repeat(30)));
    assert!(matches!(flat, LensContentError::Missing { .. }), "{flat}");
    let deep = refusal(&format!("cam0:\n  a: {}1{}\n", "[".repeat(31), "]".repeat(31))).to_string();
    assert!(
        deep.contains("line 2, column 36: lists and groups lie deeper than 32 in each other; mend it"),
        "{deep}"
    );
    let longer: String =
        (1..500).map(|level| format!("a{level}: &a{level} [[[*a{}]]]\n", level - 1)).collect();
    assert!(matches!(refusal(&format!("a0: &a0 x\n{longer}")), LensContentError::Syntax { .. }));
    let doubled: String =
        (1..40).map(|level| format!("a{level}: &a{level} [*a{0}, *a{0}]\n", level - 1)).collect();
    assert!(matches!(refusal(&format!("a0: &a0 x\n{doubled}")), LensContentError::Syntax { .. }));
    let twice = format!("{OPENCV_YAML}image_width: 640\n");
    assert!(matches!(refusal(&twice), LensContentError::Syntax { .. }));
}

#[test]
fn a_file_that_cannot_be_read_is_named() {
    let missing = LensFile::read(Path::new("/nonexistent/lens.yml")).unwrap_err();
    assert!(matches!(&missing, LensFileError::Io { .. }));
    assert!(missing.to_string().contains("/nonexistent/lens.yml"), "{missing}");
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("calib.mat");
    std::fs::write(&path, b"MATLAB 5.0 \xff\xfe").unwrap();
    assert!(matches!(LensFile::read(&path), Err(LensFileError::Io { .. })));
    std::fs::write(&path, "<opencv_storage/>").unwrap();
    let refused = LensFile::read(&path).unwrap_err();
    assert!(matches!(refused, LensFileError::Content { source: LensContentError::Xml, .. }));
}

#[test]
fn a_file_of_two_lenses_is_taken_for_neither() {
    let other = CAMERA_INFO.replace("552.25", "900.5");
    let two = format!("{CAMERA_INFO}\n---\n{other}");
    assert_eq!(refusal(&two), LensContentError::Cameras("2 documents".to_owned()));
    // `rostopic echo` ends each message with this line, and repeats the same camera again and again.
    for again in [format!("{CAMERA_INFO}\n---\n"), format!("{CAMERA_INFO}\n---\n{CAMERA_INFO}\n---\n")] {
        assert_eq!(LensFile::parse(&again), LensFile::parse(CAMERA_INFO));
    }
}

#[test]
fn keys_that_mean_the_same_must_say_the_same() {
    for (more, first, second) in [
        ("K: [1, 0, 2, 0, 3, 4, 0, 0, 1]", "camera_matrix", "K"),
        ("D: [0.5, 0, 0, 0]", "distortion_coefficients", "D"),
        ("image_size: [1, 2]", "image_size", "image_width"),
        ("width: 1", "image_width", "width"),
    ] {
        let both = format!("distortion_model: equidistant\n{more}");
        let sentence = format!("`{second}` says again what `{first}` says");
        says(CAMERA_INFO, "distortion_model: equidistant", &both, &sentence);
    }
    let agrees = "distortion_model: equidistant\nimage_size: [1280, 720]";
    assert_eq!(
        LensFile::parse(&with(CAMERA_INFO, "distortion_model: equidistant", agrees)),
        LensFile::parse(CAMERA_INFO)
    );
}

#[test]
fn a_key_that_is_there_in_two_spellings_is_refused() {
    says(
        CAMERA_INFO,
        "distortion_model: equidistant",
        "distortion_model: equidistant\nDistortionModel: equidistant",
        "`DistortionModel` says again what `distortion_model` says; leave one of them",
    );
}
