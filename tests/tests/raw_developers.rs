//! DNG files in the view of raw developers: dcraw, LibRaw's tools, and ExifTool.

// clippy.toml allows it inside #[test] functions, but not in the functions that several tests call.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::process::Command;

use halfrow::frames::{ReadOptions, decode};
use halfrow_model::{BitDepth, Frame, Phase};
use halfrow_tests::program::{Folder, halfrow};

/// What `program`, of Debian's `package`, prints when it runs in `folder`.
#[track_caller]
fn printed(folder: &Folder, package: &str, program: &str, arguments: &[&str]) -> Vec<u8> {
    let started = Command::new(program).args(arguments).current_dir(folder.path()).output();
    let ended = started.unwrap_or_else(|error| panic!("{program}: {error}; run: apt-get install {package}"));
    let said = String::from_utf8_lossy(&ended.stderr);
    assert!(ended.status.success(), "{program} {arguments:?}: {said}");
    ended.stdout
}

#[track_caller]
fn text(folder: &Folder, package: &str, program: &str, arguments: &[&str]) -> String {
    let text = String::from_utf8(printed(folder, package, program, arguments)).unwrap();
    // Columns are padded with blanks.
    text.lines().map(|line| line.split_whitespace().collect::<Vec<_>>().join(" ") + "\n").collect()
}

/// A folder with a corrected frame as `frame.dng` and `frame.pgm`, and the frame.
fn corrected(phase: Phase, depth: BitDepth) -> (Folder, Frame) {
    let folder = Folder::new();
    let bits = depth.bits().to_string();
    for output in ["frame.dng", "frame.pgm"] {
        let frame = ["builtin:noise", "--model", "--phase", phase.name(), "--bits", &bits, "-o", output];
        let size = ["correct", "--width", "96", "--height", "54", "--radius", "55"];
        folder.halfrow(size.into_iter().chain(frame)).succeeded();
    }
    let frame =
        decode(&folder.read("frame.pgm"), &ReadOptions { depth, phase, ..ReadOptions::default() }).unwrap();
    (folder, frame)
}

fn every_kind() -> impl Iterator<Item = (Phase, BitDepth)> {
    Phase::ALL.into_iter().flat_map(|phase| BitDepth::ALL.map(|depth| (phase, depth)))
}

#[test]
fn dcraw_and_libraw_find_every_sample_as_it_is() {
    for (phase, depth) in every_kind() {
        let (folder, frame) = corrected(phase, depth);
        let how = ReadOptions { depth, phase, ..ReadOptions::default() };
        printed(&folder, "libraw-bin", "unprocessed_raw", &["-q", "-T", "frame.dng"]);
        let by_libraw = folder.read("frame.dng.tiff");
        assert!(decode(&by_libraw, &how).unwrap() == frame, "{phase} {depth:?}, LibRaw");
        // Of a camera that hangs on its side: without `-t 0` dcraw turns raw samples, too.
        tag(&folder, "frame.dng", &["Orientation=6"]);
        let by_dcraw = printed(&folder, "dcraw", "dcraw", &["-D", "-4", "-T", "-t", "0", "-c", "frame.dng"]);
        assert!(decode(&by_dcraw, &how).unwrap() == frame, "{phase} {depth:?}, dcraw");
    }
}

#[test]
fn dcraw_and_libraw_name_the_pattern_and_the_size() {
    let patterns = [
        (Phase::Grbg, "GR/BG", "GRBGGRBGGRBGGRBG"),
        (Phase::Rggb, "RG/GB", "RGGBRGGBRGGBRGGB"),
        (Phase::Bggr, "BG/GR", "BGGRBGGRBGGRBGGR"),
        (Phase::Gbrg, "GB/RG", "GBRGGBRGGBRGGBRG"),
    ];
    for (phase, by_dcraw, by_libraw) in patterns {
        let (folder, _) = corrected(phase, BitDepth::Twelve);
        let told = text(&folder, "dcraw", "dcraw", &["-i", "-v", "frame.dng"]);
        let lines = ["Camera: halfrow frame", "DNG Version: 1.4.0.0", "Full size: 96 x 54"];
        for line in lines.into_iter().chain([format!("Filter pattern: {by_dcraw}").as_str()]) {
            assert!(told.lines().any(|told| told == line), "{line} in {told}");
        }
        let told = text(&folder, "libraw-bin", "raw-identify", &["-v", "frame.dng"]);
        let lines = ["Image size: 96 x 54", "DNG Illuminant 1: D65"];
        for line in lines.into_iter().chain([format!("Filter pattern: {by_libraw}").as_str()]) {
            assert!(told.lines().any(|told| told == line), "{line} in {told}");
        }
    }
}

