//! PNG with 8 or 16 bits per sample. Gamma and colour profiles are not applied: the numbers in the file are the samples.

use std::io::{Cursor, Write};
use std::ops::RangeInclusive;

use halfrow_model::{BitDepth, Frame};
use png::{
    ColorType, Compression, DecodeOptions, Decoder, DecodingError, Encoder, EncodingError, Info, OutputInfo,
};

use super::mosaic::Picture;
use super::preview::RgbImage;
use super::{DecodeError, Orientation, PictureSize, ReadOptions, photograph, size};

/// The first bytes of a PNG.
pub(super) const MAGIC: &[u8] = b"\x89PNG\r\n\x1a\n";

/// The sides that a PNG can have, by its specification.
const SIDES: RangeInclusive<u32> = 1..=(1 << 31) - 1;

/// Above so many bytes a picture is packed in the fast way: the thorough one takes a second for a whole frame, and saves a seventh
/// of raw noise and nothing of a developed picture.
const LARGE: usize = 1 << 18;

/// The frame in the bytes of a PNG. Grey is taken as a raw Bayer frame. Colour, including palettes, is turned by its EXIF
/// orientation and mosaicked. Alpha is ignored.
///
/// # Errors
/// [`DecodeError`] when the PNG is damaged, animated, followed by other bytes, or grey with fewer than 8 bits, or when a
/// sample exceeds `how.depth`.
pub fn decode(bytes: &[u8], how: &ReadOptions) -> Result<Frame, DecodeError> {
    picture(bytes, how.size)?.into_frame(how).map(|decoded| decoded.frame)
}

/// The picture in the bytes of a PNG in red, green and blue of 8 bits, turned by its EXIF orientation; alpha is ignored.
///
/// # Errors
/// [`DecodeError`] when [`decode`] would refuse the PNG, when it is not a PNG, or when it is grey or has 16 bits.
pub(super) fn decode_rgb(bytes: &[u8]) -> Result<RgbImage, DecodeError> {
    if !bytes.starts_with(MAGIC) {
        let what = photograph::PhotographFormat::of(bytes)
            .map_or("what is no PNG".to_owned(), |it| format!("a {}", it.name()));
        return Err(DecodeError::Unsupported { what, remedy: "give a PNG in colour, 8 bits a sample" });
    }
    picture(bytes, PictureSize::Any)?.into_rgb().ok_or(DecodeError::Unsupported {
        what: "a PNG that is not in colour with 8 bits a sample".to_owned(),
        remedy: "give the photograph itself, in red, green and blue",
    })
}

/// Writes `frame` as grey samples, unchanged: with 8 bits if that is its depth, else with 16.
///
/// # Errors
/// Those of the encoder and of `out`.
pub fn encode(frame: &Frame, out: &mut impl Write) -> Result<(), EncodingError> {
    let samples = frame.samples();
    match frame.depth() {
        BitDepth::Eight => {
            let bytes: Vec<u8> = samples.iter().map(|sample| sample.to_be_bytes()[1]).collect();
            write(out, (frame.width(), frame.height()), (ColorType::Grayscale, png::BitDepth::Eight), &bytes)
        }
        _ => {
            let bytes: Vec<u8> = samples.iter().flat_map(|sample| sample.to_be_bytes()).collect();
            write(
                out,
                (frame.width(), frame.height()),
                (ColorType::Grayscale, png::BitDepth::Sixteen),
                &bytes,
            )
        }
    }
}

/// Writes a PNG of `(width, height)` from rows of bytes in the given colour type and depth.
///
/// # Errors
/// Those of the encoder, also when `bytes` has another length or a side is outside [`SIDES`], and those of `out`.
pub(super) fn write(
    out: &mut impl Write,
    (width, height): (usize, usize),
    (colour, depth): (ColorType, png::BitDepth),
    bytes: &[u8],
) -> Result<(), EncodingError> {
    let side = |length| u32::try_from(length).ok().filter(|side| SIDES.contains(side));
    let (Some(width), Some(height)) = (side(width), side(height)) else {
        return Err(EncodingError::LimitsExceeded);
    };
    let mut encoder = Encoder::new(out, width, height);
    encoder.set_color(colour);
    encoder.set_depth(depth);
    if bytes.len() > LARGE {
        encoder.set_compression(Compression::Fast);
    }
    let mut writer = encoder.write_header()?;
    writer.write_image_data(bytes)?;
    writer.finish()
}

/// The picture in `bytes`, with nothing after it. It is unpacked only if it can have the `size` asked for.
///
/// # Errors
/// Those of [`decode`] that concern the PNG.
pub(super) fn picture(bytes: &[u8], size: PictureSize) -> Result<Picture, DecodeError> {
    let mut input = Cursor::new(bytes);
    let picture = read(&mut input, size)?;
    let read = usize::try_from(input.position()).unwrap_or(usize::MAX);
    size::exact(bytes.len(), read)?;
    Ok(picture)
}

