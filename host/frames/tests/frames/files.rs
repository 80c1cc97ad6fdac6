//! Frames on disk.

use std::error::Error;
use std::fs;

use halfrow_files::written_aside::WriteAsideError;
use halfrow_frames::{
    Camera, DecodeError, EncodeError, FrameShape, RawGeometry, RawLayout, ReadError, ReadOptions, WriteError,
    read, read_shown, write, write_rows,
};
use halfrow_model::{BitDepth, Frame, FrameError, Phase};

fn frame() -> Frame {
    let samples = (0..64 * 3).map(|place| place * 21).collect();
    Frame::new(64, BitDepth::Twelve, Phase::Grbg, samples).unwrap()
}

#[test]
fn a_frame_survives_every_format() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["a.pgm", "a.png", "a.tif", "a.tiff", "a.dng", "a.PGM"] {
        let path = folder.path().join(name);
        write(&path, &frame(), false).unwrap();
        assert_eq!(read(&path, &ReadOptions::default()).unwrap(), frame(), "{name}");
    }
    let path = folder.path().join("a.raw");
    write(&path, &frame(), false).unwrap();
    let raw = Some(RawGeometry { width: 64, height: 3, layout: RawLayout::U16Le });
    assert_eq!(read(&path, &ReadOptions { raw, ..ReadOptions::default() }).unwrap(), frame());
}

#[test]
fn the_bytes_tell_the_format_and_not_the_name() {
    let folder = tempfile::tempdir().unwrap();
    let (written, renamed) = (folder.path().join("a.png"), folder.path().join("a.dat"));
    write(&written, &frame(), false).unwrap();
    fs::rename(&written, &renamed).unwrap();
    assert_eq!(read(&renamed, &ReadOptions::default()).unwrap(), frame());
}

#[test]
fn an_existing_file_is_replaced_only_when_told_to() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.pgm");
    fs::write(&path, "mine").unwrap();
    assert!(matches!(write(&path, &frame(), false), Err(WriteError::File(WriteAsideError::Exists { .. }))));
    assert_eq!(fs::read(&path).unwrap(), b"mine");
    write(&path, &frame(), true).unwrap();
    assert_eq!(read(&path, &ReadOptions::default()).unwrap(), frame());
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "nothing is left beside it");
}

#[test]
fn a_name_without_a_known_format_is_refused() {
    for name in ["a", "a.jpg", ".pgm"] {
        let error = write(name.as_ref(), &frame(), true).unwrap_err().to_string();
        assert_eq!(
            error,
            format!(
                "the name {name} does not tell the format; end it in .pgm, .png, .tif, .tiff, .dng or .raw"
            )
        );
    }
}

#[test]
fn an_error_names_the_file_and_carries_its_cause() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.pgm");
    let missing = read(&path, &ReadOptions::default()).unwrap_err();
    assert!(matches!(missing, ReadError::Io { .. }));
    assert!(missing.to_string().contains("a.pgm"));
    write(&path, &frame(), false).unwrap();
    let ten_bits = ReadOptions { depth: BitDepth::Ten, ..ReadOptions::default() };
    let error = read(&path, &ten_bits).unwrap_err();
    assert!(error.to_string().contains("a.pgm"));
    assert!(
        error.source().unwrap().to_string().starts_with("the sample at row 0, column 49 is 1029, above 1023")
    );
    let nowhere = write(&folder.path().join("no/such/a.pgm"), &frame(), false).unwrap_err();
    assert!(matches!(nowhere, WriteError::File(WriteAsideError::Io { .. })));
}

#[test]
fn rows_that_are_no_frame_are_written_in_no_format() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |name: &str, width, height| {
        let path = folder.path().join(name);
        let shape = FrameShape {
            width,
            height,
            depth: BitDepth::Eight,
            phase: Phase::Grbg,
            camera: Camera::default(),
        };
        let mut row = 0;
        let written = write_rows(&path, &shape, true, |samples| {
            samples[width - 1] = 255 + row;
            row += 1;
            Ok::<(), WriteError>(())
        });
        match written {
            Err(WriteError::Encode { source: EncodeError::Frame(error), .. }) if !path.exists() => error,
            other => panic!("{name}: {other:?}"),
        }
    };
    for name in ["a.pgm", "a.raw", "a.png", "a.tif", "a.dng"] {
        let too_bright = FrameError::TooBright { row: 1, column: 1, value: 256, max: 255, bits: 8 };
        assert_eq!(refused(name, 2, 2), too_bright);
        assert_eq!(refused(name, 3, 3), FrameError::OddWidth(3));
        assert_eq!(refused(name, 0, 2), FrameError::Empty);
        assert_eq!(refused(name, 2, 0), FrameError::Empty);
    }
}

#[test]
fn what_is_no_picture_is_told_all_kinds_that_are_taken() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.jpg");
    let shown = |bytes: &[u8]| {
        fs::write(&path, bytes).unwrap();
        match read_shown(&path) {
            Err(ReadError::Decode { source, .. }) => source,
            other => panic!("{other:?}"),
        }
    };
    assert!(matches!(shown(b""), DecodeError::Empty));
    let broken = shown(b"\x00\xd8\xff\xe0").to_string();
    assert_eq!(
        broken,
        "what begins like no PNG, JPEG, WebP or BMP cannot be used; give one of these, or export it again"
    );
}
