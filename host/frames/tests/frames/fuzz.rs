//! Decoders must survive any input.

use std::io::Cursor;

use halfrow_frames::{
    Camera, Orientation, RawGeometry, RawLayout, ReadOptions, decode, dng, pgm, png, raw, tiff,
};
use halfrow_model::{BitDepth, Frame, Phase};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::{Index, select};

/// A small frame in each format.
fn files() -> Vec<Vec<u8>> {
    let frame =
        Frame::new(4, BitDepth::Twelve, Phase::Grbg, (0..32).map(|place| place * 128).collect()).unwrap();
    let (mut as_pgm, mut as_png, mut as_tiff) = (Vec::new(), Vec::new(), Cursor::new(Vec::new()));
    let mut as_dng = Cursor::new(Vec::new());
    pgm::encode(&frame, &mut as_pgm).unwrap();
    png::encode(&frame, &mut as_png).unwrap();
    tiff::encode(&frame, Orientation::default(), &mut as_tiff).unwrap();
    dng::encode(&frame, &Camera::default(), &mut as_dng).unwrap();
    vec![as_pgm, as_png, as_tiff.into_inner(), as_dng.into_inner()]
}

/// The PNG with the right checksum after every remaining chunk, so that the damage gets past the check.
fn with_checksums(mut file: Vec<u8>) -> Vec<u8> {
    let mut chunk = 8;
    while let Some(&[a, b, c, d]) = file.get(chunk..).and_then(|rest| rest.first_chunk()) {
        let end = chunk + 8 + usize::try_from(u32::from_be_bytes([a, b, c, d])).unwrap();
        let Some(body) = file.get(chunk + 4..end) else { break };
        let checksum = crc32fast::hash(body).to_be_bytes();
        let Some(place) = file.get_mut(end..end + 4) else { break };
        place.copy_from_slice(&checksum);
        chunk = end + 4;
    }
    file
}

/// The body of a fuzzer: gives `bytes` to every decoder, whatever they begin with. It must return.
fn fuzz_decode(bytes: &[u8]) {
    let how = ReadOptions::default();
    let mut results = vec![decode(bytes, &how), pgm::decode(bytes, &how), png::decode(bytes, &how)];
    results.push(tiff::decode(bytes, &how));
    let (width, samples) = bytes.split_first().map_or((0, bytes), |(&width, rest)| (width.into(), rest));
    for layout in RawLayout::ALL {
        for height in [0, 1, samples.len() / 8, usize::MAX] {
            results.push(raw::decode(samples, RawGeometry { width, height, layout }, &how));
        }
    }
    std::hint::black_box(&results);
}

#[test]
fn the_files_to_mutate_are_sound() {
    for file in files() {
        assert!(decode(&file, &Default::default()).is_ok());
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(10_000))]

    #[test]
    fn no_decoder_panics_on_random_bytes(bytes in vec(any::<u8>(), 0..400)) {
        fuzz_decode(&bytes);
    }

    #[test]
    fn no_decoder_panics_on_a_damaged_file(
        mut file in select(files()),
        damage in vec((any::<Index>(), any::<u8>()), 1..6),
        end in any::<Index>(),
        cut in any::<bool>(),
    ) {
        for (place, value) in damage {
            let place = place.index(file.len());
            file[place] = value;
        }
        if cut {
            file.truncate(end.index(file.len()));
        }
        fuzz_decode(&file);
        fuzz_decode(&with_checksums(file));
    }

    #[test]
    fn no_decoder_panics_on_a_header_of_extreme_numbers(
        mut file in select(files()),
        damage in vec((any::<Index>(), select(vec![0_u32, 1, 0xffff, 0x7fff_ffff, u32::MAX])), 1..4),
    ) {
        for (place, value) in damage {
            let place = place.index(file.len().saturating_sub(4)) & !1;
            file[place..place + 4].copy_from_slice(&value.to_le_bytes());
        }
        fuzz_decode(&file);
    }
}