fn read(input: &mut Cursor<&[u8]>, size: PictureSize) -> Result<Picture, DecodeError> {
    let compressed = input.get_ref().len();
    let mut options = DecodeOptions::default();
    options.set_ignore_adler32(false);
    options.set_ignore_text_chunk(true);
    options.set_ignore_iccp_chunk(true);
    let mut decoder = Decoder::new_with_options(input, options);
    check(decoder.read_header_info().map_err(DecodeError::Png)?)?;
    let mut reader = decoder.read_info().map_err(DecodeError::Png)?;
    if reader.info().is_animated() {
        return Err(DecodeError::Unsupported {
            what: "an animated PNG".to_owned(),
            remedy: "save each picture as a file of its own",
        });
    }
    check_size(reader.info(), size)?;
    let length = reader.output_buffer_size().ok_or(DecodeError::Png(DecodingError::LimitsExceeded))?;
    size::plausible(compressed, length)?;
    let mut bytes = vec![0; length];
    let output = reader.next_frame(&mut bytes).map_err(DecodeError::Png)?;
    reader.finish().map_err(DecodeError::Png)?;
    let (channels, full, samples) = match output.color_type {
        ColorType::Indexed => {
            let palette = reader.info().palette.as_deref().unwrap_or_default();
            (3, u8::MAX.into(), coloured(&bytes, &output, palette)?)
        }
        colour => widened(&bytes, output.bit_depth, colour.samples()),
    };
    drop(bytes);
    let width = usize::try_from(output.width).unwrap_or(usize::MAX);
    // The EXIF block may come after the picture.
    let orientation = reader.info().exif_metadata.as_deref().map(Orientation::of_exif).unwrap_or_default();
    Ok(Picture { width, channels, full, samples, orientation }.turned())
}

/// Channels, full brightness and samples from the `bytes` of a picture, without alpha, which follows the grey or the colours.
fn widened(bytes: &[u8], depth: png::BitDepth, channels: usize) -> (usize, u16, Vec<u16>) {
    let kept = channels - usize::from(channels.is_multiple_of(2));
    let width = if depth == png::BitDepth::Sixteen { 2 } else { 1 };
    let mut samples = Vec::with_capacity(bytes.len() / width / channels * kept);
    for pixel in bytes.chunks_exact(width * channels) {
        let colours = pixel[..width * kept].chunks_exact(width);
        samples.extend(colours.map(|sample| sample.iter().fold(0, |high, &low| high << 8 | u16::from(low))));
    }
    (kept, if width == 2 { u16::MAX } else { u8::MAX.into() }, samples)
}

/// Red, green and blue of the pixels in `bytes`, each the place of a colour in `palette`. The decoder would make black of a
/// place that is not there.
///
/// # Errors
/// [`DecodeError::PngPalette`]
fn coloured(bytes: &[u8], output: &OutputInfo, palette: &[u8]) -> Result<Vec<u16>, DecodeError> {
    let (width, bits) = (usize::try_from(output.width).unwrap_or(usize::MAX), output.bit_depth as usize);
    let mut samples = Vec::with_capacity(bytes.len() * 8 / bits * 3);
    for (row, line) in bytes.chunks_exact(output.line_size).enumerate() {
        for column in 0..width {
            let (byte, bit) = (column * bits / 8, column * bits % 8);
            let index = usize::from(line[byte] << bit >> (8 - bits));
            let colour = palette.get(3 * index..3 * index + 3);
            let colours = palette.len() / 3;
            let colour = colour.ok_or(DecodeError::PngPalette { row, column, index, colours })?;
            samples.extend(colour.iter().map(|&sample| u16::from(sample)));
        }
    }
    Ok(samples)
}

/// Refuses a picture in colour that cannot have the `size` asked for, however it is turned.
fn check_size(header: &Info<'_>, size: PictureSize) -> Result<(), DecodeError> {
    if matches!(header.color_type, ColorType::Grayscale | ColorType::GrayscaleAlpha) {
        return Ok(());
    }
    let (width, height) = size::checked(header.width.into(), header.height.into())?;
    let fitting = match &header.exif_metadata {
        Some(block) => size.fitting(Orientation::of_exif(block).seen((width, height))),
        // An EXIF block may still come after the picture.
        None => size
            .fitting((width, height))
            .or_else(|refused| size.fitting((height, width)).map_err(|_| refused)),
    };
    fitting.map(drop)
}

/// Refuses, from the header alone, what is too large or would not keep its samples.
fn check(header: &Info<'_>) -> Result<(), DecodeError> {
    size::checked(header.width.into(), header.height.into())?;
    let bits = header.bit_depth as u8;
    if header.color_type == ColorType::Grayscale && bits < 8 {
        return Err(DecodeError::Unsupported {
            what: format!("a grey PNG of {bits} bits a sample"),
            remedy: "save it with 8 or 16 bits",
        });
    }
    Ok(())
}
