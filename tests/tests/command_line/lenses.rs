//! `--lens`: lens files from calibration programs, on every command that makes tables, and `lens` itself.
//!
//! Expected numbers were computed with NumPy 2.4.6 and SciPy 1.17.1 (`linprog`) from the definitions.

use std::path::PathBuf;

use halfrow_tests::program::Folder;
use serde_json::Value;

use crate::refused;

/// The path of a lens file of the lens reader's own tests.
fn lens(name: &str) -> String {
    let files = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../host/judge/tests/lenses/files");
    files.join(name).display().to_string()
}

/// A folder with a measured lens in it, for pictures of 752 x 480.
fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("dsl215.txt", std::fs::read(lens("dsl215.txt")).unwrap());
    folder
}

fn json(folder: &Folder, arguments: &[&str]) -> Value {
    let ended = folder.halfrow(arguments.iter().copied());
    assert_eq!(ended.code, Some(0), "{arguments:?}: {}", ended.stderr);
    ended.json()
}

#[track_caller]
fn assert_near(found: &Value, expected: f64, tolerance: f64) {
    let found = found.as_f64().unwrap();
    assert!((found - expected).abs() <= tolerance, "{found} is not {expected}");
}

#[test]
fn frames_have_no_row_factors() {
    refused(&Folder::new(), &["frames", "-o", "frames", "--rows", "fitted"], "--rows says how tables");
    refused(&Folder::new(), &["frames", "-o", "frames", "--projection", "exact"], "--projection says how");
}

#[test]
fn a_board_passes_with_the_rows_of_every_lens_file() {
    let folder = folder();
    for (file, width, height) in [
        ("dsl215.txt", "188", "120"),
        ("opencv-4.10.yml", "128", "72"),
        ("opencv-4.10.json", "256", "144"),
        ("camera_info.yaml", "128", "72"),
        ("camchain.yaml", "128", "72"),
    ] {
        let path = lens(file);
        let call =
            ["verify", "--json", "--board", "mock", "--lens", &path, "--width", width, "--height", height];
        let said = json(&folder, &call);
        assert_eq!(said["verdict"], "PASS", "{file}: {}", said["headline"]);
        let source = said["tables"]["source"].as_str().unwrap();
        assert!(source.contains(file) && source.contains("(fitted rows), hermite kernel"), "{source}");
        assert_eq!(said["run"]["files"][0]["path"], path.as_str());
    }
}

#[test]
fn the_table_file_holds_the_fitted_rows_and_the_lens_s_centre() {
    let folder = folder();
    let made = folder.halfrow(["tables", "--lens", "dsl215.txt", "-o", "dsl215.json"]).succeeded();
    assert!(
        made.stdout.contains("OCamCalib lens dsl215.txt, R = 388.558 pixels (fitted rows)"),
        "{}",
        made.stdout
    );
    let file = folder.json("dsl215.json");
    assert_eq!((&file["width"], &file["height"], &file["centre2"]), (&752.into(), &480.into(), &729.into()));
    for (row, factor) in [(0, 13_125_603.7), (150, 16_374_261.0), (479, 12_368_952.0)] {
        assert_near(&file["step"][row], factor, 2.0);
    }
    let call = ["tables", "--lens", "dsl215.txt", "--rows", "equation-9", "-o", "eq9.json"];
    folder.halfrow(call).succeeded();
    let file = folder.json("eq9.json");
    assert_near(&file["step"][0], 13_537_752.0, 1.0);
}

#[test]
fn the_paper_s_lens_keeps_eq_9_unless_fitted_rows_are_asked_for() {
    let folder = Folder::new();
    let row_factors = |name: &str, lens: &[&str]| {
        let call = ["tables", "-o", name].into_iter().chain(lens.iter().copied());
        folder.halfrow(call).succeeded();
        serde_json::from_slice::<Value>(&folder.read(name)).unwrap()["step"].clone()
    };
    let plain = row_factors("plain.json", &["--radius", "1106.697"]);
    assert_eq!(plain[0], 14_648_698);
    assert_eq!(row_factors("named.json", &["--lens", "equidistant:1106.697"]), plain);
    assert_near(
        &row_factors("fitted.json", &["--radius", "1106.697", "--rows", "fitted"])[0],
        14_124_828.2,
        2.0,
    );
}

