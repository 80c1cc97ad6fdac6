//! What the fitted kernels gain over Hermite on the photographs of Table 1, and fitting one from the command line.
//!
//! The photographs are those in the folder `HALFROW_IMAGES`, or in `../shared/kodak` next to the project.

// clippy.toml allows it inside #[test] functions, but not in the functions that several tests call.
#![allow(clippy::unwrap_used)]

use std::process::Command;

use halfrow::frames::preview::RgbImage;
use halfrow::frames::write_rgb;
use halfrow_tests::photographs;
use halfrow_tests::program::{Ended, Folder, error_sentence};
use serde_json::Value;

/// Gains in dB, each as mean, least and most, computed with NumPy 2: with Table 1's warp, with a band-limited one, with that and
/// noise of 2, 5 and 10 levels (NumPy draws other noise), and with that and demosaicking.
const GAINS: [(&str, [[f64; 3]; 6]); 2] = [
    (
        "sharp5",
        [
            [1.6487, 1.0920, 2.1215],
            [1.1789, 0.3687, 1.6116],
            [0.7902, -0.1645, 1.5320],
            [0.0690, -0.6869, 1.1956],
            [-0.4740, -0.8595, 0.5125],
            [0.2098, 0.0063, 0.3616],
        ],
    ),
    (
        "sharp7",
        [
            [2.6114, 1.2598, 3.4496],
            [2.5751, 0.9472, 3.3969],
            [1.8697, 0.2126, 2.9837],
            [0.6762, -0.4871, 2.3193],
            [-0.1567, -0.7085, 1.2112],
            [0.2065, 0.0162, 0.4384],
        ],
    ),
];

#[test]
#[ignore = "a minute long; scripts/soak runs it"]
fn fitted_kernels_gain_on_the_photographs_of_table_1() {
    let first = photographs::paths().into_iter().next();
    let first = first.expect("no photographs: set HALFROW_IMAGES to a folder with PNG files");
    let images = first.parent().unwrap().to_str().unwrap();
    for (name, expected) in GAINS {
        let call = ["kernel", "measure", "--json", "-q", "--kernel", name, "--images", images];
        let ended = Folder::new().halfrow(call).succeeded();
        let report: Value = serde_json::from_str(&ended.stdout).unwrap();
        let found = report["gains_db"].as_array().unwrap();
        assert_eq!(found.len(), expected.len(), "{name}");
        for (gains, expected) in found.iter().zip(expected) {
            for (key, expected) in ["mean", "least", "most"].into_iter().zip(expected) {
                let found = gains["gain"][key].as_f64().unwrap();
                let is_drawn = gains["condition"].as_str().unwrap().contains("noise");
                let tolerance = if is_drawn { 0.02 } else { 1e-3 };
                assert!((found - expected).abs() < tolerance, "{name}: {gains}");
            }
        }
    }
}

#[test]
fn a_folder_without_photographs_is_refused() {
    let folder = Folder::new();
    let call = ["kernel", "train", "--images", ".", "-o", "mine.json"];
    let ended = folder.halfrow(call);
    assert_eq!(ended.code, Some(2), "{}{}", ended.stdout, ended.stderr);
    assert!(ended.stderr.contains("no .png file"), "{}", ended.stderr);
}

#[test]
fn a_photograph_that_is_too_small_is_refused_by_its_name() {
    let folder = Folder::new();
    for (name, (width, height), remedy) in
        [("narrow", (40, 30), "scale it to 64"), ("low", (96, 1), "give one of more rows")]
    {
        std::fs::create_dir(folder.path().join(name)).unwrap();
        let image = RgbImage { width, height, data: vec![90; 3 * width * height] };
        write_rgb(&folder.path().join(name).join("tiny.png"), &image, false).unwrap();
        let ended = folder.halfrow(["kernel", "measure", "--json", "--kernel", "sharp5", "--images", name]);
        assert_eq!(ended.code, Some(2), "{}{}", ended.stdout, ended.stderr);
        let said = error_sentence(&ended.json());
        assert!(said.contains("tiny.png cannot be used") && said.contains(remedy), "{said}");
    }
}

