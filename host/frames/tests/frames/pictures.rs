//! PNG and TIFF files that were written byte by byte with Python's zlib and struct modules, and what must be read from them.
//! The scaled samples were computed in Python with exact fractions.

use halfrow_frames::{DecodeError, Orientation, PictureSize, ReadOptions, decode, png, tiff};
use halfrow_model::{BitDepth, Frame, FrameError, Phase};

/// 4 x 2, grey, 16 bits: [`GREY`].
const PNG_GREY16: &str = "89504e470d0a1a0a0000000d49484452000000040000000210000000000a53fefc0000001a4944415478da63\
    606060606464e0ffcfc0ff8f838141908119001298023a62bd5ce70000000049454e44ae426082";

/// 4 x 2, RGB, 8 bits: (10, 20, 30), (40, 50, 60) ... in steps of 10, the last blue 255.
const PNG_RGB8: &str = "89504e470d0a1a0a0000000d49484452000000040000000208020000\
    00f0caea34000000234944415478da63e01291d330b2710b884ac9ab6068ea99b660d5967d272edd79f61f0068c50bc8\
    8217b7dc0000000049454e44ae426082";

/// The samples of [`PNG_RGB8`] times 257 in 16 bits, with an alpha of 0x1234.
const PNG_RGBA16: &str = "89504e470d0a1a0a0000000d49484452000000040000000210060000002f38a1200000004d4944415478da01\
    4200bdff000a0a14141e1e1234282832323c3c1234464650505a5a123464646e6e787812340082828c8c9696\
    1234a0a0aaaab4b41234bebec8c8d2d21234dcdce6e6ffff12346a6119bff88fcad70000000049454e44ae42\
    6082";

/// 4 x 2 of two bits: red, green, black, blue / blue, green, red, black from a palette.
const PNG_PALETTE: &str = "89504e470d0a1a0a0000000d494844520000000400000002020300000002c695f00000000c504c5445000000\
    ff000000ff000000ff9bc013dc0000000c4944415478da6348667802000211014888aad0020000000049454e\
    44ae426082";

/// 4 x 2, grey, 4 bits.
const PNG_GREY4: &str = "89504e470d0a1a0a0000000d49484452000000040000000204000000009f33cfbe0000000e4944415478da63\
    10326108ab00000254011530b6604f0000000049454e44ae426082";

/// 4 x 2, grey, 16 bits, low byte first: [`GREY`].
const TIFF_LITTLE: &str = "49492a0018000000000001000001ff0ffe0f0008110003000900000103000100000004000000010103000100\
    0000020000000201030001000000100000000301030001000000010000000601030001000000010000001101\
    0400010000000800000015010300010000000100000016010300010000000200000017010400010000001000\
    000000000000";

/// Like [`TIFF_LITTLE`], high byte first.
const TIFF_BIG: &str = "4d4d002a000000180000000101000fff0ffe0800001100030009010000030000000100040000010100030000\
    0001000200000102000300000001001000000103000300000001000100000106000300000001000100000111\
    0004000000010000000801150003000000010001000001160003000000010002000001170004000000010000\
    001000000000";

/// The pixels of [`PNG_RGB8`], packed by deflate.
const TIFF_RGB8: &str = "49492a002900000078dae31291d330b2710b884ac9ab68ea99b660d5967d272edd79f61f0065b70bc8090000\
    010300010000000400000001010300010000000200000002010300030000009b000000030103000100000008\
    0000000601030001000000020000001101040001000000080000001501030001000000030000001601030001\
    0000000200000017010400010000002100000000000000080008000800";

const GREY: [u16; 8] = [0, 1, 256, 4095, 4094, 2048, 17, 3];

/// The bytes that these hexadecimal digits stand for.
pub(super) fn hex(text: &str) -> Vec<u8> {
    let digits: Vec<u32> = text.chars().filter_map(|digit| digit.to_digit(16)).collect();
    digits.chunks(2).map(|pair| u8::try_from(pair[0] * 16 + pair[1]).unwrap()).collect()
}

pub(super) fn options(depth: BitDepth) -> ReadOptions {
    ReadOptions { depth, phase: Phase::Grbg, ..ReadOptions::default() }
}

