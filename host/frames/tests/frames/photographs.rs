//! Photographs that were made with Pillow (`tests/photographs/make.py`). Beside each is a PNG of what Pillow shows of it.

use std::fs;
use std::path::{Path, PathBuf};

use halfrow_frames::preview::{RgbImage, encode_png_rgb};
use halfrow_frames::{DecodeError, FrameFile, PictureSize, ReadError, ReadOptions, decode, mosaic, read};
use halfrow_frames::{RowReader, read_rgb, read_shown};
use halfrow_model::{BitDepth, Phase};
use proptest::prelude::*;
use proptest::sample::{Index, select};

/// Every photograph that is read, and the largest allowed difference from Pillow's samples: decoders of JPEG and lossy WebP may
/// round in each step, and have different filters to enlarge colours that are stored at half the size.
const READ: [(&str, u16); 19] = [
    ("baseline.jpg", 2),
    ("subsampled.jpg", 5),
    ("progressive.jpg", 2),
    ("grey.jpg", 2),
    ("turned2.jpg", 2),
    ("turned3.jpg", 2),
    ("turned4.jpg", 2),
    ("turned5.jpg", 2),
    ("turned6.jpg", 2),
    ("turned7.jpg", 2),
    ("turned8.jpg", 2),
    ("lossy.webp", 2),
    ("lossless.webp", 0),
    ("turned6.webp", 0),
    ("alpha.webp", 0),
    ("colour.bmp", 0),
    ("palette.bmp", 0),
    ("grey.bmp", 0),
    ("alpha.bmp", 0),
];

fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/photographs").join(name)
}

fn bytes(name: &str) -> Vec<u8> {
    fs::read(path(name)).unwrap()
}

fn of_eight_bits(phase: Phase) -> ReadOptions {
    ReadOptions { depth: BitDepth::Eight, phase, ..ReadOptions::default() }
}

/// What Pillow shows, and its samples under a filter array.
fn shown(name: &str, phase: Phase) -> (RgbImage, Vec<u16>) {
    let image = read_rgb(&path(name)).unwrap();
    let samples = mosaic(&image, phase).unwrap().samples().to_vec();
    (image, samples)
}

/// The largest difference between the samples of two frames.
fn apart(found: &[u16], wanted: &[u16]) -> u16 {
    assert_eq!(found.len(), wanted.len());
    found.iter().zip(wanted).map(|(found, wanted)| found.abs_diff(*wanted)).max().unwrap()
}

#[test]
fn photographs_are_what_another_program_shows() {
    for (name, most) in READ {
        for phase in Phase::ALL {
            let (image, wanted) = shown(&format!("{name}.png"), phase);
            let frame = read(&path(name), &of_eight_bits(phase)).unwrap();
            assert_eq!((frame.width(), frame.height()), (image.width, image.height), "{name}");
            let apart = apart(frame.samples(), &wanted);
            assert!(apart <= most, "{name}, {phase}: {apart}");
        }
    }
}

/// 8 bits become 12 as v · 4095 / 255, rounded to the nearest; grey too.
#[test]
fn a_photograph_is_scaled_to_the_depth() {
    for name in ["lossless.webp", "grey.bmp"] {
        let (_, shown) = shown(&format!("{name}.png"), Phase::Rggb);
        let wanted: Vec<u16> =
            shown.into_iter().map(|value| (f64::from(value) * 4095.0 / 255.0).round() as u16).collect();
        let how = ReadOptions { depth: BitDepth::Twelve, phase: Phase::Rggb, ..ReadOptions::default() };
        assert_eq!(read(&path(name), &how).unwrap().samples(), wanted, "{name}");
    }
}

/// Turned by EXIF first, then cropped and scaled; Pillow rounds between its passes.
#[test]
fn fitted_pictures_are_cropped_about_their_centre_and_scaled() {
    for (name, (width, height), said) in [
        (
            "large.webp",
            (64, 48),
            "160 x 200, cropped to 160 x 120 about its centre, 60 % of it, scaled to 64 x 48 (Catmull-Rom)",
        ),
        (
            "small.png",
            (192, 96),
            "160 x 100, cropped to 160 x 80 about its centre, 80 % of it, scaled to 192 x 96 (Catmull-Rom)",
        ),
    ] {
        let how = ReadOptions { size: PictureSize::Fitted(width, height), ..of_eight_bits(Phase::Grbg) };
        let decoded = FrameFile::read(&path(name)).unwrap().decode(&how).unwrap();
        let stem = name.split('.').next().unwrap();
        let (_, wanted) = shown(&format!("{stem}.fitted.png"), Phase::Grbg);
        assert_eq!((decoded.frame.width(), decoded.frame.height()), (width, height));
        let apart = apart(decoded.frame.samples(), &wanted);
        assert!(apart <= 2, "{name}: {apart}");
        assert_eq!(decoded.fitting.unwrap().to_string(), said);
        assert_eq!(RowReader::open(&path(name), &how).unwrap().fitting(), decoded.fitting);
    }
}