#[test]
fn exiftool_finds_nothing_missing_and_the_depth_as_white() {
    for (phase, depth) in every_kind() {
        let (folder, _) = corrected(phase, depth);
        let told = text(
            &folder,
            "libimage-exiftool-perl",
            "exiftool",
            &["-s", "-validate", "-warning", "-a", "-WhiteLevel", "-BlackLevel", "frame.dng"],
        );
        let white = (1 << depth.bits()) - 1;
        assert_eq!(told, format!("Validate : OK\nWhiteLevel : {white}\nBlackLevel : 0\n"));
    }
}

/// What ExifTool finds in `file` of these tags, without rounding.
fn told_by_exiftool(folder: &Folder, file: &str, tags: &[&str]) -> String {
    let call = [&["-s", "-n", "-validate", "-warning"][..], tags, &[file]].concat();
    text(folder, "libimage-exiftool-perl", "exiftool", &call)
}

/// Lets ExifTool write these tags into the first directory of `file`.
fn tag(folder: &Folder, file: &str, tags: &[&str]) {
    let tags: Vec<_> = tags.iter().map(|tag| format!("-IFD0:{tag}")).collect();
    let how = ["-q", "-n", "-overwrite_original"];
    let call: Vec<_> = how.into_iter().chain(tags.iter().map(String::as_str)).chain([file]).collect();
    printed(folder, "libimage-exiftool-perl", "exiftool", &call);
}

/// Everything about levels and colours that ExifTool wrote into a DNG is in the corrected one, by the model and by a board.
#[test]
fn what_a_dng_says_of_levels_and_colours_is_in_the_corrected_one() {
    let tags = [
        "WhiteLevel=3967",
        "BlackLevelRepeatDim=2 2",
        "BlackLevel=64 70 61 66",
        "Make=Acme",
        "Model=Fish 1",
        "UniqueCameraModel=Acme Fish 1",
        "ColorMatrix1=0.5 -0.25 0.125 -0.5 1.25 0.25 -0.125 0.25 0.75",
        "ColorMatrix2=1 0 0.25 -0.5 1.5 0.25 -0.25 0.5 0.75",
        "CalibrationIlluminant1=17",
        "CalibrationIlluminant2=21",
        "AnalogBalance=1 1.5 1",
        "AsShotNeutral=0.5 1 0.25",
        "BaselineExposure=0.5",
        "ForwardMatrix1=0.5 0.25 0.25 0.25 0.5 0.25 0 0.25 0.75",
    ];
    let names: Vec<_> =
        tags.iter().filter_map(|tag| tag.split('=').next()).map(|tag| format!("-{tag}")).collect();
    let names: Vec<_> = names.iter().map(String::as_str).collect();
    let (folder, _) = corrected(Phase::Grbg, BitDepth::Twelve);
    folder.write("camera.dng", folder.read("frame.dng"));
    tag(&folder, "camera.dng", &tags);
    let wanted = told_by_exiftool(&folder, "camera.dng", &names);
    assert_eq!(wanted.lines().count(), 1 + tags.len(), "{wanted}");
    for how in [&["--model"][..], &["--board", "mock"]] {
        let size = ["correct", "--width", "96", "--height", "54", "--radius", "55", "--overwrite"];
        folder
            .halfrow(size.into_iter().chain(how.iter().copied()).chain(["camera.dng", "-o", "out.dng"]))
            .succeeded();
        assert_eq!(told_by_exiftool(&folder, "out.dng", &names), wanted, "{how:?}");
    }
}

/// A level below each place of the pattern is in the outputs as it was in the samples, except where an output is limited to 0 or
/// to full scale, with the level or without.
#[test]
fn a_black_level_passes_unchanged() {
    let levels = [[64_u16, 70], [61, 66]];
    let (folder, _) = corrected(Phase::Grbg, BitDepth::Twelve);
    let how = ReadOptions::default();
    let read = |name: &str| decode(&folder.read(name), &how).unwrap();
    let level = |place: usize| levels[place / 96 % 2][place % 2];
    // Noise in the lower 3900 of 4096.
    let plain: Vec<_> = read("frame.pgm").samples().iter().map(|sample| sample.min(&3900)).copied().collect();
    let raised = plain.iter().enumerate().map(|(place, sample)| sample + level(place));
    for (name, samples) in [("plain", plain.clone()), ("raised", raised.collect())] {
        let bytes = samples.into_iter().flat_map(u16::to_be_bytes);
        let file: Vec<u8> = b"P5\n96 54\n4095\n".iter().copied().chain(bytes).collect();
        folder.write(&format!("{name}.pgm"), file);
    }
    let correct = |radius: &str, input: &str, output: &str| {
        let size = ["correct", "--width", "96", "--height", "54", "--model", "--radius", radius];
        folder.halfrow(size.into_iter().chain([input, "-o", output])).succeeded();
    };
    // Of such a lens every sample stays.
    correct("1e8", "raised.pgm", "raised.dng");
    tag(&folder, "raised.dng", &["BlackLevelRepeatDim=2 2", "BlackLevel=64 70 61 66"]);
    correct("55", "plain.pgm", "plain-out.pgm");
    correct("55", "raised.dng", "raised-out.pgm");
    let (before, after) = (read("plain-out.pgm"), read("raised-out.pgm"));
    let unlimited = |sample: u16| sample > 0 && sample < 4095;
    let pairs = before.samples().iter().zip(after.samples()).enumerate();
    let judged: Vec<_> =
        pairs.filter(|(_, (before, after))| unlimited(**before) && unlimited(**after)).collect();
    assert!(judged.len() > 4000, "{}", judged.len());
    assert!(judged.iter().all(|(place, (before, after))| **before + level(*place) == **after));
}