fn twelve_bits(text: &str) -> Result<Frame, DecodeError> {
    decode(&hex(text), &options(BitDepth::Twelve))
}

#[test]
fn grey_samples_are_taken_as_they_are() {
    for file in [PNG_GREY16, TIFF_LITTLE, TIFF_BIG] {
        let frame = twelve_bits(file).unwrap();
        assert_eq!((frame.width(), frame.height(), frame.samples()), (4, 2, &GREY[..]));
    }
}

#[test]
fn a_sample_keeps_the_colour_of_its_place_scaled_to_the_depth() {
    for file in [PNG_RGB8, TIFF_RGB8] {
        assert_eq!(twelve_bits(file).unwrap().samples(), [321, 642, 1285, 1606, 2409, 2730, 3372, 3694]);
    }
    let bggr = ReadOptions { phase: Phase::Bggr, ..options(BitDepth::Eight) };
    assert_eq!(decode(&hex(PNG_RGB8), &bggr).unwrap().samples(), [30, 50, 90, 110, 140, 160, 200, 220]);
}

#[test]
fn alpha_is_ignored() {
    let frame = decode(&hex(PNG_RGBA16), &options(BitDepth::Ten)).unwrap();
    assert_eq!(frame.samples(), [80, 160, 321, 401, 602, 682, 842, 923]);
    let mut file = Vec::new();
    let mut encoder = ::png::Encoder::new(&mut file, 2, 1);
    encoder.set_color(::png::ColorType::GrayscaleAlpha);
    encoder.write_header().unwrap().write_image_data(&[7, 99, 8, 0]).unwrap();
    assert_eq!(decode(&file, &options(BitDepth::Ten)).unwrap().samples(), [7, 8]);
}

#[test]
fn a_palette_is_colour() {
    let frame = decode(&hex(PNG_PALETTE), &options(BitDepth::Eight)).unwrap();
    assert_eq!(frame.samples(), [0, 0, 0, 0, 255, 255, 0, 0]);
}

#[test]
fn a_grey_sample_above_the_depth_names_its_place() {
    for file in [PNG_GREY16, TIFF_BIG] {
        let error = decode(&hex(file), &options(BitDepth::Ten)).unwrap_err();
        let place = FrameError::TooBright { row: 0, column: 3, value: 4095, max: 1023, bits: 10 };
        assert!(matches!(error, DecodeError::Frame(found) if found == place));
    }
}

#[test]
fn grey_of_fewer_than_eight_bits_is_refused_with_a_remedy() {
    let error = twelve_bits(PNG_GREY4).unwrap_err().to_string();
    assert_eq!(error, "a grey PNG of 4 bits a sample cannot be used; save it with 8 or 16 bits");
}

#[test]
fn bytes_after_the_end_of_a_png_are_an_error() {
    let mut file = hex(PNG_GREY16);
    file.extend([0; 3]);
    assert!(matches!(decode(&file, &options(BitDepth::Twelve)), Err(DecodeError::Trailing { extra: 3, .. })));
}

#[test]
fn every_truncation_is_an_error() {
    // The last four bytes of the grey TIFFs only say that no other picture follows.
    for (text, dispensable) in
        [(PNG_GREY16, 0), (PNG_RGB8, 0), (TIFF_RGB8, 0), (TIFF_LITTLE, 4), (TIFF_BIG, 4)]
    {
        let file = hex(text);
        for length in 0..file.len() - dispensable {
            let result = decode(&file[..length], &options(BitDepth::Twelve));
            assert!(result.is_err(), "{length} bytes of {text}");
        }
    }
}

#[test]
fn a_damaged_byte_of_a_png_is_an_error() {
    let file = hex(PNG_RGB8);
    for place in 0..file.len() {
        let mut damaged = file.clone();
        damaged[place] ^= 0x10;
        assert!(decode(&damaged, &options(BitDepth::Twelve)).is_err(), "byte {place}");
    }
}

