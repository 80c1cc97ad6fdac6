//! Pictures that a decoder would take for others without a word.

use halfrow_frames::{ReadOptions, decode};
use halfrow_model::{BitDepth, Phase};
use png::{BitDepth as Bits, ColorType, Encoder, chunk};

use crate::pictures::{options, oriented};

/// In the place of the orientation, whose tag comes later.
#[test]
fn a_tiff_of_reversed_bits_is_refused() {
    let with_fill_order = |value: u16| {
        let mut file = oriented(1, 3, 8);
        let [places, orientation] = [5, 6].map(|entry| 8 + 2 + 12 * entry);
        let strip = file[places..orientation].to_vec();
        file[orientation..orientation + 12].copy_from_slice(&strip);
        let fill_order = [266, 3, 1, 0, value, 0].map(u16::to_le_bytes).concat();
        file[places..places + 12].copy_from_slice(&fill_order);
        decode(&file, &options(BitDepth::Eight))
    };
    assert_eq!(with_fill_order(1).unwrap().samples(), [1, 2, 3, 4, 5, 6, 7, 8]);
    let error = with_fill_order(2).unwrap_err().to_string();
    assert_eq!(
        error,
        "a TIFF whose bits are in another order (FillOrder 2) cannot be used; save it with FillOrder 1"
    );
}

/// A PNG of `width` x 2 with this colour type and depth, and with the colours of a palette. `packed` is what its rows are packed
/// from, with the filter byte of each, and `checksum` is added to the sum that follows them.
fn packed_png(
    width: u32,
    (colour, depth): (ColorType, Bits),
    palette: &[u8],
    packed: &[u8],
    checksum: u32,
) -> Vec<u8> {
    let (low, high) = packed.iter().fold((1, 0), |(low, high), &byte| {
        let low = (low + u32::from(byte)) % 65_521;
        (low, (high + low) % 65_521)
    });
    let length = u16::try_from(packed.len()).unwrap();
    let [length, complement] = [length, !length].map(u16::to_le_bytes);
    let sum = (high << 16 | low).wrapping_add(checksum).to_be_bytes();
    let stored = [&[0x78, 1, 1][..], &length, &complement, packed, &sum].concat();
    let mut file = Vec::new();
    let mut encoder = Encoder::new(&mut file, width, 2);
    encoder.set_color(colour);
    encoder.set_depth(depth);
    if !palette.is_empty() {
        encoder.set_palette(palette);
    }
    let mut writer = encoder.write_header().unwrap();
    writer.write_chunk(chunk::IDAT, &stored).unwrap();
    drop(writer);
    file
}

#[test]
fn a_png_whose_samples_do_not_have_their_checksum_is_damaged() {
    let grey = (ColorType::Grayscale, Bits::Eight);
    let of = |checksum| {
        decode(&packed_png(2, grey, &[], &[0, 7, 8, 0, 9, 10], checksum), &options(BitDepth::Eight))
    };
    assert_eq!(of(0).unwrap().samples(), [7, 8, 9, 10]);
    let error = of(1).unwrap_err().to_string();
    assert!(
        error.starts_with("the PNG is damaged: ") && error.ends_with("; copy or export it again"),
        "{error}"
    );
}

/// Bits that fill up the last byte of a row are no pixel's.
#[test]
fn a_colour_that_the_palette_does_not_have_is_damage() {
    let red_green_blue = [255, 0, 0, 0, 255, 0, 0, 0, 255];
    let of = |depth, packed: &[u8]| {
        let file = packed_png(2, (ColorType::Indexed, depth), &red_green_blue, packed, 0);
        let rggb = ReadOptions { phase: Phase::Rggb, ..options(BitDepth::Eight) };
        decode(&file, &rggb).map(|frame| frame.samples().to_vec())
    };
    // By hand: red and blue over green and blue, of which R and G, then G and B are kept.
    let expected = [255, 0, 255, 255];
    let (two, eight) = (Bits::Two, Bits::Eight);
    assert_eq!(of(eight, &[0, 0, 2, 0, 1, 2]).unwrap(), expected);
    assert_eq!(of(two, &[0, 0b00_10_11_11, 0, 0b01_10_11_11]).unwrap(), expected);
    for error in [of(eight, &[0, 0, 2, 0, 1, 3]), of(two, &[0, 0b00_10_00_00, 0, 0b01_11_00_00])] {
        let error = error.unwrap_err().to_string();
        assert_eq!(
            error,
            "the PNG is damaged: the pixel at row 1, column 1 has colour 3, and its palette has 3 colours, from 0; copy or \
             export it again"
        );
    }
}
