//! `correct --preview` and the formats of corrected frames.

use halfrow::frames::preview::RgbImage;
use halfrow_tests::program::Folder;
use serde_json::json;

use crate::{refused, small};

/// 128 x 16 samples of 8 bits under GRBG: red 200, green 100 and blue 40 in the upper eight rows, and black below. Every row is
/// flat in each colour, so a correction leaves it as it is.
fn edge() -> Vec<u8> {
    let sample = |row: usize, column: usize| match (row % 2, column % 2) {
        _ if row >= 8 => 0,
        (0, 1) => 200,
        (1, 0) => 40,
        _ => 100,
    };
    let samples = (0..16).flat_map(|row| (0..128).map(move |column| sample(row, column)));
    b"P5\n128 16\n255\n".iter().copied().chain(samples).collect()
}

fn preview(more: &[&str]) -> RgbImage {
    let folder = Folder::new();
    folder.write("edge.pgm", edge());
    let call = ["edge.pgm", "--bits", "8", "--model", "-o", "out.pgm", "--preview", "look.png"];
    let ended = folder.halfrow(small("correct", &call).into_iter().chain(more.iter().copied())).succeeded();
    assert_eq!(
        ended.stdout,
        "wrote out.pgm, corrected by the model, not judged\nwrote look.png, a preview\n\
         tables: equidistant lens, R = 1106.697 pixels (Eq. 9), hermite kernel\n"
    );
    assert_eq!(folder.read("out.pgm"), edge());
    halfrow::frames::read_rgb(&folder.path().join("look.png")).unwrap()
}

fn pixel(image: &RgbImage, row: usize, column: usize) -> &[u8] {
    &image.data[3 * (row * image.width + column)..][..3]
}

/// By hand, on either side of the edge. In row 7 a blue place has its own 40, greens of 100, 100, 100 and 0, and reds of 200,
/// 200, 0 and 0; a green place has reds of 200 and 0. In row 8 a green place has no red next to it, and blues of 40 and 0.
#[test]
fn missing_colours_are_means_of_their_neighbours() {
    let image = preview(&["--preview-coded"]);
    assert_eq!((image.width, image.height), (128, 16));
    for (row, column, colours) in [
        (3, 60, [200, 100, 40]),
        (4, 61, [200, 100, 40]),
        (7, 60, [100, 75, 40]),
        (7, 61, [100, 100, 40]),
        (8, 60, [0, 0, 20]),
        (12, 60, [0, 0, 0]),
    ] {
        assert_eq!(pixel(&image, row, column), colours, "row {row}, column {column}");
    }
}

/// The same values coded by IEC 61966-2-1, computed in Python: 200, 100, 75, 40 and 20 of 255 become 229, 168, 148, 110 and 79.
#[test]
fn light_is_coded_for_the_screen() {
    let image = preview(&[]);
    for (row, column, colours) in
        [(3, 60, [229, 168, 110]), (7, 60, [168, 148, 110]), (8, 60, [0, 0, 79]), (12, 60, [0, 0, 0])]
    {
        assert_eq!(pixel(&image, row, column), colours, "row {row}, column {column}");
    }
}

/// 66 and 77 are the first bytes of a BMP.
#[test]
fn headerless_samples_are_no_photograph_however_they_begin() {
    let folder = Folder::new();
    folder.write("dark.raw", [66, 77].repeat(64 * 16));
    let call =
        ["dark.raw", "--raw", "u8", "--bits", "8", "--model", "-o", "out.pgm", "--preview", "look.png"];
    folder.halfrow(small("correct", &call)).succeeded();
    let image = halfrow::frames::read_rgb(&folder.path().join("look.png")).unwrap();
    // By IEC 61966-2-1, computed in Python: 66 and 77 of 255 become 139 and 149.
    let pixel = pixel(&image, 8, 64);
    assert!(pixel.iter().all(|colour| (139..=149).contains(colour)), "{pixel:?}");
}