#[test]
fn a_photograph_counts_once() {
    let folder = folder_of_pictures();
    let measure = |more: &[&str]| {
        let call = ["kernel", "measure", "--kernel", "sharp5", "--images", "photos"];
        folder.halfrow(call.into_iter().chain(more.iter().copied()))
    };
    std::fs::create_dir(folder.path().join("copies")).unwrap();
    folder.write("copies/c.png", folder.read("photos/a.png"));
    for (more, other) in [("photos", "photos/a.png"), ("copies", "copies/c.png")] {
        let ended = measure(&[more]);
        assert_eq!(ended.code, Some(2), "{}{}", ended.stdout, ended.stderr);
        let said = format!("photos/a.png and {other} are one photograph");
        assert!(ended.stderr.contains(&said), "{}", ended.stderr);
    }
    std::fs::remove_file(folder.path().join("photos/a.png")).unwrap();
    let ended = measure(&[]);
    assert!(ended.stdout.starts_with("sharp5 on 1 photograph, over Hermite"), "{}", ended.stdout);
}

#[test]
fn a_place_that_cannot_be_written_is_refused_before_the_training() {
    let folder = folder_of_pictures();
    let refused = train(&folder, &["-o", "none/mine.json"]);
    assert_eq!(refused.code, Some(2), "{}{}", refused.stdout, refused.stderr);
    assert!(refused.stderr.contains("check that it exists, is writable and has space"), "{}", refused.stderr);
}

/// A folder `photos` with two pictures that have detail of every size, and a file that is no picture.
fn folder_of_pictures() -> Folder {
    let folder = Folder::new();
    std::fs::create_dir(folder.path().join("photos")).unwrap();
    for (name, seed) in [("photos/b.png", 5_u32), ("photos/a.png", 3)] {
        let (width, height) = (96, 64);
        let value = |place: u32| {
            let (row, column, colour) = (place / 3 / 96, place / 3 % 96, place % 3);
            let coarse = (row / seed + column / 7) % 2 * 100;
            let fine = (row * row + seed * column * column / 16 + 30 * colour) % 100;
            u8::try_from(coarse + fine).unwrap()
        };
        let data = (0..3 * 96 * 64).map(value).collect();
        write_rgb(&folder.path().join(name), &RgbImage { width, height, data }, false).unwrap();
    }
    folder.write("photos/notes.txt", "no photograph");
    folder
}

fn train(folder: &Folder, more: &[&str]) -> Ended {
    let call = ["kernel", "train", "--quiet", "--images", "photos"];
    folder.halfrow(call.into_iter().chain(more.iter().copied()))
}

#[test]
fn a_trained_kernel_tells_where_it_comes_from_and_is_the_same_every_time() {
    let folder = folder_of_pictures();
    let ended = train(&folder, &["-o", "mine.json"]).succeeded();
    assert!(ended.stdout.starts_with("2 photographs: "), "{}", ended.stdout);
    let mine = folder.read("mine.json");
    let file: Value = serde_json::from_slice(&mine).unwrap();
    let about = &file["about"];
    assert!(about["made_by"].as_str().unwrap().starts_with("halfrow "), "{about}");
    for (image, name) in about["images"].as_array().unwrap().iter().zip(["a.png", "b.png"]) {
        let hashed = Command::new("sha256sum").arg(folder.path().join("photos").join(name)).output().unwrap();
        let hashed = String::from_utf8(hashed.stdout).unwrap();
        assert_eq!(image["name"], name);
        assert_eq!(image["sha256"], hashed.split_whitespace().next().unwrap());
    }
    let counts = [&about["images"], &about["models"], &about["figures"]["held_out_gains_db"]];
    assert_eq!(counts.map(|list| list.as_array().unwrap().len()), [2, 4, 2]);

    let refused = train(&folder, &["-o", "mine.json"]);
    assert_eq!(refused.code, Some(2), "{}{}", refused.stdout, refused.stderr);
    assert!(refused.stderr.contains("allow it to be overwritten (--overwrite)"), "{}", refused.stderr);
    train(&folder, &["-o", "mine.json", "--overwrite"]).succeeded();
    assert!(folder.read("mine.json") == mine, "the same photographs gave another kernel");
    train(&folder, &["-o", "wide.json", "--taps", "7"]).succeeded();
    let nodes = |name| serde_json::from_slice::<Value>(&folder.read(name)).unwrap()["kernel"].clone();
    let uses_seven = |kernel: &Value| {
        kernel.as_array().unwrap().iter().any(|node| (&node[0], &node[4]) != (&0.into(), &0.into()))
    };
    assert!(!uses_seven(&nodes("mine.json")) && uses_seven(&nodes("wide.json")));
}