/// A bright window in a dark wall: cubic scaling overshoots beyond white at its edges, whatever the format of the file.
#[test]
fn scaling_does_not_overshoot_white() {
    let (width, height) = (96, 64);
    let is_window = |place: usize| (30..60).contains(&(place % width)) && (20..40).contains(&(place / width));
    let data = (0..width * height).flat_map(|place| [if is_window(place) { 255 } else { 20 }; 3]).collect();
    let picture = RgbImage { width, height, data };
    let mut png = Vec::new();
    encode_png_rgb(&picture, &mut png).unwrap();
    // A BMP: 54 bytes of headers, then the rows from the last to the first.
    let mut bmp =
        [&b"BM"[..], &[0; 8], &[54, 0, 0, 0, 40, 0, 0, 0, 96, 0, 0, 0, 64, 0, 0, 0, 1, 0, 24, 0], &[0; 24]]
            .concat();
    bmp.extend(picture.data.chunks_exact(3 * width).rev().flatten());
    for size in [(160, 106), (64, 42)] {
        let how = ReadOptions { size: PictureSize::Fitted(size.0, size.1), ..of_eight_bits(Phase::Grbg) };
        let [png, bmp] = [&png, &bmp].map(|file| decode(file, &how).unwrap());
        assert_eq!(png.samples().iter().max(), Some(&255));
        assert_eq!(png, bmp, "{size:?}");
    }
}

#[test]
fn what_has_the_size_is_not_fitted_and_what_has_not_is_refused() {
    let turned = FrameFile::read(&path("turned6.webp")).unwrap();
    let sized = |size| turned.decode(&ReadOptions { size, ..of_eight_bits(Phase::Grbg) });
    assert_eq!(sized(PictureSize::Fitted(48, 72)).unwrap().fitting, None);
    assert_eq!(sized(PictureSize::Exactly(48, 72)).unwrap().fitting, None);
    let ReadError::Decode { source, .. } = sized(PictureSize::Exactly(72, 48)).unwrap_err() else { panic!() };
    assert!(matches!(source, DecodeError::OtherSize { width: 48, height: 72, columns: 72, rows: 48 }));
    let cropped = sized(PictureSize::Fitted(48, 40)).unwrap().fitting.unwrap();
    assert_eq!(cropped.to_string(), "48 x 72, cropped to 48 x 40 about its centre, 55 % of it");
}

#[test]
fn kinds_that_are_not_taken_are_named() {
    let refused = |bytes: &[u8]| match decode(bytes, &ReadOptions::default()).unwrap_err() {
        DecodeError::Unsupported { what, .. } => what,
        other => panic!("{other}"),
    };
    assert_eq!(refused(&bytes("cmyk.jpg")), "a CMYK JPEG");
    assert_eq!(refused(&bytes("animated.webp")), "an animated WebP");
    assert_eq!(refused(&bytes("picture.avif")), "an AVIF");
    // The frame header of a baseline JPEG: ff c0, its length, the bits, the sides and the number of colours.
    let file = bytes("baseline.jpg");
    let header = file.windows(5).position(|window| window == [0xff, 0xc0, 0, 17, 8]).unwrap();
    for (place, value, what) in [
        (1, 0xc3, "a lossless JPEG"),
        (1, 0xc9, "a JPEG that is coded arithmetically"),
        (1, 0xc5, "a hierarchical JPEG"),
        (4, 12, "a JPEG of 12 bits a sample"),
        (9, 2, "a JPEG of 2 colours"),
    ] {
        let mut other = file.clone();
        other[header + place] = value;
        assert_eq!(refused(&other), what);
    }
    // A BMP's compression is at byte 30; 4 means a JPEG inside.
    let mut coded = bytes("colour.bmp");
    coded[30] = 4;
    assert_eq!(refused(&coded), "this kind of BMP");
}

/// A header that asks for 60000 x 60000 is refused before memory is allocated for it.
#[test]
fn a_header_cannot_ask_for_more_than_is_decoded() {
    let (mut jpeg, mut bmp) = (bytes("baseline.jpg"), bytes("colour.bmp"));
    let header = jpeg.windows(4).position(|window| window == [0xff, 0xc0, 0, 17]).unwrap();
    jpeg[header + 5..header + 9].copy_from_slice(&[0xea, 0x60, 0xea, 0x60]);
    bmp[18..22].copy_from_slice(&60_000_u32.to_le_bytes());
    bmp[22..26].copy_from_slice(&60_000_u32.to_le_bytes());
    for file in [jpeg, bmp] {
        let error = decode(&file, &ReadOptions::default()).unwrap_err();
        assert!(matches!(error, DecodeError::TooManyPixels { width: 60_000, height: 60_000 }), "{error}");
        assert!(error.to_string().ends_with("above 100 megapixels; scale it down first"), "{error}");
    }
    // An extended WebP has the sides of its canvas, minus one, at byte 24, in three bytes each.
    let mut webp = bytes("turned6.webp");
    assert_eq!(webp[12..16], *b"VP8X");
    for side in [24, 27] {
        webp[side..side + 3].copy_from_slice(&59_999_u32.to_le_bytes()[..3]);
    }
    assert!(decode(&webp, &ReadOptions::default()).is_err());
}