#[test]
fn a_header_cannot_ask_for_more_than_its_bytes_can_hold() {
    let error = |side: u16| {
        let mut file = hex(TIFF_LITTLE);
        for (value, now) in [(34, 4), (46, 2)] {
            assert_eq!(file[value], now, "the width and the height stand here");
            file[value..value + 2].copy_from_slice(&side.to_le_bytes());
        }
        decode(&file, &options(BitDepth::Twelve)).unwrap_err()
    };
    assert!(matches!(error(8192), DecodeError::Truncated { .. }));
    assert!(matches!(error(u16::MAX), DecodeError::TooLarge { width: 65535, height: 65535 }));
}

/// The directory of [`TIFF_LITTLE`] begins at byte 24, and each entry, of 12 bytes, ends with its value.
#[test]
fn tiffs_that_are_no_plain_picture_are_refused_with_a_remedy() {
    let remedies = [
        (2, 43, "copy or export the file again"),
        (58, 12, "save it with 8 or 16 bits"),
        (70, 3, "save it uncompressed, or with LZW or deflate"),
        (70, 7, "write its raw samples as a 16-bit TIFF, as `dcraw -D -4 -T -t 0` does"),
        (82, 3, "save it as grey (black is zero) or RGB"),
        (82, 0, "save it as grey (black is zero) or RGB"),
        (106, 2, "save it as grey (black is zero) or RGB"),
        (134, 26, "save each as a file of its own"),
    ];
    for (place, value, remedy) in remedies {
        let mut file = hex(TIFF_LITTLE);
        file[place] = value;
        let error = tiff::decode(&file, &options(BitDepth::Twelve)).unwrap_err().to_string();
        assert!(error.ends_with(remedy), "{value} at {place}: {error}");
    }
}

#[test]
fn what_is_written_is_read_back_exactly() {
    for depth in BitDepth::ALL {
        let samples = (0..64 * 6).map(|place: u16| place.wrapping_mul(40_503) & depth.max()).collect();
        let frame = Frame::new(64, depth, Phase::Grbg, samples).unwrap();
        let (mut as_png, mut as_tiff) = (Vec::new(), std::io::Cursor::new(Vec::new()));
        png::encode(&frame, &mut as_png).unwrap();
        tiff::encode(&frame, Orientation::default(), &mut as_tiff).unwrap();
        assert_eq!(decode(&as_png, &options(depth)).unwrap(), frame);
        assert_eq!(decode(as_tiff.get_ref(), &options(depth)).unwrap(), frame);
    }
}

/// A TIFF of 4 x 2 with this orientation, RGB or RGBA with 8 or 16 bits, every pixel grey: 1 to 8, times 257 in 16 bits.
pub(super) fn oriented(orientation: u16, channels: u16, bits: u16) -> Vec<u8> {
    let short = |tag: u16, value: u16| [tag, 3, 1, 0, value, 0].map(u16::to_le_bytes).concat();
    let long = |tag: u16, value: u32| {
        [[tag, 4, 1, 0].map(u16::to_le_bytes).concat(), value.to_le_bytes().to_vec()].concat()
    };
    let strip = (1..=8_u8).flat_map(|value| vec![value; usize::from(channels * bits / 8)]);
    let strip: Vec<u8> = strip.collect();
    let sizes = [short(256, 4), short(257, 2), short(258, bits), short(259, 1), short(262, 2)];
    let start = 8 + 2 + 10 * 12 + 4;
    let places = [long(273, start), short(274, orientation), short(277, channels), short(278, 2)];
    let length = long(279, u32::try_from(strip.len()).unwrap());
    let entries = [sizes.concat(), places.concat(), length].concat();
    [b"II*\0\x08\0\0\0\x0a\0", &entries[..], &[0; 4], &strip].concat()
}

/// Announced, but not there, so that reading stops before it takes time: a photograph of 24 megapixels in one strip, and the
/// largest picture.
#[test]
fn no_size_that_is_read_at_all_is_beyond_the_decoder() {
    for (width, height, channels) in [(6000_u16, 4000_u16, 3), (8192, 8192, 4)] {
        let mut file = oriented(1, channels, 16);
        let length = u32::from(width) * u32::from(height) * u32::from(channels) * 2;
        for (entry, value) in [(0, width.into()), (1, height.into()), (8, height.into()), (9, length)] {
            let place = 8 + 2 + entry * 12 + 8;
            file[place..place + 4].copy_from_slice(&u32::to_le_bytes(value));
        }
        file.resize(200_000, 0);
        let error = decode(&file, &options(BitDepth::Twelve)).unwrap_err().to_string();
        assert_eq!(error, "the TIFF is damaged: it breaks off; copy or export it again");
    }
}

