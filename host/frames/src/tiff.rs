//! TIFF with 8 or 16 bits per sample: one plain picture, in either byte order, or raw samples under a filter array (DNG).

use std::io::{Cursor, Seek, Write};

use halfrow_model::{BitDepth, Frame};
use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::encoder::colortype::{ColorType as ColourType, Gray8, Gray16};
use tiff::encoder::{TiffEncoder, TiffValue};
use tiff::tags::Tag;
use tiff::{ColorType, TiffError};

use super::mosaic::Picture;
use super::size::MAX_FILE_BYTES;
use super::{Camera, DecodeError, Decoded, Orientation, ReadOptions, tiff_directory};

/// The first bytes of a TIFF, of either byte order.
pub(super) const MAGICS: [&[u8]; 2] = [b"II*\0", b"MM\0*"];

/// The frame in the bytes of a TIFF or DNG. Grey is taken as a raw Bayer frame. RGB is turned by its orientation and mosaicked.
/// Alpha is ignored.
///
/// # Errors
/// [`DecodeError`] when the file is damaged, is of a kind that is not accepted (several pictures, palettes, planes, lossy or
/// unusual codings), names another phase or depth than `how`, or when a sample exceeds `how.depth`.
pub fn decode(bytes: &[u8], how: &ReadOptions) -> Result<Frame, DecodeError> {
    decode_fitted(bytes, how).map(|decoded| decoded.frame)
}

/// Like [`decode`], with what else the file says.
///
/// # Errors
/// Those of [`decode`].
pub(super) fn decode_fitted(bytes: &[u8], how: &ReadOptions) -> Result<Decoded, DecodeError> {
    let told = tiff_directory::check(bytes)?;
    if told.is_coloured {
        how.size.fitting(told.orientation.seen(told.size))?;
    }
    let Some(array) = told.array else {
        let picture = Picture { orientation: told.orientation, ..read(bytes)? };
        return picture.turned().into_frame(how);
    };
    array.check(how)?;
    let grey = array.as_grey(bytes);
    let camera = Camera::of_dng(&grey, told.orientation).map_err(refused)?;
    Ok(Decoded { camera, ..read(&grey)?.into_frame(how)? })
}

/// Writes `frame` as grey samples, unchanged and uncompressed: with 8 bits if that is its depth, else with 16; to be shown turned
/// by `orientation`.
///
/// # Errors
/// Those of the encoder and of `out`.
pub fn encode(
    frame: &Frame,
    orientation: Orientation,
    out: &mut (impl Write + Seek),
) -> Result<(), TiffError> {
    match frame.depth() {
        BitDepth::Eight => {
            let bytes: Vec<u8> = frame.samples().iter().map(|sample| sample.to_be_bytes()[1]).collect();
            write::<Gray8>(frame, &bytes, orientation, out)
        }
        _ => write::<Gray16>(frame, frame.samples(), orientation, out),
    }
}

fn write<Grey: ColourType>(
    frame: &Frame,
    samples: &[Grey::Inner],
    orientation: Orientation,
    out: &mut (impl Write + Seek),
) -> Result<(), TiffError>
where
    [Grey::Inner]: TiffValue,
{
    let mut encoder = TiffEncoder::new(out)?;
    let (width, height) = (u32::try_from(frame.width())?, u32::try_from(frame.height())?);
    let mut image = encoder.new_image::<Grey>(width, height)?;
    image.encoder().write_tag(Tag::Orientation, orientation.tag())?;
    image.write_data(samples)
}

fn read(bytes: &[u8]) -> Result<Picture, DecodeError> {
    let mut decoder = Decoder::new(Cursor::new(bytes)).map_err(refused)?.with_limits(limits());
    if decoder.more_images() {
        return Err(DecodeError::Unsupported {
            what: "a TIFF of several pictures".to_owned(),
            remedy: "save each as a file of its own",
        });
    }
    let (width, _) = decoder.dimensions().map_err(refused)?;
    let channels = match decoder.colortype().map_err(refused)? {
        ColorType::Gray(_) => 1,
        ColorType::RGB(_) => 3,
        ColorType::RGBA(_) => 4,
        other => return Err(unsupported(&format!("a TIFF of {other:?}"))),
    };
    let (full, samples) = match decoder.read_image().map_err(refused)? {
        DecodingResult::U8(samples) => (u8::MAX.into(), samples.into_iter().map(u16::from).collect()),
        DecodingResult::U16(samples) => (u16::MAX, samples),
        _ => return Err(unsupported("a TIFF of signed or floating-point samples")),
    };
    let (width, orientation) = (usize::try_from(width).unwrap_or(usize::MAX), Orientation::default());
    Ok(Picture { width, channels, full, samples, orientation })
}

/// Room for the largest picture that the directory's check lets pass, even in a single strip.
fn limits() -> Limits {
    let mut limits = Limits::default();
    limits.decoding_buffer_size = MAX_FILE_BYTES;
    limits.intermediate_buffer_size = MAX_FILE_BYTES;
    limits
}

/// The decoder's `error` as one of ours.
fn refused(error: TiffError) -> DecodeError {
    match error {
        TiffError::UnsupportedError(_) => unsupported("this kind of TIFF"),
        other => DecodeError::Tiff(other),
    }
}

fn unsupported(what: &str) -> DecodeError {
    DecodeError::Unsupported { what: what.to_owned(), remedy: "save it as grey or RGB of 8 or 16 bits" }
}
