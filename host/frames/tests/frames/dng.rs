//! DNG files that were written byte by byte with Python's struct module, and what must be read from them.

use halfrow_frames::{Camera, DecodeError, FrameFile, PictureSize, ReadOptions, decode, dng};
use halfrow_model::{BitDepth, Frame, Phase};

use super::pictures::hex;

/// 4 x 2 of [`SAMPLES`], BGGR, white at 4095, low byte first.
const LITTLE: &str = "\
    49492a0018000000000001000001ff0ffe0f0008110003000d000001040001000000040000000101030001000000020000000201\
    03000100000010000000030103000100000001000000060103000100000023800000110104000100000008000000150103000100\
    0000010000001601030001000000020000001701040001000000100000008d82030002000000020002008e820100040000000201\
    010012c6010004000000010400001dc6040001000000ff0f000000000000";

/// Like [`LITTLE`], high byte first.
const BIG: &str = "\
    4d4d002a000000180000000101000fff0ffe080000110003000d0100000400000001000000040101000300000001000200000102\
    00030000000100100000010300030000000100010000010600030000000180230000011100040000000100000008011500030000\
    000100010000011600030000000100020000011700040000000100000010828d00030000000200020002828e0001000000040201\
    0100c61200010000000401040000c61d00040000000100000fff00000000";

const SAMPLES: [u16; 8] = [0, 1, 256, 4095, 4094, 2048, 17, 3];

/// Where directory entries begin. An entry has 12 bytes; the first two are the tag.
const BITS: usize = 26 + 2 * 12;
const PHOTOMETRIC: usize = 26 + 4 * 12;
const REPEAT: usize = 26 + 9 * 12;
const PATTERN: usize = 26 + 10 * 12;
const VERSION: usize = 26 + 11 * 12;
const WHITE: usize = 26 + 12 * 12;

const AS_WRITTEN: ReadOptions =
    ReadOptions { depth: BitDepth::Twelve, phase: Phase::Bggr, raw: None, size: PictureSize::Any };

/// [`LITTLE`] with other bytes at one place.
fn altered(place: usize, bytes: &[u8]) -> Vec<u8> {
    let mut file = hex(LITTLE);
    file[place..place + bytes.len()].copy_from_slice(bytes);
    file
}

#[test]
fn samples_are_taken_as_they_are_in_either_byte_order() {
    for file in [LITTLE, BIG] {
        let frame = decode(&hex(file), &AS_WRITTEN).unwrap();
        assert_eq!((frame.width(), frame.phase(), frame.samples()), (4, Phase::Bggr, &SAMPLES[..]));
    }
}

/// By the DNG specification: red is 0, green 1, blue 2, row after row.
#[test]
fn the_pattern_is_the_phase() {
    let patterns = [
        ([1, 0, 2, 1], Phase::Grbg),
        ([0, 1, 1, 2], Phase::Rggb),
        ([2, 1, 1, 0], Phase::Bggr),
        ([1, 2, 0, 1], Phase::Gbrg),
    ];
    for (pattern, phase) in patterns {
        let file = altered(PATTERN + 8, &pattern);
        assert_eq!(decode(&file, &ReadOptions { phase, ..AS_WRITTEN }).unwrap().samples(), SAMPLES);
        let asked = Phase::ALL.into_iter().find(|&other| other != phase).unwrap();
        let error = decode(&file, &ReadOptions { phase: asked, ..AS_WRITTEN }).unwrap_err();
        assert!(matches!(error, DecodeError::OtherPhase { found, .. } if found == phase), "{error}");
    }
}

/// White need not be a power of two minus one, and a sensor may saturate below half of its converter's range. A camera of 14 bits
/// has its white at 16383 at most.
#[test]
fn white_tells_the_depth() {
    let with_white = |white: u32| altered(WHITE + 8, &white.to_le_bytes());
    for white in [1025, 2000, 2047, 4000, 4095, 4096] {
        assert_eq!(decode(&with_white(white), &AS_WRITTEN).unwrap().samples(), SAMPLES, "{white}");
    }
    let depths = [
        (0, "white is 0, which is not that of samples of 12 bits; scale"),
        (16383, "white is 16383, which is not that of samples of 12 bits; scale it to 12 bits"),
        (4097, "white is 4097, which is not that of samples of 12 bits; scale"),
        (1024, "name the bits 10, or scale it to 12 bits"),
        (1023, "name the bits 10, or"),
        (256, "name the bits 8, or"),
        (255, "name the bits 8, or"),
    ];
    for (white, remedy) in depths {
        let error = decode(&with_white(white), &AS_WRITTEN).unwrap_err().to_string();
        assert!(error.contains(remedy), "{error}");
    }
}

#[test]
fn what_is_no_plain_bayer_picture_is_refused_with_a_remedy() {
    let remedies = [
        (PATTERN + 8, vec![0, 0, 0, 0], "is no Bayer pattern"),
        (PATTERN + 4, 36_u32.to_le_bytes().to_vec(), "is no Bayer pattern"),
        // The same four colours, in one row of four.
        (REPEAT + 8, [1_u16, 4].map(u16::to_le_bytes).concat(), "is no Bayer pattern"),
        // CFALayout 2, and BlackLevelDeltaV of 64, in place of CFARepeatPatternDim.
        (REPEAT, [50711_u16, 3, 1, 0, 2].map(u16::to_le_bytes).concat(), "CFALayout is staggered"),
        (REPEAT, [50716 | 10 << 16, 1_u32, 8].map(u32::to_le_bytes).concat(), "BlackLevelDeltaV is not 0"),
        // A first picture in grey, such as a preview; the raw samples are elsewhere.
        (PHOTOMETRIC + 8, 1_u16.to_le_bytes().to_vec(), "as `dcraw -D -4 -T -t 0` does"),
        // Demosaicked, or with samples of 12 bits one after the other.
        (PHOTOMETRIC + 8, 34892_u16.to_le_bytes().to_vec(), "give the raw file"),
        (BITS + 8, 12_u16.to_le_bytes().to_vec(), "as `dcraw -D -4 -T -t 0` does"),
        (VERSION, 50712_u16.to_le_bytes().to_vec(), "convert it to samples that are linear"),
    ];
    for (place, bytes, remedy) in remedies {
        let error = decode(&altered(place, &bytes), &AS_WRITTEN).unwrap_err().to_string();
        assert!(error.contains(remedy), "{bytes:?} at {place}: {error}");
    }
}