#[test]
fn the_error_that_is_left_is_told_and_drawn() {
    let folder = folder();
    let said = json(&folder, &["lens", "--lens", "dsl215.txt", "--map", "left.png", "--json"]);
    assert_near(&said["lens"]["radius_px"], 388.557_796_771, 1e-9);
    assert_near(&said["centre"]["row"], 229.581_672, 0.0);
    assert_eq!((&said["rows"], &said["samples"]), (&"fitted".into(), &335_074.into()));
    let left = &said["residual_px"];
    for (what, mean, max) in [
        (&left["horizontal"]["equation-9"], 3.746_090_454, 22.524_353_4),
        (&left["horizontal"]["fitted"], 2.264_924_774, 14.724_120_0),
        (&left["vertical"], 11.635_555_722, 69.325_111_7),
    ] {
        assert_near(&what["mean"], mean, 1e-6);
        assert_near(&what["max"], max, 2e-5);
    }
    assert_near(&said["map"]["brightest_px"], 14.724_12, 1e-4);
    let picture = folder.read("left.png");
    assert_eq!(picture[..8], *b"\x89PNG\r\n\x1a\n");
    assert_eq!(picture[16..24], [0, 0, 2, 240, 0, 0, 1, 224]);
    let text =
        folder.halfrow(["lens", "--lens", "dsl215.txt", "--map", "other.png", "--rows", "equation-9"]).stdout;
    let fitted = text.lines().find(|line| line.trim_start().starts_with("fitted rows")).unwrap();
    assert_eq!(fitted.split_whitespace().collect::<Vec<_>>()[2..4], ["2.2649", "14.7241"], "{text}");
    assert!(text.ends_with("wrote other.png, from 0 (dark) to 22.524 px (bright)\n"), "{text}");
    refused_map(&folder);
}

fn refused_map(folder: &Folder) {
    let before = folder.read("left.png");
    let ended = folder.halfrow(["lens", "--lens", "dsl215.txt", "--map", "left.png"]);
    assert!(ended.code == Some(2) && ended.stderr.contains("--overwrite"), "{}", ended.stderr);
    assert!(folder.read("left.png") == before);
    refused(folder, &["lens", "--lens", "dsl215.txt", "--map", "left.txt"], "left.txt must be a PNG");
}

/// The same lens on the paper's sensor, whose pixels measure 2.2 µm instead of 6.
#[test]
fn a_lens_moves_to_another_sensor_by_its_pixel_pitch() {
    let call = [
        "lens",
        "--json",
        "--lens",
        "dsl215.txt",
        "--lens-pitch",
        "6",
        "--width",
        "1920",
        "--height",
        "1080",
    ];
    let said = json(&folder(), &call);
    assert_near(&said["lens"]["radius_px"], 1_059.703_082_1, 1e-6);
    assert_eq!(said["centre"]["centre2"], 1919);
    let horizontal = &said["residual_px"]["horizontal"];
    assert_near(&horizontal["equation-9"]["max"], 33.377_213_8, 1e-4);
    assert_near(&horizontal["fitted"]["max"], 16.350_686_5, 1e-4);
    assert_near(&horizontal["fitted"]["mean"], 3.111_914_4, 1e-5);
}