#[test]
fn several_frames_go_into_folders_in_the_format_that_is_asked_for() {
    let folder = Folder::new();
    let frames = ["builtin:street", "builtin:bars", "--model", "--json"];
    let places = ["-o", "frames", "--format", "dng", "--preview", "looks"];
    let said = folder.halfrow(small("correct", &[frames, ["-o", "pgm", "--format", "pgm"]].concat()));
    assert_eq!(said.json()["previews"], serde_json::json!([]));
    assert_eq!(folder.names("pgm"), ["bars.pgm", "street.pgm"]);
    let said = folder.halfrow(small("correct", &frames).into_iter().chain(places)).json();
    assert_eq!(said["outputs"], serde_json::json!(["frames/street.dng", "frames/bars.dng"]));
    assert_eq!(said["previews"], serde_json::json!(["looks/street.png", "looks/bars.png"]));
    assert_eq!(folder.names("frames"), ["bars.dng", "street.dng"]);
    assert_eq!(folder.names("looks"), ["bars.png", "street.png"]);
}

#[test]
fn previews_that_have_no_place_are_refused() {
    let folder = Folder::new();
    folder.write("look.png", "precious");
    let refuse = |more: &[&str], sentence: &str| {
        let call = [&["builtin:black", "--model", "-o", "out.dng"], more].concat();
        refused(&folder, &small("correct", &call), sentence);
    };
    refuse(&["--preview", "look.png"], "look.png exists; allow it to be overwritten (--overwrite)");
    refuse(&["--preview", "look.jpg"], "look.jpg must be a PNG; end its name in .png");
    refuse(&["builtin:white", "--preview", "new.png"], "one file for 2 frames");
    refuse(&["--format", "pgm"], "out.dng is no pgm; leave --format out");
    refuse(&["--format", "jpeg"], "use pgm, png, tif, dng or raw");
    refuse(&["--preview-coded"], "--preview");
    assert_eq!(folder.text("look.png"), "precious");
    let both = ["builtin:black", "--model", "-o", "new.png", "--preview", "new.png"];
    refused(&folder, &small("correct", &both), "or a frame and its preview");
    let other_names = ["builtin:black", "--model", "-o", "new.png", "--preview", "./new.png"];
    refused(&folder, &small("correct", &other_names), "or a frame and its preview");
    let one_for_two = ["builtin:black", "builtin:white", "--model", "-o", "out", "--preview", "new.png"];
    refused(&folder, &small("correct", &one_for_two), "name a folder with --preview");
    let nowhere = ["builtin:black", "--model", "-o", "none/out.dng"];
    refused(&folder, &small("correct", &nowhere), "check that it exists, is writable and has space");
}

/// Whoever does what the message says is stopped by the frame that is there already, and must know of it.
#[test]
fn a_frame_that_is_in_place_is_told_though_its_preview_cannot_be_written() {
    let call = small("correct", &["builtin:noise", "--model", "-o", "a.pgm", "--preview", "a.png"]);
    for json in [false, true] {
        let folder = Folder::new();
        // A frame of 128 x 16 samples of two bytes fits into 9 blocks of 512 bytes, and noise in three colours does not.
        let ended = folder.halfrow_on_a_full_disk(9, call.iter().copied().chain(json.then_some("--json")));
        assert_eq!((ended.code, folder.names(".")), (Some(3), vec!["a.pgm".to_owned()]), "{ended:?}");
        assert!(ended.stderr.contains("cannot write a.png"), "{ended:?}");
        if json {
            let said = ended.json();
            let told = ["corrected_by", "outputs", "previews"].map(|key| said[key].clone());
            assert_eq!(told, [json!("model"), json!(["a.pgm"]), json!([])]);
        } else {
            assert!(
                ended.stdout.starts_with("wrote a.pgm, corrected by the model, not judged\n"),
                "{ended:?}"
            );
            assert!(!ended.stdout.contains("a.png"), "{ended:?}");
        }
    }
}

#[test]
fn frames_by_a_board_that_are_in_place_are_told_though_a_later_one_cannot_be_written() {
    let folder = Folder::new();
    let inputs = ["builtin:black", "builtin:noise", "--board", "mock", "-o", "out", "--format", "png"];
    // Black shrinks to a few bytes, and noise does not.
    let ended = folder.halfrow_on_a_full_disk(2, small("correct", &inputs).into_iter().chain(["--json"]));
    assert_eq!((ended.code, folder.names("out")), (Some(3), vec!["black.png".to_owned()]), "{ended:?}");
    let said = ended.json();
    let told = ["corrected_by", "outputs", "previews"].map(|key| said[key].clone());
    assert_eq!(told, [json!("mock"), json!(["out/black.png"]), json!([])]);
}
