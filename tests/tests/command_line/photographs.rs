//! Photographs on the command line. The BMPs are written here byte by byte; the others are those of
//! `host/frames/tests/photographs`, made by Pillow.

use std::path::PathBuf;

use halfrow::frames::read_rgb;
use halfrow_tests::program::{Folder, finish};
use serde_json::json;

use crate::{refused, small};

/// A BMP of `width` x `height` pixels of one colour, 24 bits each, beginning with the lowest row.
fn bmp(width: u32, height: u32, [red, green, blue]: [u8; 3]) -> Vec<u8> {
    let line = (3 * width).next_multiple_of(4);
    let mut file = b"BM".to_vec();
    for value in [54 + line * height, 0, 54, 40, width, height, 1 | 24 << 16, 0, line * height, 0, 0, 0, 0] {
        file.extend(value.to_le_bytes());
    }
    for _ in 0..height {
        file.extend([blue, green, red].repeat(width as usize));
        file.extend(vec![0; (line - 3 * width) as usize]);
    }
    file
}

fn folder() -> Folder {
    let folder = Folder::new();
    let photographs = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../host/frames/tests/photographs");
    for name in ["turned6.jpg", "lossless.webp", "small.png", "cmyk.jpg"] {
        folder.write(name, std::fs::read(photographs.join(name)).unwrap());
    }
    folder.write("flat.bmp", bmp(128, 16, [200, 100, 40]));
    folder
}

const FITTED: &str = "fitted turned6.jpg: 48 x 72, cropped to 48 x 6 about its centre, 8 % of it, scaled to 128 x 16 (Catmull-Rom)\n";

#[test]
fn another_size_is_refused_with_both_sizes_and_the_flag() {
    let folder = folder();
    let sentence = "it is 48 x 72, but a frame of 128 x 16 is needed; crop and scale it (--fit)";
    refused(&folder, &small("verify", &["--frame", "turned6.jpg"]), sentence);
    refused(&folder, &small("correct", &["turned6.jpg", "--model", "-o", "out.png"]), sentence);
    let sentence = "it is 160 x 100, but a frame of 128 x 16 is needed; crop and scale it (--fit)";
    refused(&folder, &small("verify", &["--frame", "small.png"]), sentence);
    refused(&folder, &small("verify", &["--fit", "--frame", "cmyk.jpg"]), "a CMYK JPEG cannot be used");
}

/// It cannot be looked at before it is corrected.
#[test]
fn a_picture_from_a_pipe_is_fitted_and_told_in_a_line() {
    let folder = folder();
    for whom in [&["--model"][..], &["--board", "mock"]] {
        let call = small("correct", &["/dev/stdin", "--fit", "--overwrite", "-o", "out.pgm"]);
        let line = "cat turned6.jpg | \"$@\"";
        let ended =
            finish(&mut folder.by_shell(line, call.into_iter().chain(whom.iter().copied()))).succeeded();
        let told = FITTED.replace("turned6.jpg", "/dev/stdin");
        assert!(ended.stderr.contains(&told), "{}", ended.stderr);
    }
}

#[test]
fn pictures_are_fitted_and_each_is_told_in_a_line() {
    let folder = folder();
    let ended = folder
        .halfrow(small("verify", &["--fit", "--frame", "turned6.jpg", "--frame", "flat.bmp"]))
        .succeeded();
    assert_eq!(ended.stderr.matches("fitted ").count(), 1, "{}", ended.stderr);
    assert!(ended.stderr.contains(FITTED), "{}", ended.stderr);
    let several = ["turned6.jpg", "lossless.webp", "small.png", "flat.bmp", "--model", "-o", "out", "--fit"];
    let ended = folder.halfrow(small("correct", &several)).succeeded();
    assert_eq!(ended.stderr.lines().count(), 3, "{}", ended.stderr);
    assert_eq!(folder.names("out"), ["flat.pgm", "lossless.pgm", "small.pgm", "turned6.pgm"]);
    let quiet = folder.halfrow(small("correct", &["-q", "turned6.jpg", "--model", "-o", "q.pgm", "--fit"]));
    assert_eq!((quiet.code, quiet.stderr.as_str()), (Some(0), ""));
}