#[test]
fn every_truncation_is_an_error() {
    for (name, _) in READ {
        let file = bytes(name);
        for length in (0..file.len()).filter(|length| length % 97 == 0 || length + 4 > file.len()) {
            let result = decode(&file[..length], &ReadOptions::default());
            assert!(result.is_err(), "{length} of {} bytes of {name}", file.len());
        }
    }
}

/// A third or half of the coded samples and an end marker as in a whole file: decoders would fill in the rest.
#[test]
fn a_jpeg_with_samples_missing_is_refused() {
    for name in ["baseline.jpg", "subsampled.jpg", "grey.jpg", "turned6.jpg"] {
        let file = bytes(name);
        let scan = file.windows(2).rposition(|pair| pair == [0xff, 0xda]).unwrap() + 14;
        for share in [3, 2] {
            let cut = [&file[..scan + (file.len() - scan) / share], b"\xff\xd9"].concat();
            let error = decode(&cut, &ReadOptions::default()).unwrap_err().to_string();
            assert!(error.starts_with("the JPEG is damaged: it breaks off"), "1/{share} of {name}: {error}");
        }
    }
}

/// 10000 x 9999 in a few kilobytes: each block of 8 x 8 pixels takes at least one bit.
#[test]
fn a_jpeg_of_fewer_bits_than_blocks_is_refused() {
    for (name, frame) in [("baseline.jpg", 0xc0), ("progressive.jpg", 0xc2)] {
        let mut file = bytes(name);
        let header = file.windows(4).position(|window| window == [0xff, frame, 0, 17]).unwrap();
        file[header + 5..header + 9].copy_from_slice(&[0x27, 0x0f, 0x27, 0x10]);
        let error = decode(&file, &ReadOptions::default()).unwrap_err().to_string();
        assert!(error.starts_with("the JPEG is damaged: it breaks off"), "{name}: {error}");
    }
}

/// Decoders of JPEG may round differently from Pillow's.
#[test]
fn photographs_are_shown_as_pictures_of_colours_too() {
    for (name, most) in READ {
        let (found, wanted) =
            (read_shown(&path(name)).unwrap(), read_rgb(&path(&format!("{name}.png"))).unwrap());
        assert_eq!((found.width, found.height), (wanted.width, wanted.height), "{name}");
        let apart = found.data.iter().zip(&wanted.data).map(|(found, wanted)| found.abs_diff(*wanted)).max();
        assert!(apart.map(u16::from) <= Some(most), "{name}: {apart:?}");
        let refused = read_rgb(&path(name)).unwrap_err();
        let ReadError::Decode { source: DecodeError::Unsupported { what, remedy }, .. } = refused else {
            panic!("{name}")
        };
        let format = if name.ends_with("jpg") {
            "a JPEG"
        } else if name.ends_with("webp") {
            "a WebP"
        } else {
            "a BMP"
        };
        assert_eq!((what.as_str(), remedy), (format, "give a PNG in colour, 8 bits a sample"));
    }
    assert_eq!(read_shown(&path("small.png")).unwrap(), read_rgb(&path("small.png")).unwrap());
}

#[test]
fn what_cameras_put_behind_a_jpeg_is_passed_over() {
    let mut file = bytes("baseline.jpg");
    let alone = decode(&file, &ReadOptions::default()).unwrap();
    file.extend_from_slice(&bytes("turned6.jpg"));
    assert_eq!(decode(&file, &ReadOptions::default()).unwrap(), alone);
}

#[test]
fn colours_of_photographs_alone_are_coded_for_the_screen() {
    let how = ReadOptions::default();
    for (name, is_coded) in
        [("baseline.jpg", true), ("lossy.webp", true), ("colour.bmp", true), ("small.png", false)]
    {
        let read = FrameFile::read(&path(name)).unwrap().decode(&how).unwrap();
        let rows = RowReader::open(&path(name), &how).unwrap();
        assert_eq!((read.is_coded, rows.is_coded()), (is_coded, is_coded), "{name}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(600))]

    #[test]
    fn no_damage_makes_a_decoder_panic(
        name in select(READ.map(|(name, _)| name).to_vec()),
        damage in proptest::collection::vec((any::<Index>(), any::<u8>()), 1..8),
    ) {
        let mut file = bytes(name);
        for (place, value) in damage {
            let place = place.index(file.len());
            file[place] = value;
        }
        let how = ReadOptions { size: PictureSize::Exactly(72, 48), ..ReadOptions::default() };
        std::hint::black_box(decode(&file, &how).is_ok());
    }
}
