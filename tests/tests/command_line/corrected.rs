//! `correct`: by the reference model and by a board.

use std::process::{Command, Stdio};

use halfrow_model::ModelPath;
use halfrow_tests::program::{Folder, finish};

use crate::{refused, small};

/// Golden values: one row of 64 samples, C = 63, Q = 14648488, corrected with the Keys kernel by a program that is not part of
/// this project.
const GOLDEN: [u16; 64] = [
    1931, 464, 2776, 1089, 3910, 1995, 1820, 3119, 952, 2005, 2057, 131, 2989, 1276, 3450, 2119, 530, 2964,
    1302, 4074, 2182, 1772, 3322, 1166, 1947, 2245, 317, 3208, 1464, 3470, 2325, 621, 3212, 1509, 363, 2370,
    625, 3517, 1588, 1887, 2432, 512, 3429, 1652, 3470, 2532, 731, 3304, 1710, 382, 2558, 844, 3703, 1776,
    1829, 2620, 715, 3650, 1839, 3453, 2745, 857, 3370, 1902,
];

/// A PGM of one row, 12 bits.
fn pgm(samples: &[u16]) -> Vec<u8> {
    let header = format!("P5\n{} 1\n4095\n", samples.len()).into_bytes();
    header.into_iter().chain(samples.iter().flat_map(|sample| sample.to_be_bytes())).collect()
}

#[test]
fn both_model_and_mock_give_the_golden_row() {
    let paths: Vec<_> = ModelPath::available().map(|path| format!("--model-path={path}")).collect();
    let mut ways = vec![["--model", "--quiet"], ["--board", "mock"]];
    ways.extend(paths.iter().map(|path| ["--model", path]));
    let folder = Folder::new();
    let samples: Vec<_> =
        (0..64_u32).map(|column| (column.wrapping_mul(2_654_435_761) >> 20) as u16).collect();
    folder.write("in.pgm", pgm(&samples));
    let made =
        folder.halfrow(["tables", "--width", "64", "--height", "1", "--kernel", "keys", "-o", "made.json"]);
    assert_eq!(made.code, Some(0), "{}", made.stderr);
    // The only row lies on the axis, so its own factor is 1.
    folder.write("tables.json", folder.text("made.json").replace("16777216", "14648488"));
    for how in ways {
        let call = ["correct", "in.pgm", "--tables", "tables.json", "-o", "out.pgm", "--overwrite"];
        folder.halfrow(call.into_iter().chain(how)).succeeded();
        assert_eq!(folder.read("out.pgm"), pgm(&GOLDEN), "{how:?}");
    }
}

#[test]
fn the_model_gives_what_the_mock_gives_byte_for_byte() {
    let kinds = [
        ["--kernel", "nearest", "--bits", "12"],
        ["--kernel", "linear", "--bits", "8"],
        ["--kernel", "keys", "--bits", "12"],
        ["--kernel", "hermite", "--bits", "10"],
    ];
    for kind in kinds {
        let folder = Folder::new();
        let frames = ["correct", "builtin:noise", "builtin:street", "builtin:extremes"];
        let size = ["--width", "128", "--height", "72", "--radius", "73.78", "--centre-x", "50"];
        let call = |how: &[&'static str]| {
            frames.into_iter().chain(size).chain(kind).chain(how.to_vec()).collect::<Vec<_>>()
        };
        folder.halfrow(call(&["--model", "-o", "model"])).succeeded();
        folder.halfrow(call(&["--board", "mock,latency=20,speed=1000000", "-o", "mock"])).succeeded();
        assert_eq!(folder.names("model"), ["extremes.pgm", "noise.pgm", "street.pgm"]);
        assert_eq!(folder.names("mock"), folder.names("model"));
        for name in folder.names("model") {
            let (model, mock) = (format!("model/{name}"), format!("mock/{name}"));
            assert!(folder.read(&model) == folder.read(&mock), "{name} with {kind:?}");
        }
    }
}

#[test]
fn a_frame_may_come_through_a_pipe() {
    let folder = Folder::new();
    let frames = ["--only", "noise", "-o", "in", "--width", "128", "--height", "72"];
    folder.halfrow(["frames"].into_iter().chain(frames)).succeeded();
    let size = ["--width", "128", "--height", "72", "--radius", "73.78", "--model"];
    for (input, output) in [("in/noise.pgm", "file.pgm"), ("/dev/stdin", "pipe.pgm")] {
        let call = ["correct", input, "-o", output].into_iter().chain(size);
        let mut cat = Command::new("cat");
        let mut cat = cat.arg(folder.path().join("in/noise.pgm")).stdout(Stdio::piped()).spawn().unwrap();
        finish(folder.command(call).stdin(cat.stdout.take().unwrap())).succeeded();
        cat.wait().unwrap();
    }
    assert!(folder.read("pipe.pgm") == folder.read("file.pgm"));
}

