//! Frame files that cannot be streamed: each is refused with its own message, and nothing is written.

use halfrow_tests::program::Folder;

use crate::{refused, small};

/// A frame of the small size in every format, and the folder that holds them.
fn frames() -> Folder {
    let folder = Folder::new();
    for name in ["frame.pgm", "frame.png", "frame.tif", "frame.raw"] {
        let made = folder.halfrow(small("correct", &["builtin:noise", "--model", "-o", name]));
        assert_eq!(made.code, Some(0), "{}", made.stderr);
    }
    folder
}

/// `verify` and `correct` must both refuse the file.
#[track_caller]
fn bad_frame(folder: &Folder, file: &str, options: &[&str], sentence: &str) {
    let more = [&["--report", "out", "--frame", file], options].concat();
    refused(folder, &small("verify", &more), sentence);
    let more = [&[file, "--model", "-o", "out.pgm"], options].concat();
    refused(folder, &small("correct", &more), sentence);
}

#[test]
fn a_file_that_breaks_off_is_refused() {
    let folder = frames();
    let cut = |name: &str, short: &str, bytes: usize| {
        let whole = folder.read(name);
        folder.write(short, &whole[..whole.len() - bytes]);
    };
    cut("frame.pgm", "short.pgm", 1);
    bad_frame(&folder, "short.pgm", &[], "it has 4095 bytes of samples where its size calls for 4096");
    cut("frame.pgm", "head.pgm", 4096 + 8);
    bad_frame(&folder, "head.pgm", &[], "the PGM header has no");
    cut("frame.png", "short.png", 100);
    bad_frame(&folder, "short.png", &[], "short.png holds no frame");
    cut("frame.tif", "short.tif", 100);
    bad_frame(&folder, "short.tif", &[], "short.tif holds no frame");
    cut("frame.raw", "short.raw", 2);
    bad_frame(
        &folder,
        "short.raw",
        &["--raw", "u16le"],
        "it has 4094 bytes of samples where its size calls for 4096",
    );
    folder.write("empty.pgm", "");
    bad_frame(&folder, "empty.pgm", &[], "it begins like no format known here");
}

#[test]
fn a_file_that_goes_on_is_refused() {
    let folder = frames();
    for (name, long, options) in
        [("frame.pgm", "long.pgm", &[][..]), ("frame.raw", "long.raw", &["--raw", "u16le"])]
    {
        folder.write(long, [folder.read(name), vec![0; 3]].concat());
        bad_frame(&folder, long, options, "it goes on for 3 bytes after its last sample");
    }
}

#[test]
fn a_frame_of_another_size_is_refused_with_the_size_that_would_do() {
    let folder = frames();
    let other = ["--width", "128", "--height", "18", "--only", "black", "-o", "other"];
    assert_eq!(folder.halfrow(["frames"].into_iter().chain(other)).code, Some(0));
    bad_frame(&folder, "other/black.pgm", &[], "is 128 x 18, and the tables are for 128 x 16");
    bad_frame(&folder, "frame.raw", &["--raw", "u8"], "it goes on for 2048 bytes");
}

#[test]
fn samples_above_the_depth_are_refused() {
    let folder = frames();
    bad_frame(&folder, "frame.pgm", &["--bits", "10"], "10 bits");
    bad_frame(&folder, "frame.raw", &["--bits", "8", "--raw", "u16le"], "8 bits");
    let mut high = folder.read("frame.raw");
    high[1] = 0x10;
    folder.write("high.raw", high);
    bad_frame(&folder, "high.raw", &["--raw", "u16le"], "row 0, column 0");
}

#[test]
fn what_is_no_frame_at_all_is_refused() {
    let folder = Folder::new();
    folder.write("notes.txt", "not a frame");
    bad_frame(&folder, "notes.txt", &[], "it begins like no format known here (PGM P5, PNG, TIFF, DNG)");
    folder.write("photo.jpg", b"\xff\xd8\xff\xe0");
    bad_frame(&folder, "photo.jpg", &[], "a JPEG cannot be used");
    folder.write("plain.pgm", "P2\n2 2\n255\n0 0 0 0\n");
    bad_frame(&folder, "plain.pgm", &[], "plain text (P2)");
    folder.write("zero.pgm", "P5\n0 16\n4095\n");
    bad_frame(&folder, "zero.pgm", &[], "zero.pgm holds no frame");
    folder.write("huge.pgm", "P5\n99999999 16\n4095\n");
    bad_frame(&folder, "huge.pgm", &[], "it is 99999999 x 16");
    folder.write("deep.pgm", "P5\n128 16\n65536\n");
    bad_frame(&folder, "deep.pgm", &[], "the PGM maxval is 65536");
    std::fs::create_dir(folder.path().join("folder.pgm")).unwrap();
    bad_frame(&folder, "folder.pgm", &[], "cannot read folder.pgm");
}
