//! Frame files that cannot be streamed: each is refused with its own message, and nothing is written.

use halfrow_tests::program::{Folder, finish};

use crate::{refused, small};

/// A folder with a frame of the small size in every format.
fn frames() -> Folder {
    let folder = Folder::new();
    for name in ["frame.pgm", "frame.png", "frame.tif", "frame.raw"] {
        folder.halfrow(small("correct", &["builtin:noise", "--model", "-o", name])).succeeded();
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
    bad_frame(&folder, "short.png", &[], "short.png cannot be used as a frame");
    cut("frame.tif", "short.tif", 100);
    bad_frame(&folder, "short.tif", &[], "short.tif cannot be used as a frame");
    cut("frame.raw", "short.raw", 2);
    bad_frame(
        &folder,
        "short.raw",
        &["--raw", "u16le"],
        "it has 4094 bytes of samples where its size calls for 4096",
    );
    folder.write("empty.pgm", "");
    bad_frame(&folder, "empty.pgm", &[], "it is empty; copy or export it again");
}

#[test]
fn a_file_that_goes_on_is_refused() {
    let folder = frames();
    for (name, long, options) in
        [("frame.pgm", "long.pgm", &[][..]), ("frame.raw", "long.raw", &["--raw", "u16le"])]
    {
        folder.write(long, [folder.read(name), vec![0; 3]].concat());
        bad_frame(&folder, long, options, "it has 3 more bytes after its last sample");
    }
}

#[test]
fn a_frame_of_another_size_is_refused_with_the_size_that_would_do() {
    let folder = frames();
    let other = ["--width", "128", "--height", "18", "--only", "black", "-o", "other"];
    folder.halfrow(["frames"].into_iter().chain(other)).succeeded();
    bad_frame(&folder, "other/black.pgm", &[], "is 128 x 18, and the tables are for 128 x 16");
    bad_frame(&folder, "frame.raw", &["--raw", "u8"], "it has 2048 more bytes");
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
    bad_frame(
        &folder,
        "notes.txt",
        &[],
        "it begins like no format known here (PGM P5, PNG, TIFF, DNG, JPEG, WebP, BMP)",
    );
    folder.write("photo.jpg", b"\xff\xd8\xff\xe0");
    bad_frame(&folder, "photo.jpg", &[], "the JPEG is damaged: it breaks off; copy or export it again");
    folder.write("plain.pgm", "P2\n2 2\n255\n0 0 0 0\n");
    bad_frame(&folder, "plain.pgm", &[], "plain text (P2)");
    folder.write("zero.pgm", "P5\n0 16\n4095\n");
    bad_frame(&folder, "zero.pgm", &[], "zero.pgm cannot be used as a frame");
    folder.write("huge.pgm", "P5\n99999999 16\n4095\n");
    bad_frame(&folder, "huge.pgm", &[], "it is 99999999 x 16");
    folder.write("deep.pgm", "P5\n128 16\n65536\n");
    bad_frame(&folder, "deep.pgm", &[], "the PGM maxval is 65536");
    folder.write("wide.pgm", "P5\n12345678901234567890123 16\n4095\n");
    bad_frame(
        &folder,
        "wide.pgm",
        &[],
        "the PGM header's width at byte 3 has 23 digits, more than any frame's",
    );
    std::fs::create_dir(folder.path().join("folder.pgm")).unwrap();
    bad_frame(&folder, "folder.pgm", &[], "cannot read folder.pgm");
}

#[test]
fn formats_that_people_have_are_refused_by_their_names() {
    let folder = Folder::new();
    for (bytes, sentence) in [
        (&b"II+\0\x08\0\0\0"[..], "a BigTIFF cannot be used; save it as a classic TIFF"),
        (b"MM\0+\0\x08\0\0", "a BigTIFF cannot be used"),
        (b"\0\0\0\x18ftypheic\0\0\0\0", "a HEIC cannot be used; convert it to JPEG or PNG"),
        (b"\0\0\0\x18ftypmif1\0\0\0\0", "a HEIC cannot be used"),
        (b"\0\0\0\x1cftypavif\0\0\0\0", "an AVIF cannot be used; convert it to JPEG or PNG"),
        (b"RIFF\x24\0\0\0WEBPVP8 ", "the WebP is damaged: it breaks off"),
        (b"BM\x36\0\0\0", "the BMP is damaged: it breaks off"),
        (b"\0\0\0\x0cJXL \r\n\x87\n", "a JPEG XL cannot be used; convert it to JPEG or PNG"),
        (b"GIF89a", "a GIF cannot be used; convert it to PNG or TIFF"),
        (b"P7\nWIDTH 2\n", "a PAM cannot be used; convert it to PGM (P5), PNG or TIFF"),
        (b"P4\n8 1\n\0", "a PBM, black and white, cannot be used"),
        (b"\0\x01\x02\x03", "or name the layout (--raw) of samples without a header"),
    ] {
        folder.write("frame", bytes);
        bad_frame(&folder, "frame", &[], sentence);
    }
}

#[test]
fn a_picture_that_no_board_takes_is_to_be_scaled() {
    let folder = Folder::new();
    folder.write("phone.pgm", [b"P5\n4032 3024\n255\n".to_vec(), vec![0; 4032 * 3024]].concat());
    bad_frame(
        &folder,
        "phone.pgm",
        &[],
        "an even number of columns from 64 to 2592 and up to 2048 rows; scale or crop",
    );
    folder.write("odd.pgm", [b"P5\n129 16\n255\n".to_vec(), vec![0; 129 * 16]].concat());
    let ended = folder.halfrow(small("correct", &["odd.pgm", "--model", "-o", "out.pgm"]));
    assert!(ended.code == Some(2) && !ended.stderr.contains("halfrow tables"), "{}", ended.stderr);
}

/// A damaged chunk, reported without the names of the decoder's own types: the width, and a sample.
#[test]
fn a_damaged_png_is_told_in_plain_words() {
    let folder = frames();
    let sound = folder.read("frame.png");
    for (place, said) in [
        (19, "while decoding IHDR chunk; copy or export it again"),
        (
            sound.len() / 2,
            "its packed samples are corrupt, or not those of their checksum; copy or export it again",
        ),
    ] {
        let mut damaged = sound.clone();
        damaged[place] ^= 0x55;
        folder.write("damaged.png", &damaged);
        let ended = folder.halfrow(small("verify", &["--frame", "damaged.png"]));
        assert_eq!(ended.code, Some(2));
        assert!(ended.stderr.contains("the PNG is damaged: "), "{}", ended.stderr);
        assert!(ended.stderr.contains(said), "{}", ended.stderr);
    }
}

#[test]
fn samples_of_few_bits_in_deep_frames_are_told_once() {
    let folder = Folder::new();
    let flat = [b"P5\n128 16\n255\n".to_vec(), vec![200; 128 * 16]].concat();
    folder.write("a.pgm", &flat);
    folder.write("b.pgm", &flat);
    folder.write("c.raw", vec![200; 128 * 16]);
    let said = |more: &[&str]| {
        let ended = folder.halfrow(small("correct", more)).succeeded();
        ended.stderr
    };
    let note = "samples of 0 to 255 are taken as they are, of 0 to 4095, and so are dark; name the bits";
    let both = said(&["-q", "a.pgm", "b.pgm", "--model", "-o", "out"]);
    assert!(both.contains(note) && both.lines().count() == 1 && both.contains(".pgm"), "{both}");
    let raw = said(&["-q", "c.raw", "--raw", "u8", "--model", "-o", "c.pgm"]);
    assert!(raw.contains(note) && raw.contains("c.raw"), "{raw}");
    assert_eq!(said(&["-q", "a.pgm", "--bits", "8", "--model", "-o", "d.pgm"]), "");
    let ended = folder.halfrow(small("verify", &["-q", "--frame", "a.pgm", "--frame", "b.pgm"]));
    assert!(ended.code == Some(0) && ended.stderr.contains(note), "{}", ended.stderr);
}

/// A pipe cannot be read again to compare its hash with what was judged.
#[test]
fn a_pipe_is_no_frame_to_judge_with() {
    let folder = Folder::new();
    let pipe = folder.path().join("pipe.pgm");
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let sentence = "pipe.pgm is a pipe or a device, and its bytes could not be looked at again; write it to a file, and name that";
    refused(&folder, &small("verify", &["--frame", "pipe.pgm"]), sentence);
    refused(&folder, &["verify", "--tables", "pipe.pgm"], sentence);
    refused(&folder, &["verify", "--lens", "pipe.pgm"], sentence);
}

/// Nothing is wrong with a name or with rights then.
#[test]
fn what_the_system_fails_to_do_asks_for_something_of_the_system() {
    let folder = Folder::new();
    folder.halfrow(small("correct", &["builtin:bars", "--model", "-o", "in.pgm"])).succeeded();
    let call = small("correct", &["--json", "in.pgm", "--model", "-o", "out.pgm"]);
    for (error, code, asked) in [
        ("EIO", 3, "Look for a fault of the disk or device in the system's log, then run again."),
        ("EMFILE", 3, "End other programs or allow more open files, then run again."),
        ("EACCES", 2, "Check that it exists and that you may read it."),
    ] {
        let line = format!("exec strace -f -qq -o /dev/null -P in.pgm -e inject=openat:error={error} \"$@\"");
        let ended = finish(&mut folder.by_shell(&line, call.clone()));
        assert_eq!((ended.code, &ended.json()["error"]["remedy"]), (Some(code), &asked.into()), "{ended:?}");
        let message = ended.json()["error"]["message"].as_str().unwrap().to_lowercase();
        let act = asked.trim_end_matches('.').to_lowercase();
        assert_eq!(message, format!("cannot read in.pgm; {act}"));
    }
    let line = "exec strace -f -qq -o /dev/null -e inject=mkdir:error=ENOSPC \"$@\"";
    let ended = finish(&mut folder.by_shell(line, small("verify", &["--report", "out"])));
    assert!(ended.stderr.contains("cannot prepare the report's folder out; free some space"), "{ended:?}");
}

/// File names are bytes, and need not be text.
#[test]
fn files_whose_names_are_no_text_are_read() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt as _;
    let folder = Folder::new();
    let name = OsStr::from_bytes(b"caf\xe9.pgm");
    folder.halfrow(small("correct", &["builtin:bars", "--model", "-o", "bars.pgm"])).succeeded();
    std::fs::rename(folder.path().join("bars.pgm"), folder.path().join(name)).unwrap();
    let verify = folder.command(small("verify", &["-q", "--json", "--frame"])).arg(name).output().unwrap();
    assert_eq!(verify.status.code(), Some(0), "{}", String::from_utf8_lossy(&verify.stderr));
    let correct =
        folder.command(small("correct", &["-q", "--model", "-o", "out.pgm"])).arg(name).output().unwrap();
    assert_eq!(correct.status.code(), Some(0), "{}", String::from_utf8_lossy(&correct.stderr));
    // The file of each in a folder keeps its name.
    let other = OsStr::from_bytes(b"caf\xe8.pgm");
    std::fs::copy(folder.path().join(name), folder.path().join(other)).unwrap();
    let mut both = folder.command(small("correct", &["-q", "--model", "-o", "out"]));
    let both = both.args([name, other]).output().unwrap();
    assert_eq!(both.status.code(), Some(0), "{}", String::from_utf8_lossy(&both.stderr));
    assert!([name, other].iter().all(|name| folder.path().join("out").join(name).is_file()));
    let board = folder.command(["info", "--board"]).arg(name).output().unwrap();
    let said = String::from_utf8_lossy(&board.stderr);
    assert!(board.status.code() == Some(2) && said.contains("--board <TARGET>"), "{said}");
}