#[test]
fn a_trained_kernel_corrects_frames_alike_in_the_model_and_on_a_board() {
    let folder = folder_of_pictures();
    train(&folder, &["-o", "mine.json"]).succeeded();
    let corrected = |kernel: &str, output: &str, how: &[&str]| {
        let call = ["correct", "builtin:street", "--width", "128", "--height", "72", "--radius", "73.78"];
        let ended =
            folder.halfrow(call.into_iter().chain(["--kernel", kernel, "-o", output]).chain(how.to_vec()));
        assert_eq!(ended.code, Some(0), "{}{}", ended.stdout, ended.stderr);
        folder.read(output)
    };
    let model = corrected("mine.json", "model.pgm", &["--model"]);
    assert!(corrected("mine.json", "board.pgm", &["--board", "mock,taps=five"]) == model);
    assert!(corrected("hermite", "hermite.pgm", &["--model"]) != model);
}

/// Adds a photograph without any detail to those of [`folder_of_pictures`].
fn add_a_flat_one(folder: &Folder, name: &str) {
    let image = RgbImage { width: 96, height: 64, data: vec![90; 3 * 96 * 64] };
    write_rgb(&folder.path().join(name), &image, false).unwrap();
}

#[test]
fn what_was_not_measured_has_no_figure() {
    let folder = folder_of_pictures();
    std::fs::remove_file(folder.path().join("photos/a.png")).unwrap();
    let said = train(&folder, &["-o", "mine.json"]);
    assert!(said.stdout.contains("by the kernel of the others not measured; noise gain"), "{}", said.stdout);
    let said = train(&folder, &["-o", "mine.json", "--overwrite", "--json"]).json();
    assert_eq!(said["held_out_db"], Value::Null);
}

#[test]
fn a_photograph_whose_others_determine_no_kernel_costs_no_kernel() {
    let folder = folder_of_pictures();
    add_a_flat_one(&folder, "photos/c.png");
    let said = train(&folder, &["-o", "three.json"]).stdout;
    assert!(said.contains(", of 2 of them); noise gain"), "{said}");
    std::fs::remove_file(folder.path().join("photos/a.png")).unwrap();
    let ended = train(&folder, &["-o", "mine.json"]).succeeded();
    assert!(ended.stdout.contains("by the kernel of the others not measured"), "{}", ended.stdout);
    let file = folder.json("mine.json");
    assert_eq!(file["about"]["figures"]["held_out_gains_db"], serde_json::json!([null, null]));
}

#[test]
fn a_photograph_that_comes_back_exactly_spoils_no_figure() {
    let folder = folder_of_pictures();
    let measure = |more: &[&str]| {
        let call = ["kernel", "measure", "--quiet", "--kernel", "sharp5", "--images", "photos"];
        folder.halfrow(call.into_iter().chain(more.iter().copied()))
    };
    let before = measure(&["--json"]).json()["gains_db"].clone();
    add_a_flat_one(&folder, "photos/c.png");
    let behind = measure(&["--json"]).json()["gains_db"].clone();
    assert_eq!((&behind[0]["gain"], &behind[0]["exact"]), (&before[0]["gain"], &1.into()));
    let said = measure(&[]).stdout;
    assert!(said.contains("linear warp, as in Table 1") && !said.contains("NaN"), "{said}");
    assert!(said.contains("; 1 photograph comes back exactly, and is left out"), "{said}");
    for name in ["photos/a.png", "photos/b.png"] {
        std::fs::remove_file(folder.path().join(name)).unwrap();
    }
    let said = measure(&[]).stdout;
    assert!(
        said.contains("  no figure  linear warp, as in Table 1; 1 photograph comes back exactly"),
        "{said}"
    );
}

#[test]
fn a_pipe_among_the_photographs_is_refused_and_not_waited_for() {
    let folder = folder_of_pictures();
    let pipe = folder.path().join("photos/z.png");
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    // Whoever reads the pipe finds it empty.
    std::thread::spawn(move || std::fs::OpenOptions::new().write(true).open(pipe));
    let refused = train(&folder, &["-o", "mine.json"]);
    assert_eq!(refused.code, Some(2), "{}{}", refused.stdout, refused.stderr);
    assert!(refused.stderr.contains("z.png is a pipe or a device"), "{}", refused.stderr);
}