#[test]
fn a_broken_board_gives_another_frame_than_the_model() {
    let folder = Folder::new();
    let call = small("correct", &["builtin:noise", "--model", "-o", "model.pgm"]);
    folder.halfrow(call).succeeded();
    let call = small("correct", &["builtin:noise", "--board", "mock,fault=no-rounding", "-o", "board.pgm"]);
    folder.halfrow(call).succeeded();
    assert!(folder.read("model.pgm") != folder.read("board.pgm"));
}

#[test]
fn a_board_of_another_datapath_corrects_nothing() {
    let folder = Folder::new();
    let call = small("correct", &["builtin:noise", "--board", "mock,fault=wrong-datapath", "-o", "out.pgm"]);
    let refused = folder.halfrow(call);
    assert_eq!(refused.code, Some(6), "{}", refused.stderr);
    assert!(refused.stderr.contains("datapath 9 is not known here"), "{}", refused.stderr);
    assert_eq!(folder.names("."), [""; 0]);
}

#[test]
fn every_format_can_be_written_and_read_again() {
    let folder = Folder::new();
    let call = small("correct", &["builtin:street", "--model", "-o", "once.pgm"]);
    folder.halfrow(call).succeeded();
    for file in ["once.png", "once.tif", "once.dng", "once.raw"] {
        let call = small("correct", &["builtin:street", "--model", "-o", file]);
        assert_eq!(folder.halfrow(call).code, Some(0), "{file}");
    }
    let again = |file: &'static str, out: &'static str, more: &[&'static str]| {
        let call = small("correct", &[file, "--model", "-o", out]).into_iter().chain(more.to_vec());
        let ended = folder.halfrow(call);
        assert_eq!(ended.code, Some(0), "{file}: {}", ended.stderr);
        folder.read(out)
    };
    let expected = again("once.pgm", "pgm.pgm", &[]);
    assert!(again("once.png", "png.pgm", &[]) == expected);
    assert!(again("once.tif", "tif.pgm", &[]) == expected);
    assert!(again("once.dng", "dng.pgm", &[]) == expected);
    assert!(again("once.raw", "raw.pgm", &["--raw", "u16le"]) == expected);
}

#[test]
fn json_names_the_outputs_and_the_kind_of_board_and_judges_nothing() {
    let folder = Folder::new();
    for (how, kind) in [(["--model", "--json"], "model"), (["--board=mock", "--json"], "mock")] {
        let call = small("correct", &["builtin:black", "-o", "out.pgm", "--overwrite", how[0], how[1]]);
        let said = folder.halfrow(call).json();
        assert!(said["verdict"].is_null() && said["exit_code"] == 0);
        assert_eq!(said["corrected_by"], kind);
        assert_eq!(said["outputs"], serde_json::json!(["out.pgm"]));
    }
}

#[test]
fn what_does_not_fit_the_board_is_refused_before_a_folder_is_made() {
    let folder = Folder::new();
    let on = |board, kernel| {
        small("correct", &["builtin:black", "-o", "folder", "--kernel", kernel, "--board", board])
    };
    refused(&folder, &on("mock,max-width=64", "linear"), "frames of 128 x 16 do not fit the board");
    refused(
        &folder,
        &on("mock,depths=8+10", "linear"),
        "the board has no 12-bit samples, only those of 8 or 10 bits; name the bits (--bits) of one of these, or use tables of \
         such a depth",
    );
    refused(&folder, &on("mock,taps=five", "keys"), "the kernel needs seven taps");
}

/// Another bitstream would not mend its memory.
#[test]
fn a_board_that_keeps_its_tables_wrong_is_to_be_judged() {
    for fault in ["row-factor", "kernel-word"] {
        let call = small("correct", &["builtin:bars", "-o", "out.pgm", "--board"]);
        let ended = Folder::new().halfrow(call.into_iter().chain([format!("mock,fault={fault}").as_str()]));
        assert_eq!(ended.code, Some(3), "{}", ended.stderr);
        let asked = "; run `halfrow verify`, which reads the tables back and names what is wrong in them";
        assert!(ended.stderr.contains(asked) && !ended.stderr.contains("bitstream"), "{}", ended.stderr);
    }
}