#[test]
fn a_file_s_name_stays_as_it_is_where_it_reads_like_a_setting() {
    let folder = Folder::new();
    folder.write("name the bits.pgm", "P5\n128 16\n255\n");
    let call = small("correct", &["--json", "name the bits.pgm", "--model", "-o", "out.pgm"]);
    let ended = folder.halfrow(call);
    let sentence = "name the bits.pgm cannot be used as a frame";
    assert!(ended.stderr.starts_with(&format!("error: {sentence}: ")), "{}", ended.stderr);
    assert_eq!(ended.json()["error"]["message"], sentence);
}

/// The log warns of samples of 8 bits in a frame of 10, and names the file.
#[test]
fn a_file_s_name_does_nothing_to_a_terminal() {
    let folder = Folder::new();
    let name = "esc\u{1b}[31m.pgm";
    folder.write(name, [&b"P5\n128 16\n255\n"[..], &[0; 128 * 16]].concat());
    let ended = folder.halfrow(small("correct", &[name, "--model", "-o", "out.pgm"])).succeeded();
    assert!(ended.stderr.contains("path=esc\\u{1b}[31m.pgm"), "{:?}", ended.stderr);
    assert!(!ended.stderr.contains('\u{1b}'), "{:?}", ended.stderr);
}

/// A TIFF of 128 x 16 whose directory comes first, as scanners write it, and whose samples are cut off.
#[test]
fn a_tiff_without_all_of_its_samples_is_told_once() {
    let folder = Folder::new();
    // Tag, type (3 for 16 bits, 4 for 32) and value; the samples begin after these nine entries.
    let entries: [(u16, u16, u32); 9] = [
        (256, 4, 128),
        (257, 4, 16),
        (258, 3, 16),
        (259, 3, 1),
        (262, 3, 1),
        (273, 4, 8 + 2 + 9 * 12 + 4),
        (277, 3, 1),
        (278, 4, 16),
        (279, 4, 4096),
    ];
    let mut bytes = b"II*\0\x08\0\0\0\x09\0".to_vec();
    for (tag, kind, value) in entries {
        bytes.extend([tag.to_le_bytes(), kind.to_le_bytes()].concat());
        bytes.extend([1_u32.to_le_bytes(), value.to_le_bytes()].concat());
    }
    bytes.extend([0; 4]);
    folder.write("whole.tif", [&bytes[..], &[0; 4096]].concat());
    folder.write("short.tif", [&bytes[..], &[0; 100]].concat());
    folder.halfrow(small("verify", &["-q", "--frame", "whole.tif"])).succeeded();
    bad_frame(&folder, "short.tif", &[], "the TIFF is damaged: it breaks off; copy or export it again\n");
}