/// [`LITTLE`] with an ActiveArea (top, left, bottom, right) of 32 bits each, in place of its CFARepeatPatternDim. The values are
/// appended to the file.
fn with_active_area(area: [u32; 4]) -> Vec<u8> {
    let end = u32::try_from(hex(LITTLE).len()).unwrap();
    let entry = [50829 | 4 << 16, 4, end].map(u32::to_le_bytes).concat();
    [altered(REPEAT, &entry), area.map(u32::to_le_bytes).concat()].concat()
}

#[test]
fn an_active_area_that_leaves_samples_out_is_refused() {
    assert_eq!(decode(&with_active_area([0, 0, 2, 4]), &AS_WRITTEN).unwrap().samples(), SAMPLES);
    for area in [[0, 1, 2, 4], [1, 0, 2, 4], [0, 0, 1, 4], [0, 0, 2, 3], [0, 0, 4, 2]] {
        let error = decode(&with_active_area(area), &AS_WRITTEN).unwrap_err().to_string();
        assert!(error.contains("ActiveArea") && error.contains("crop it to"), "{area:?}: {error}");
    }
    let mut broken_off = with_active_area([0, 0, 2, 4]);
    broken_off.pop();
    assert!(matches!(decode(&broken_off, &AS_WRITTEN), Err(DecodeError::TiffDirectory { .. })));
}

/// BlackLevel in place of WhiteLevel: as a short, two shorts, a long, and a fraction, which is appended to the file; once with
/// BlackLevelRepeatDim in place of CFARepeatPatternDim.
#[test]
fn a_black_level_of_each_place_is_taken() {
    let black = |kind: u32, count: u32, value: u32, repeats: Option<[u16; 2]>| {
        let entry = [50714 | kind << 16, count, value].map(u32::to_le_bytes).concat();
        let mut file = [altered(WHITE, &entry), [64_u32, 1].map(u32::to_le_bytes).concat()].concat();
        if let Some([rows, columns]) = repeats {
            file[REPEAT..][..12]
                .copy_from_slice(&[50713, 3, 2, 0, rows, columns].map(u16::to_le_bytes).concat());
        }
        file
    };
    let end = u32::try_from(hex(LITTLE).len()).unwrap();
    let levels =
        [black(3, 1, 0, None), black(3, 1, 64, None), black(4, 1, 1 << 16, None), black(5, 1, end, None)];
    for file in levels.into_iter().chain([black(3, 2, 64 << 16, Some([1, 2])), black(3, 1, 0, Some([1, 3]))])
    {
        assert_eq!(decode(&file, &AS_WRITTEN).unwrap().samples(), SAMPLES);
    }
    let error = decode(&black(3, 1, 64, Some([1, 3])), &AS_WRITTEN).unwrap_err().to_string();
    assert!(error.contains("BlackLevel repeats") && error.contains("subtract it"), "{error}");
}

/// PhotometricInterpretation as 32 bits, where the specification has 16.
#[test]
fn a_wide_colour_code_is_taken_in_either_byte_order() {
    let little = altered(PHOTOMETRIC + 2, &[4, 0, 1, 0, 0, 0, 0x23, 0x80, 0, 0]);
    let mut big = hex(BIG);
    big[PHOTOMETRIC + 2..PHOTOMETRIC + 12].copy_from_slice(&[0, 4, 0, 0, 0, 1, 0, 0, 0x80, 0x23]);
    for file in [little, big] {
        assert_eq!(decode(&file, &AS_WRITTEN).unwrap().samples(), SAMPLES);
    }
}

/// The same numbers in either byte order, here only the white.
#[test]
fn the_camera_is_the_same_in_either_byte_order() {
    let folder = tempfile::tempdir().unwrap();
    let [little, big] = [LITTLE, BIG].map(|file| {
        let path = folder.path().join("in.dng");
        std::fs::write(&path, hex(file)).unwrap();
        FrameFile::read(&path).unwrap().decode(&AS_WRITTEN).unwrap().camera
    });
    assert_eq!(little, big);
    assert_ne!(little, Camera::default());
}

#[test]
fn every_truncation_is_an_error() {
    for text in [LITTLE, BIG] {
        let file = hex(text);
        // The last four bytes only say that no further picture follows.
        for length in 0..file.len() - 4 {
            assert!(decode(&file[..length], &AS_WRITTEN).is_err(), "{length} bytes");
        }
    }
}

#[test]
fn what_is_written_is_read_back_exactly() {
    for (phase, depth) in Phase::ALL.into_iter().flat_map(|phase| BitDepth::ALL.map(|depth| (phase, depth))) {
        let samples = (0..64 * 6).map(|place: u16| place.wrapping_mul(40_503) & depth.max()).collect();
        let frame = Frame::new(64, depth, phase, samples).unwrap();
        let mut file = std::io::Cursor::new(Vec::new());
        dng::encode(&frame, &Camera::default(), &mut file).unwrap();
        assert_eq!(
            decode(file.get_ref(), &ReadOptions { depth, phase, ..ReadOptions::default() }).unwrap(),
            frame
        );
    }
}