/// For a program that lets photographs be corrected: how much of each is left.
#[test]
fn the_document_says_how_each_picture_was_fitted() {
    let folder = folder();
    let of_size = |width: u32, height: u32| json!({ "width": width, "height": height });
    let turned = json!({ "found": of_size(48, 72), "cropped": of_size(48, 6), "wanted": of_size(128, 16) });
    for (place, whom) in [("model", &["--model"][..]), ("board", &["--board", "mock"])] {
        let call = ["--json", "-q", "turned6.jpg", "flat.bmp", "builtin:grey", "--fit", "-o", place];
        let said = folder.halfrow(small("correct", &call).into_iter().chain(whom.iter().copied())).json();
        assert_eq!(said["fitted"], json!([turned, null, null]), "{place}");
        let call = small("correct", &["--json", "-q", "/dev/stdin", "--fit", "--overwrite", "-o", "out.pgm"]);
        let line = "cat turned6.jpg | \"$@\"";
        let piped = finish(&mut folder.by_shell(line, call.into_iter().chain(whom.iter().copied())));
        assert_eq!(piped.json()["fitted"], json!([turned]), "{place}");
    }
}

/// Or it would be said of another picture.
#[test]
fn what_is_not_in_place_is_not_said_to_be_fitted_either() {
    let folder = folder();
    for (place, whom) in [("model", "--model"), ("board", "--board=mock")] {
        let call = ["--json", "-q", whom, "--fit", "-o", place, "turned6.jpg", "pipe.png"];
        // By then the first picture is in its place.
        let line = "rm -f pipe.png; mkfifo pipe.png; (sleep 2; echo no picture >pipe.png) & exec \"$@\"";
        let ended = finish(&mut folder.by_shell(line, small("correct", &call)));
        let said = ended.json();
        assert_eq!((ended.code, &said["outputs"]), (Some(2), &json!([format!("{place}/turned6.pgm")])));
        assert_eq!(said["fitted"].as_array().map(Vec::len), Some(1), "{said}");
        assert_eq!(said["fitted"][0]["found"], json!({ "width": 48, "height": 72 }), "{said}");
    }
}

#[test]
fn fitting_comes_from_the_environment_and_the_settings_too() {
    let folder = folder();
    folder.write("settings.toml", "fit = true\n");
    let call = || small("verify", &["--frame", "turned6.jpg"]);
    let set = folder.halfrow(call().into_iter().chain(["--settings", "settings.toml"]));
    assert!(set.code == Some(0) && set.stderr.contains(FITTED), "{}", set.stderr);
    let variable = finish(folder.command(call()).env("HALFROW_FIT", "1"));
    assert!(variable.code == Some(0) && variable.stderr.contains(FITTED), "{}", variable.stderr);
    assert_eq!(finish(folder.command(call()).env("HALFROW_FIT", "0")).code, Some(2));
}

#[test]
fn raw_samples_are_never_fitted() {
    let folder = folder();
    folder.write("raw.pgm", [b"P5\n130 16\n4095\n".to_vec(), vec![0; 2 * 130 * 16]].concat());
    folder.write("raw.bin", vec![0; 2 * 128 * 16]);
    refused(&folder, &small("verify", &["--fit", "--frame", "raw.pgm"]), "raw samples are never scaled");
    let headerless = ["--fit", "--raw", "u16le", "--frame", "raw.bin"];
    refused(&folder, &small("verify", &headerless), "--fit does nothing beside --raw");
    finish(folder.command(small("verify", &headerless[1..])).env("HALFROW_FIT", "1")).succeeded();
    refused(&folder, &small("verify", &["--fit"]), "--fit is for frames that are files");
}

/// A photograph of one colour is shown in that colour; a correction leaves flat colours as they are.
#[test]
fn a_photograph_is_previewed_as_it_is_coded() {
    let folder = folder();
    let call = ["flat.bmp", "--model", "-o", "out.png", "--preview", "look.png"];
    folder.halfrow(small("correct", &call)).succeeded();
    let image = read_rgb(&folder.path().join("look.png")).unwrap();
    assert!(image.data.chunks_exact(3).all(|pixel| pixel == [200, 100, 40]), "{:?}", &image.data[..6]);
}

/// In 400 MB of address space: the 10.8 GB that a header of 60000 x 60000 asks for would end the program.
#[test]
fn a_forged_header_takes_no_memory() {
    let folder = folder();
    let mut forged = bmp(128, 16, [1, 2, 3]);
    for side in [18, 22] {
        forged[side..side + 4].copy_from_slice(&60_000_u32.to_le_bytes());
    }
    folder.write("forged.bmp", forged);
    let mut limited = std::process::Command::new("sh");
    limited.current_dir(folder.path()).args(["-c", "ulimit -v 400000; exec \"$@\"", "sh"]);
    let call = folder.command(small("correct", &["forged.bmp", "--fit", "--model", "-o", "out.pgm"]));
    limited.arg(call.get_program()).args(call.get_args());
    let ended = finish(&mut limited);
    let sentence = "it is 60000 x 60000, above 100 megapixels; scale it down first";
    assert!(ended.code == Some(2) && ended.stderr.contains(sentence), "{}", ended.stderr);
}