#[test]
fn a_call_that_names_two_lenses_or_none_that_fits_is_refused() {
    let folder = folder();
    folder.halfrow(["tables", "--radius", "1106.697", "-o", "made.json"]).succeeded();
    let tables = |more: &[&str], sentence: &str| {
        let call: Vec<_> = ["tables", "-o", "x.json"].into_iter().chain(more.iter().copied()).collect();
        refused(&folder, &call, sentence);
    };
    let lens = ["--lens", "dsl215.txt"];
    tables(&[&lens[..], &["--width", "1920", "--height", "1080"]].concat(), "pictures of 752 x 480");
    tables(&[&lens[..], &["--radius", "400"]].concat(), "cannot be used with");
    tables(&[&lens[..], &["--focal-length", "2"]].concat(), "cannot be used with");
    for lens in [&[][..], &["--lens", "equidistant:400"], &["--radius", "400"], &["--focal-length", "2"]] {
        tables(&[lens, &["--lens-pitch", "6"]].concat(), "--lens-pitch goes with a lens file");
    }
    tables(&["--lens", "equidistant:wide"], "takes the radius");
    tables(&["--lens", "equidistant:0"], "radius");
    tables(&["--lens", "nowhere.yml"], "cannot read the lens file nowhere.yml");
    tables(&[&lens[..], &["--lens-pitch", "0"]].concat(), "a pixel pitch of 0 um is not a finite number");
    tables(&[&lens[..], &["--field-of-view", "0"]].concat(), "field of view");
    tables(&[&lens[..], &["--centre-x", "-1"]].concat(), "optical centre");
    for more in ["--pixel-pitch", "--field-of-view"] {
        tables(
            &["--lens", "equidistant:400", more, "170"],
            "cannot be used with --pixel-pitch or --field-of-view",
        );
    }
    tables(
        &[&lens[..], &["--pixel-pitch", "9"]].concat(),
        "--pixel-pitch does nothing with a lens file unless --lens-pitch",
    );
    let both = |option: [&str; 2]| {
        let sentence = format!("{} cannot be used together with --tables", option[0]);
        for call in [&["verify"][..], &["correct", "builtin:noise", "--model", "-o", "x.pgm"]] {
            let call: Vec<_> = call.iter().copied().chain(option).chain(["--tables", "made.json"]).collect();
            refused(&folder, &call, &sentence);
        }
    };
    both(lens);
    both(["--rows", "fitted"]);
}

/// A lens on pixels twice as high as wide: in widths of a pixel |y| is 1, 3, … 99, and R = 80/π · π/2 = 40, so 30 rows on either
/// side are outside. With R in heights of a pixel it would be 10.
#[test]
fn rows_outside_the_image_circle_are_those_of_the_lens_file() {
    let folder = Folder::new();
    folder.write(
        "high.yaml",
        "cam0:\n  camera_model: pinhole\n  distortion_model: equidistant\n  distortion_coeffs: [0, 0, 0, 0]\n  \
         intrinsics: [25.464790895, 12.732395447, 31.5, 49.5]\n  resolution: [64, 100]\n",
    );
    let made = folder.halfrow(["tables", "--lens", "high.yaml", "-o", "high.json"]);
    assert!(made.stdout.contains("60 rows outside the image circle"), "{}{}", made.stdout, made.stderr);
    let outside = |more: &[&str]| {
        let call: Vec<_> = ["verify", "--json"].into_iter().chain(more.iter().copied()).collect();
        json(&folder, &call)["tables"]["rows_outside_circle"].clone()
    };
    assert_eq!(outside(&["--lens", "high.yaml", "--record", "run.rec"]), 60);
    assert_eq!(outside(&["--board", "replay:run.rec"]), 60);
    assert_eq!(outside(&["--tables", "high.json"]), Value::Null);
}

/// Writes a calibration file with additional keys `more`, of OpenCV's fisheye model with f = `focal`.
fn calibration(folder: &Folder, focal: &str, more: &str) {
    let matrix = format!("\"K\":[[{focal},0,31.5],[0,{focal},8],[0,0,1]],\"D\":[0,0,0,0]");
    folder.write("lens.json", format!("{{{matrix}{more}}}"));
}

#[test]
fn a_calibration_without_a_picture_size_needs_one() {
    let folder = Folder::new();
    calibration(&folder, "40", "");
    let sentence = "lens.json does not say how large its pictures are; add image_width and image_height";
    let lens = ["--lens", "lens.json"];
    for call in [
        &["lens"][..],
        &["tables", "-o", "x.json"],
        &["verify", "-q"],
        &["correct", "builtin:grey", "--model", "-o", "out.pgm"],
        &["lens", "--width", "64"],
        &["lens", "--height", "17"],
    ] {
        refused(&folder, &[call, &lens].concat(), sentence);
    }
    for more in [&["--width", "64", "--height", "17"][..], &["--lens-pitch", "66"]] {
        folder.halfrow([&["lens"], &lens[..], more].concat()).succeeded();
    }
    // ROS's drivers write 0 x 0 when they do not know the size.
    calibration(&folder, "40", ",\"width\":0,\"height\":0");
    refused(&folder, &["lens", "--lens", "lens.json"], sentence);
}

