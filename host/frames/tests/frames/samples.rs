//! PGM and headerless samples: hand-written bytes, and what must be read from them.

use halfrow_frames::{DecodeError, ReadOptions, UnknownLayout, decode, pgm, raw};
use halfrow_frames::{RawGeometry, RawLayout};
use halfrow_model::{BitDepth, Frame, FrameError, Phase};

fn options(depth: BitDepth) -> ReadOptions {
    ReadOptions { depth, phase: Phase::Rggb, ..ReadOptions::default() }
}

fn frame(width: usize, depth: BitDepth, samples: &[u16]) -> Frame {
    Frame::new(width, depth, Phase::Rggb, samples.to_vec()).unwrap()
}

fn headerless(width: usize, height: usize, layout: RawLayout, depth: BitDepth) -> ReadOptions {
    ReadOptions { raw: Some(RawGeometry { width, height, layout }), ..options(depth) }
}

#[test]
fn a_pgm_of_one_byte_is_read_as_it_is() {
    let file = b"P5\n# made by hand\n4 2 # two rows\n255\n\x00\x01\x7f\xff\x0a\x20\x23\x80";
    let found = decode(file, &options(BitDepth::Eight)).unwrap();
    assert_eq!(found, frame(4, BitDepth::Eight, &[0, 1, 127, 255, 10, 32, 35, 128]));
}

#[test]
fn a_pgm_of_two_bytes_has_the_high_one_first_and_is_never_scaled() {
    let file = b"P5 2 2 4095\n\x00\x01\x0f\xff\x01\x00\x00\xff";
    let found = decode(file, &options(BitDepth::Twelve)).unwrap();
    assert_eq!(found, frame(2, BitDepth::Twelve, &[1, 4095, 256, 255]));
    let small_maxval = decode(b"P5 2 1 7 \x07\x03", &options(BitDepth::Twelve)).unwrap();
    assert_eq!(small_maxval.samples(), [7, 3]);
}

#[test]
fn a_pgm_is_written_with_the_largest_sample_of_its_depth() {
    let encoded = |frame: &Frame| {
        let mut bytes = Vec::new();
        pgm::encode(frame, &mut bytes).unwrap();
        bytes
    };
    assert_eq!(encoded(&frame(2, BitDepth::Eight, &[1, 255])), b"P5\n2 1\n255\n\x01\xff");
    assert_eq!(encoded(&frame(2, BitDepth::Ten, &[1, 1023])), b"P5\n2 1\n1023\n\x00\x01\x03\xff");
    assert_eq!(encoded(&frame(2, BitDepth::Twelve, &[4095, 2])), b"P5\n2 1\n4095\n\x0f\xff\x00\x02");
}

#[test]
fn a_pgm_sample_above_the_depth_or_the_maxval_names_its_place() {
    let file = b"P5 2 2 4095\n\x00\x01\x00\x02\x00\x03\x0f\xff";
    let error = decode(file, &options(BitDepth::Ten)).unwrap_err();
    let place = FrameError::TooBright { row: 1, column: 1, value: 4095, max: 1023, bits: 10 };
    assert!(matches!(error, DecodeError::Frame(found) if found == place));
    let error = decode(b"P5 2 2 9\n\x01\x02\x0a\x03", &options(BitDepth::Eight)).unwrap_err();
    assert!(matches!(error, DecodeError::AboveMaxval { row: 1, column: 0, value: 10, maxval: 9 }));
}

#[test]
fn a_malformed_pgm_header_names_the_byte() {
    let error = |bytes: &[u8]| decode(bytes, &options(BitDepth::Eight)).unwrap_err();
    let at = |bytes: &[u8]| match error(bytes) {
        DecodeError::PgmHeader { wanted, offset } => (wanted, offset),
        other => panic!("{other}"),
    };
    assert_eq!(at(b"P54 2 255\n"), ("width", 2));
    assert_eq!(at(b"P5 4 -2 255\n"), ("height", 5));
    assert_eq!(at(b"P5 4 2 "), ("maxval", 7));
    let long = error(b"P5 99999999999 2 255\n");
    assert!(matches!(long, DecodeError::PgmNumber { wanted: "width", offset: 3, digits: 11 }), "{long}");
    assert_eq!(at(b"P5 4 2 255"), ("white space after the maxval", 10));
    assert!(matches!(error(b"P5 2 1 0\n"), DecodeError::PgmMaxval(0)));
    assert!(matches!(error(b"P5 2 1 65536\n"), DecodeError::PgmMaxval(65536)));
    assert!(matches!(error(b"P5 9000 1 255\n"), DecodeError::TooLarge { width: 9000, height: 1 }));
    assert!(matches!(error(b"P5 3 1 255\n123"), DecodeError::Frame(FrameError::OddWidth(3))));
    assert!(matches!(error(b"P5 0 0 255\n"), DecodeError::Frame(FrameError::Empty)));
    assert!(matches!(error(b"P5 2 2 255\n123"), DecodeError::Truncated { expected: 4, found: 3 }));
    assert!(matches!(error(b"P5 2 1 255\n123"), DecodeError::Trailing { extra: 1, .. }));
}

