//! Lens files whose numbers fit no frame: the message names the file, and says what can be done to a file.

use halfrow_tests::program::Folder;

use crate::refused;

/// A lens file of OpenCV's fisheye model, for pictures of `size`, with these focal lengths and k1.
fn calibration(folder: &Folder, [fx, fy, k1]: [&str; 3], size: [u32; 2]) {
    let [width, height] = size;
    let (x, y) = ((f64::from(width) - 1.0) / 2.0, (f64::from(height) - 1.0) / 2.0);
    folder.write(
        "lens.json",
        format!(
            "{{\"K\":[[{fx},0,{x}],[0,{fy},{y}],[0,0,1]],\"D\":[{k1},0,0,0],\"width\":{width},\"height\":{height}}}"
        ),
    );
}

#[test]
fn a_radius_that_cannot_be_is_the_lens_file_s() {
    let folder = Folder::new();
    let remedy = "outside 1 to 1e9; check the focal length and the coefficients, or calibrate the lens again";
    let unfit = "the lens file lens.json cannot be used for these frames";
    for numbers in [["1e300", "40", "0"], ["1e-300", "40", "0"], ["40", "40", "1e20"]] {
        calibration(&folder, numbers, [64, 17]);
        for call in [&["lens"][..], &["tables", "-o", "x.json"]] {
            let call = [call, &["--lens", "lens.json"]].concat();
            refused(&folder, &call, unfit);
            refused(&folder, &call, remedy);
        }
    }
    folder.write("ocam.txt", "5 -259 0 1e3 0 0\n240 376\n1 0 0\n480 752\n");
    refused(&folder, &["lens", "--lens", "ocam.txt"], "the lens file ocam.txt cannot be used");
}

#[test]
fn a_lens_without_focal_length_is_not_said_to_be_mirrored() {
    let folder = Folder::new();
    calibration(&folder, ["0", "40", "0"], [64, 17]);
    let sentence = "the lens file lens.json cannot be used: its focal lengths fx and fy are 0 and 40 pixels, and neither can be 0";
    refused(&folder, &["lens", "--lens", "lens.json"], sentence);
}

#[test]
fn the_file_is_named_unless_the_call_is_wrong() {
    let folder = Folder::new();
    let unfit = "the lens file lens.json cannot be used for these frames";
    calibration(&folder, ["40", "40", "0"], [1, 1]);
    refused(&folder, &["lens", "--lens", "lens.json"], unfit);
    calibration(&folder, ["20", "20", "-2"], [64, 64]);
    refused(&folder, &["lens", "--lens", "lens.json"], unfit);
    refused(&folder, &["lens", "--lens", "lens.json"], "turns back");
    calibration(&folder, ["40", "40", "0"], [64, 17]);
    for (more, sentence) in [
        (["--width", "65"], "a width of 65"),
        (["--field-of-view", "0"], "a field of view of 0 degrees"),
        (["--centre-x", "1e9"], "the optical centre"),
    ] {
        let ended = folder.halfrow([&["lens", "--lens", "lens.json"], &more[..]].concat());
        assert_eq!(ended.code, Some(2), "{more:?}: {}", ended.stderr);
        assert!(
            ended.stderr.contains(sentence) && !ended.stderr.contains("lens.json"),
            "{more:?}: {}",
            ended.stderr
        );
    }
}

#[test]
fn a_lens_that_no_tables_can_follow_is_the_lens_file_s() {
    let folder = Folder::new();
    let unfit = "the lens file lens.txt cannot be used for these frames: ";
    let lens = include_str!("../../../host/judge/tests/lenses/files/dsl215.txt");
    folder.write("lens.txt", lens.replacen("1.000314 -0.000012", "1.000314 1e308", 1));
    let exact = ["tables", "-o", "x.json", "--projection", "exact", "--lens", "lens.txt"];
    refused(&folder, &exact, &format!("{unfit}row 0 would not lie in the frame; "));
    // A skew that is finite until it is scaled.
    calibration(&folder, ["40", "40", "0"], [64, 17]);
    folder.write("lens.json", folder.text("lens.json").replacen("[40,0,", "[40,1e308,", 1));
    let scaled = ["tables", "-o", "x.json", "--lens", "lens.json", "--lens-pitch", "6", "--pixel-pitch", "3"];
    refused(
        &folder,
        &scaled,
        "the lens file lens.json cannot be used for these frames: a coefficient of inf",
    );
}

/// A lens so small that a grid is worse than fitted rows: what to use instead is told to whoever asked for the grid.
#[test]
fn only_who_asked_for_a_grid_is_told_not_to_use_it() {
    let folder = Folder::new();
    let told = |more: &[&'static str]| {
        let ended = folder.halfrow(["lens", "--radius", "1"].iter().chain(more).copied()).succeeded();
        let warning = ended.stdout.lines().find(|line| line.contains("farther off here")).map(str::to_owned);
        warning.unwrap_or_else(|| panic!("{}", ended.stdout))
    };
    for more in [&[][..], &["--rows", "fitted"]] {
        assert!(told(more).ends_with("that a board takes was found."), "{}", told(more));
    }
    let asked = told(&["--projection", "exact"]);
    assert!(asked.ends_with("so use --rows fitted in place of --projection exact."), "{asked}");
}