#[test]
fn a_strip_of_an_impossible_length_is_damage() {
    let mut file = oriented(1, 3, 8);
    let length = 8 + 2 + 9 * 12 + 8;
    file[length..length + 4].copy_from_slice(&[0xff; 4]);
    let error = decode(&file, &options(BitDepth::Eight)).unwrap_err().to_string();
    assert!(error.starts_with("the TIFF is damaged: "), "{error}");
}

/// With a predictor for numbers that are no whole ones in the place of the orientation.
#[test]
fn a_kind_of_tiff_that_the_decoder_does_not_know_is_not_called_damaged() {
    let mut file = oriented(3, 3, 8);
    let entry = 8 + 2 + 6 * 12;
    file[entry..entry + 2].copy_from_slice(&317_u16.to_le_bytes());
    let error = decode(&file, &options(BitDepth::Eight)).unwrap_err().to_string();
    assert_eq!(error, "this kind of TIFF cannot be used; save it as grey or RGB of 8 or 16 bits");
}

/// A PNG of the same samples, with its orientation in EXIF before the picture or after it (`behind`).
fn oriented_png(orientation: u16, channels: usize, bits: u16, behind: bool) -> Vec<u8> {
    let entry = [42, 8, 0, 1, 274, 3, 1, 0, orientation, 0, 0, 0].map(u16::to_le_bytes).concat();
    let block = [b"II", &entry[..]].concat();
    let samples: Vec<u8> = (1..=8).flat_map(|value| vec![value; channels * usize::from(bits / 8)]).collect();
    let mut file = Vec::new();
    let mut encoder = ::png::Encoder::new(&mut file, 4, 2);
    encoder.set_color(if channels == 1 {
        ::png::ColorType::Grayscale
    } else if channels == 3 {
        ::png::ColorType::Rgb
    } else {
        ::png::ColorType::Rgba
    });
    encoder.set_depth(if bits == 8 { ::png::BitDepth::Eight } else { ::png::BitDepth::Sixteen });
    let mut writer = encoder.write_header().unwrap();
    let exif = ::png::chunk::ChunkType(*b"eXIf");
    if !behind {
        writer.write_chunk(exif, &block).unwrap();
    }
    writer.write_image_data(&samples).unwrap();
    if behind {
        writer.write_chunk(exif, &block).unwrap();
    }
    writer.finish().unwrap();
    file
}

/// By TIFF 6.0: orientation, width, and the samples in the order in which they are seen.
const SEEN: [(u16, usize, [u16; 8]); 10] = [
    (1, 4, [1, 2, 3, 4, 5, 6, 7, 8]),
    (2, 4, [4, 3, 2, 1, 8, 7, 6, 5]),
    (3, 4, [8, 7, 6, 5, 4, 3, 2, 1]),
    (4, 4, [5, 6, 7, 8, 1, 2, 3, 4]),
    (5, 2, [1, 5, 2, 6, 3, 7, 4, 8]),
    (6, 2, [5, 1, 6, 2, 7, 3, 8, 4]),
    (7, 2, [8, 4, 7, 3, 6, 2, 5, 1]),
    (8, 2, [4, 8, 3, 7, 2, 6, 1, 5]),
    // Values that are not an orientation.
    (0, 4, [1, 2, 3, 4, 5, 6, 7, 8]),
    (9, 4, [1, 2, 3, 4, 5, 6, 7, 8]),
];