/// dcraw with its own bilinear interpolation, the file's colours and white, sRGB's curve, and no brightening. Both round to 8
/// bits, dcraw also to 16 on the way; and at the border they average different neighbours.
#[test]
fn dcraw_develops_the_picture_that_the_preview_shows() {
    const SIZE: (usize, usize) = (320, 180);
    for phase in Phase::ALL {
        let folder = Folder::new();
        let size = ["correct", "--width", "320", "--height", "180", "--radius", "184"];
        let frame = ["builtin:street", "--model", "--phase", phase.name(), "-o", "street.dng"];
        let call = size.into_iter().chain(frame).chain(["--preview", "street.png"]);
        folder.halfrow(call).succeeded();
        let ours = halfrow::frames::read_rgb(&folder.path().join("street.png")).unwrap();
        let how = ["-w", "-W", "-o", "1", "-g", "2.4", "12.92", "-q", "0", "-c", "street.dng"];
        let ppm = printed(&folder, "dcraw", "dcraw", &how);
        let theirs = ppm.strip_prefix(b"P6\n320 180\n255\n").unwrap();
        assert_eq!(((ours.width, ours.height), theirs.len()), (SIZE, ours.data.len()));
        let inside = |place: &usize| {
            let (row, column) = (place / 3 / SIZE.0, place / 3 % SIZE.0);
            (1..SIZE.1 - 1).contains(&row) && (1..SIZE.0 - 1).contains(&column)
        };
        let places = (0..ours.data.len()).filter(inside);
        let farthest = places.map(|place| ours.data[place].abs_diff(theirs[place])).max();
        assert!(farthest <= Some(1), "{phase}: {farthest:?}");
        let (least, most) = (ours.data.iter().min(), ours.data.iter().max());
        assert!(least < Some(&40) && most > Some(&200), "a picture that shows something: {least:?} {most:?}");
    }
}

/// LibRaw's own developer makes a picture of it.
#[test]
fn libraw_develops_it() {
    let (folder, _) = corrected(Phase::Rggb, BitDepth::Ten);
    printed(&folder, "libraw-bin", "dcraw_emu", &["-w", "-W", "frame.dng"]);
    assert!(folder.read("frame.dng.ppm").starts_with(b"P6\n96 54\n255\n"));
}

/// The file can be read again, and a wrong phase or depth is noticed.
#[test]
fn it_can_be_corrected_again() {
    let (folder, _) = corrected(Phase::Gbrg, BitDepth::Ten);
    let again = |input: &str, output: &str, phase: &str, bits: &str| {
        let size = ["correct", "--width", "96", "--height", "54", "--radius", "55", "--model"];
        let [input, output] = [input, output].map(|name| folder.path().join(name).display().to_string());
        let call = [&input, "-o", &output, "--phase", phase, "--bits", bits];
        halfrow(size.into_iter().chain(call))
    };
    again("frame.dng", "twice.pgm", "gbrg", "10").succeeded();
    again("frame.pgm", "expected.pgm", "gbrg", "10").succeeded();
    assert!(folder.read("twice.pgm") == folder.read("expected.pgm"));
    for (phase, bits, remedy) in [
        ("grbg", "10", "its colours lie as gbrg, not as grbg; name the phase (--phase) gbrg"),
        (
            "gbrg",
            "12",
            "its white is 1023, which is not that of samples of 12 bits; name the bits (--bits) 10",
        ),
    ] {
        let refused = again("frame.dng", "none.pgm", phase, bits);
        assert_eq!(refused.code, Some(2));
        assert!(refused.stderr.contains(remedy), "{}", refused.stderr);
    }
}