/// By hand: 4000 x 3000 and 2592 x 1944 are 4 : 3. 541 is prime, so no smaller picture has the shape of 961 x 541.
#[test]
fn a_calibration_larger_than_frames_names_the_largest_of_its_shape() {
    let folder = Folder::new();
    calibration(&folder, "1600", ",\"DIM\":[4000,3000]");
    let sentence = "pictures of 4000 x 3000, and no frame has that size; name the size of the frames (--width, --height), at \
        most 2592 x 1944 in this shape";
    refused(&folder, &["lens", "--lens", "lens.json"], sentence);
    calibration(&folder, "400", ",\"DIM\":[961,541]");
    refused(&folder, &["lens", "--lens", "lens.json"], "a width of 961 columns is not an even number");
}

/// f is 1000 pixels: 90 degrees are at 1000 · π/2, and 100 degrees at 1000 · 10π/18.
#[test]
fn a_radius_of_another_angle_than_90_degrees_says_so() {
    let folder = Folder::new();
    let said = |angle: &str| {
        folder.halfrow(["lens", "--focal-length", "3", "--pixel-pitch", "3", "--field-of-view", angle]).stdout
    };
    assert!(said("180").contains("equidistant lens, R = 1570.796 pixels\n"), "{}", said("180"));
    assert!(
        said("200").contains("equidistant lens, R = 1745.329 pixels at 100 degrees\n"),
        "{}",
        said("200")
    );
}

/// R = f · π/2, so f = 1 reaches one row above and below the axis at row 8.
#[test]
fn a_lens_that_misses_the_frame_is_refused_or_told() {
    let folder = Folder::new();
    let size = ",\"width\":64,\"height\":17";
    calibration(&folder, "1", size);
    for call in [&["tables", "-o", "made.json"][..], &["lens"], &["verify", "-q"]] {
        let ended = folder.halfrow([call, &["--lens", "lens.json"]].concat()).succeeded();
        let said = "14 of 17 rows lie outside the image circle, whose radius is 1.571 pixels around row 8.0";
        assert!(ended.stderr.contains(said), "{}", ended.stderr);
    }
    let sentence = "so nothing would be corrected; check the lens, its centre and the size of the frames";
    for call in [&["tables", "-o", "x.json"][..], &["lens"], &["verify", "-q"]] {
        refused(&folder, &[call, &["--lens", "lens.json", "--centre-y", "1000"]].concat(), sentence);
    }
    let far = ["verify", "-q", "--width", "128", "--height", "16", "--radius", "20", "--centre-y"];
    refused(&folder, &[&far[..], &["1000"]].concat(), "16 of 16 rows lie outside the image circle");
    refused(&folder, &[&far[..], &["1e308"]].concat(), "the optical centre is at row 1e308, beyond 1e9");
    calibration(&folder, "40", size);
    let ended = folder.halfrow(["lens", "--lens", "lens.json"]);
    assert_eq!((ended.code, ended.stderr.as_str()), (Some(0), ""));
}

#[test]
fn long_numbers_are_told_in_short() {
    let folder = Folder::new();
    for (option, sentence) in [
        (["--radius", "1e300"], "an image radius of 1e300 pixels is outside"),
        (["--pixel-pitch", "1e308"], "e-305 pixels is outside 1 to 1e9"),
        (["--focal-length", "-1e300"], "a focal length of -1e300 mm"),
        (["--field-of-view", "1e200"], "a field of view of 1e200 degrees"),
        (["--centre-x", "1e300"], "at column 1e300, outside"),
    ] {
        let option = format!("{}={}", option[0], option[1]);
        let ended = folder.halfrow(["tables", "-o", "x.json", &option]);
        assert_eq!(ended.code, Some(2), "{}", ended.stderr);
        assert!(ended.stderr.contains(sentence), "{option}: {}", ended.stderr);
        assert!(ended.stderr.len() < 250, "{option}: {}", ended.stderr);
    }
}