#[test]
fn a_png_in_colour_is_turned_as_its_exif_says() {
    for (orientation, width, samples) in SEEN {
        for (channels, bits, behind) in [(3, 8, false), (4, 8, true), (3, 16, true), (4, 16, false)] {
            let file = oriented_png(orientation, channels, bits, behind);
            let frame = decode(&file, &options(BitDepth::Eight)).unwrap();
            assert_eq!(
                (frame.width(), frame.samples()),
                (width, &samples[..]),
                "{orientation}, {channels} x {bits}"
            );
        }
    }
    let size = PictureSize::Exactly(2, 4);
    let standing =
        decode(&oriented_png(6, 3, 8, false), &ReadOptions { size, ..options(BitDepth::Eight) }).unwrap();
    assert_eq!((standing.width(), standing.height()), (2, 4));
    let raw = decode(&oriented_png(3, 1, 8, false), &options(BitDepth::Eight)).unwrap();
    assert_eq!(raw.samples(), SEEN[0].2, "raw samples stay as they lie");
}

#[test]
fn a_tiff_in_colour_is_turned_as_its_orientation_says() {
    for (orientation, width, samples) in SEEN {
        for (channels, bits) in [(3, 8), (3, 16), (4, 8), (4, 16)] {
            let file = oriented(orientation, channels, bits);
            let frame = decode(&file, &options(BitDepth::Eight)).unwrap();
            assert_eq!(
                (frame.width(), frame.samples()),
                (width, &samples[..]),
                "{orientation}, {channels} x {bits}"
            );
        }
    }
}

#[test]
fn a_turned_tiff_is_fitted_as_it_is_seen() {
    let size = PictureSize::Exactly(2, 4);
    let turned = decode(&oriented(6, 3, 16), &ReadOptions { size, ..options(BitDepth::Eight) }).unwrap();
    assert_eq!((turned.width(), turned.height()), (2, 4));
    let upright = decode(&oriented(3, 3, 16), &ReadOptions { size, ..options(BitDepth::Eight) });
    assert!(matches!(upright, Err(DecodeError::OtherSize { width: 4, height: 2, .. })));
}

/// Other programs write samples up to the full scale of 16 bits, which is not a depth of frames.
#[test]
fn samples_deeper_than_any_frame_are_to_be_scaled() {
    let mut deep = hex(TIFF_LITTLE);
    deep[8..10].copy_from_slice(&[0xff, 0xff]);
    let error = decode(&deep, &options(BitDepth::Twelve)).unwrap_err().to_string();
    assert_eq!(
        error,
        "the sample at row 0, column 0 is 65535, above 4095, and no frame has more than 12 bits; scale it to 12 bits: divide \
         samples of 16 bits by 16, of 14 bits by 4"
    );
}

/// The coded samples here are spoilt, which only unpacking them can show.
#[test]
fn a_picture_of_another_size_is_refused_before_it_is_unpacked() {
    let size = PictureSize::Exactly(64, 16);
    let how = ReadOptions { size, ..options(BitDepth::Eight) };
    let other = |file: &[u8], found: (usize, usize)| {
        let refused = decode(file, &how).unwrap_err();
        let DecodeError::OtherSize { width, height, .. } = refused else { panic!("{refused}") };
        assert_eq!((width, height), found);
    };
    for behind in [false, true] {
        let mut spoilt = oriented_png(6, 4, 16, behind);
        let start = spoilt.windows(4).position(|name| name == b"IDAT").unwrap() + 4;
        spoilt[start..start + 8].fill(0);
        // If EXIF comes after the picture, its orientation is not known yet.
        other(&spoilt, if behind { (4, 2) } else { (2, 4) });
    }
    let mut spoilt = oriented(6, 3, 8);
    spoilt.truncate(spoilt.len() - 3);
    other(&spoilt, (2, 4));
}

#[test]
fn nothing_is_scaled_to_more_than_may_be_read() {
    let file = oriented_png(1, 3, 8, false);
    for (columns, rows) in [(usize::MAX, 1), (1 << 33, 2), (2, 8193)] {
        let how = ReadOptions { size: PictureSize::Fitted(columns, rows), ..ReadOptions::default() };
        match decode(&file, &how) {
            Err(DecodeError::FittedTooLarge { columns: wide, rows: high }) => {
                assert_eq!((wide, high), (columns, rows));
            }
            other => panic!("{other:?}"),
        }
    }
}