#[test]
fn relatives_of_known_formats_are_refused_with_a_remedy() {
    let error = |bytes: &[u8]| decode(bytes, &options(BitDepth::Eight)).unwrap_err();
    assert!(error(b"P2 2 1 255 1 2").to_string().ends_with("convert it to the binary kind (P5)"));
    assert!(error(b"P6 2 1 255\n").to_string().ends_with("convert it to PNG or TIFF"));
    assert!(matches!(error(b"\x00\x01\x02\x03"), DecodeError::UnknownFormat));
    assert!(matches!(error(b""), DecodeError::Empty));
}

/// Four samples of 10 bits whose bits show where they went: 0x2a5 = 10_1010_0101 and so on.
#[test]
fn mipi10_holds_the_low_bits_of_the_first_sample_lowest() {
    let samples = [0x2a5, 0x3ff, 0x000, 0x002];
    let bytes = [0b1010_1001, 0xff, 0x00, 0x00, 0b10_00_11_01];
    let how = headerless(4, 1, RawLayout::Mipi10, BitDepth::Ten);
    assert_eq!(decode(&bytes, &how).unwrap(), frame(4, BitDepth::Ten, &samples));
}

#[test]
fn mipi12_holds_the_low_nibble_of_the_first_sample_lowest() {
    let how = headerless(4, 1, RawLayout::Mipi12, BitDepth::Twelve);
    let found = decode(&[0xab, 0x12, 0x3c, 0xff, 0x00, 0x1f], &how).unwrap();
    assert_eq!(found, frame(4, BitDepth::Twelve, &[0xabc, 0x123, 0xfff, 0x001]));
}

#[test]
fn plain_samples_have_the_low_byte_first() {
    let words = headerless(2, 2, RawLayout::U16Le, BitDepth::Twelve);
    let file = [0x34, 0x02, 0xff, 0x0f, 0x00, 0x01, 0x01, 0x00];
    let found = decode(&file, &words).unwrap();
    assert_eq!(found.samples(), [0x234, 0xfff, 0x100, 0x001]);
    let mut written = Vec::new();
    raw::encode(&found, &mut written).unwrap();
    assert_eq!(written, file);
    let bytes = headerless(2, 1, RawLayout::U8, BitDepth::Eight);
    assert_eq!(decode(b"P5", &bytes).unwrap().samples(), [0x50, 0x35]);
}

#[test]
fn headerless_files_must_have_exactly_the_length_of_their_geometry() {
    let how = headerless(4, 2, RawLayout::Mipi10, BitDepth::Ten);
    assert!(matches!(decode(&[0; 9], &how), Err(DecodeError::Truncated { expected: 10, found: 9 })));
    // 12 bytes may be rows of 6, but 11 are no whole rows, and 20 are two frames.
    for (length, wanted) in [(12, Some(1)), (11, None), (20, None)] {
        let found = decode(&vec![0; length], &how).unwrap_err();
        let DecodeError::Trailing { extra, padding } = found else { panic!("{found}") };
        assert_eq!((extra, padding), (length - 10, wanted));
    }
    let huge = headerless(usize::MAX - 1, usize::MAX, RawLayout::U8, BitDepth::Eight);
    assert!(matches!(decode(&[0; 9], &huge), Err(DecodeError::TooLarge { .. })));
}

#[test]
fn a_row_of_incomplete_groups_is_refused() {
    let how = headerless(6, 2, RawLayout::Mipi10, BitDepth::Ten);
    let error = decode(&[0; 15], &how).unwrap_err().to_string();
    assert_eq!(
        error,
        "mipi10 packs 4 samples together, and 6 columns are no whole number of groups; use u16le"
    );
}

#[test]
fn a_layout_may_have_more_bits_than_its_samples() {
    let found = |width, height, layout, depth, bytes: &[u8]| {
        decode(bytes, &headerless(width, height, layout, depth)).unwrap().samples().to_vec()
    };
    let packed = [0b0010_1001, 0b0011_1111, 0x00, 0x00, 0b10_00_11_01];
    assert_eq!(found(4, 1, RawLayout::Mipi10, BitDepth::Eight, &packed), [0xa5, 0xff, 0x00, 0x02]);
    let packed = [0x2a, 0x3f, 0xf5, 0x00, 0x01, 0x21];
    assert_eq!(found(2, 2, RawLayout::Mipi12, BitDepth::Ten, &packed), [0x2a5, 0x3ff, 0x001, 0x012]);
    assert_eq!(found(2, 1, RawLayout::U16Le, BitDepth::Eight, &[0xa5, 0, 0xff, 0]), [0xa5, 0xff]);
}

#[test]
fn a_layout_is_read_from_its_name() {
    for layout in RawLayout::ALL {
        assert_eq!(layout.to_string().to_uppercase().parse(), Ok(layout));
    }
    let error: UnknownLayout = "mipi8".parse::<RawLayout>().unwrap_err();
    assert_eq!(error.to_string(), "`mipi8` is no layout of raw samples; use u8, u16le, mipi10 or mipi12");
}