/// The window of taps must exist: the model says for which row it does not.
#[test]
fn a_centre_that_no_board_can_do_is_refused_by_the_tables() {
    let (folder, path) = (Folder::new(), lens("opencv-4.10.yml"));
    let size = ["--width", "128", "--height", "72", "--centre-x", "127", "--centre-y", "71"];
    let call: Vec<_> = ["tables", "--lens", &path, "-o", "x.json"].into_iter().chain(size).collect();
    refused(&folder, &call, "columns later than half a row of delay brings them");
    let said =
        json(&folder, &["lens", "--json", "--lens", &path].into_iter().chain(size).collect::<Vec<_>>());
    assert!(said["illegal"].as_str().unwrap().contains("needs samples"), "{}", said["illegal"]);
}

/// The verticals in the picture: their degrees, and where the lens images each of them on the horizon, in pixels from its axis.
const VERTICALS: [(f64, f64); 4] = [(10.0, 45.2), (30.0, 134.8), (50.0, 223.7), (70.0, 309.2)];

/// How far around its place on the horizon a vertical is searched for, in pixels: less than half of the way to the next.
const REACH: f64 = 40.0;

/// Vertical lines in the scene as the lens images them: OCamCalib's cam2world, written out.
fn photograph() -> Vec<u8> {
    let mut picture = b"P5\n752 480\n4095\n".to_vec();
    for row in 0..480 {
        for column in 0..752 {
            let (down, right) = (f64::from(row) - 229.581_672, f64::from(column) - 364.430_465);
            let area = 1.000_314 - 0.000_012 * 0.000_158;
            let x = (down + 0.000_012 * right) / area;
            let y = (1.000_314 * right + 0.000_158 * down) / area;
            let r = x.hypot(y);
            let ahead = 259.5395 - r * r * (1.626945e-3 + r * (-2.328091e-6 + r * 6.601777e-9));
            let longitude = y.atan2(ahead).to_degrees();
            let light = |(degrees, _): (f64, f64)| (-((longitude.abs() - degrees) / 0.8).powi(2)).exp();
            let sample = 200.0 + 3500.0 * VERTICALS.into_iter().map(light).sum::<f64>();
            picture.extend((sample as u16).to_be_bytes());
        }
    }
    picture
}

/// The root mean square of the deviations of a picture's verticals from straight lines, in pixels.
fn bend(picture: &[u8]) -> f64 {
    let samples = &picture[picture.len() - 2 * 752 * 480..];
    let light = |row: usize, column: usize| {
        let place = 2 * (752 * row + column);
        f64::from(u16::from_be_bytes([samples[place], samples[place + 1]])) - 200.0
    };
    let rows = || (20..460).step_by(20);
    let middle_of_line = |row, place: f64| {
        let columns = (place - REACH).max(0.0) as usize..=((place + REACH) as usize).min(751);
        let (sum, moment) = columns.fold((0.0, 0.0), |(sum, moment), column| {
            let light = light(row, column).max(0.0);
            (sum + light, moment + light * column as f64)
        });
        moment / sum
    };
    let variance = |place: f64| {
        let columns: Vec<f64> = rows().map(|row| middle_of_line(row, place)).collect();
        let mean = columns.iter().sum::<f64>() / columns.len() as f64;
        columns.iter().map(|column| (column - mean).powi(2)).sum::<f64>() / columns.len() as f64
    };
    let places = VERTICALS.iter().flat_map(|(_, r)| [364.43 - r, 364.43 + r]);
    (places.map(variance).sum::<f64>() / (2 * VERTICALS.len()) as f64).sqrt()
}

/// From the lines' positions in NumPy and the factors of `linprog`: 3.447 px with Eq. 9 and 2.070 px with fitted rows.
#[test]
fn verticals_photographed_by_the_lens_come_out_straighter_with_fitted_rows() {
    let folder = folder();
    folder.write("lines.pgm", photograph());
    let corrected = |rows: &str| {
        let name = format!("{rows}.pgm");
        let call = ["correct", "lines.pgm", "--model", "--lens", "dsl215.txt", "--rows", rows, "-o", &name];
        folder.halfrow(call).succeeded();
        bend(&folder.read(&name))
    };
    let (fitted, equation_9) = (corrected("fitted"), corrected("equation-9"));
    assert!((equation_9 - 3.447).abs() < 0.05, "{equation_9} px by Eq. 9");
    assert!((fitted - 2.070).abs() < 0.05, "{fitted} px by fitted rows");
}