#[test]
fn a_file_that_is_there_is_replaced_only_when_that_is_allowed() {
    let folder = Folder::new();
    folder.write("out.pgm", "precious");
    refused(
        &folder,
        &small("correct", &["builtin:black", "--model", "-o", "out.pgm"]),
        "allow it to be overwritten (--overwrite)",
    );
    assert_eq!(folder.text("out.pgm"), "precious");
    let call = small("correct", &["builtin:black", "--model", "-o", "out.pgm", "--overwrite"]);
    folder.halfrow(call).succeeded();
    assert!(folder.read("out.pgm").starts_with(b"P5"));
}

#[test]
fn outputs_that_have_no_place_are_refused() {
    let folder = Folder::new();
    let black = "builtin:black";
    refused(
        &folder,
        &small("correct", &[black, "builtin:white", "--model", "-o", "one.pgm"]),
        "one file for 2 frames",
    );
    refused(
        &folder,
        &small("correct", &[black, black, "--model", "-o", "out"]),
        "two inputs would both be written",
    );
    refused(&folder, &small("correct", &[black, "--model", "-o", "out.jpg"]), "does not tell the format");
    refused(&folder, &small("correct", &[black, "-o", "out.pgm"]), "--model");
}

/// The value of the tag Orientation in a TIFF's first directory.
fn orientation(file: &[u8]) -> u16 {
    let short = |at: usize| u16::from_le_bytes([file[at], file[at + 1]]);
    let directory = usize::from(short(4));
    let entries = (0..usize::from(short(directory))).map(|entry| directory + 2 + 12 * entry);
    entries.filter(|&entry| short(entry) == 274).map(|entry| short(entry + 8)).next().unwrap()
}

/// `file`, of the TIFF family, with another orientation.
fn turned(mut file: Vec<u8>, orientation: u8) -> Vec<u8> {
    let entry = file.windows(8).position(|bytes| bytes == [18, 1, 3, 0, 1, 0, 0, 0]).unwrap();
    file[entry + 8] = orientation;
    file
}

/// By hand: a camera that hangs upside down reads out the bright upper half of the scene at the bottom.
#[test]
fn what_a_camera_that_hangs_upside_down_has_seen_is_shown_upright() {
    let folder = Folder::new();
    let light = (0..16).flat_map(|row| [if row < 8 { 0_u8 } else { 255 }; 128]);
    folder.write("in.pgm", b"P5\n128 16\n255\n".iter().copied().chain(light).collect::<Vec<u8>>());
    let correct = |input: &str, more: &[&str]| {
        let call = [&[input, "--bits", "8"], more, &["--preview", "look.png", "--overwrite"]].concat();
        folder.halfrow(small("correct", &call)).succeeded();
    };
    let top = || halfrow::frames::read_rgb(&folder.path().join("look.png")).unwrap().data[0];
    for name in ["frame.dng", "frame.tif"] {
        correct("in.pgm", &["--model", "-o", name]);
        assert_eq!(top(), 0, "{name} lies as it was read out");
        folder.write("hanging", turned(folder.read(name), 3));
        for how in [&["--model"][..], &["--board", "mock"]] {
            correct("hanging", &[how, &["-o", "out.tif"]].concat());
            assert_eq!((top(), orientation(&folder.read("out.tif"))), (255, 3), "{name}");
        }
    }
}

/// A camera that hangs upside down: its samples stay in their order, and a viewer turns them as before.
#[test]
fn the_orientation_of_a_dng_is_kept() {
    let folder = Folder::new();
    folder.halfrow(small("correct", &["builtin:noise", "--model", "-o", "in.dng"])).succeeded();
    let upright = folder.read("in.dng");
    folder.write("upright.dng", &upright);
    folder.write("hanging.dng", turned(upright, 3));
    for (name, how) in [("model", ["--model", "--quiet"]), ("board", ["--board", "mock"])] {
        let call = [&["upright.dng", "hanging.dng", "-o", name, "--format", "dng"][..], &how].concat();
        folder.halfrow(small("correct", &call)).succeeded();
        let [hanging, upright] =
            ["hanging", "upright"].map(|frame| folder.read(&format!("{name}/{frame}.dng")));
        assert_eq!((orientation(&hanging), orientation(&upright)), (3, 1), "{name}");
        assert!(turned(hanging, 1) == upright, "{name}");
    }
}
