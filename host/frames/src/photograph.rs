//! Photographs in the formats of cameras and phones: JPEG, WebP and BMP.
//!
//! They are pictures for viewing, with 8 bits per colour, never raw samples. Each sample keeps the colour of its place and is
//! scaled to the depth; in a grey picture all colours are equal. Gamma and colour profiles are not applied, and alpha is
//! ignored. The header decides whether a picture is decoded at all, so that none takes more memory than [`MAX_PIXELS`] need.

use std::io::Cursor;

use image::codecs::bmp::BmpDecoder;
use image::codecs::webp::WebPDecoder;
use image::{DynamicImage, ImageDecoder, ImageError, ImageResult, Limits};

use super::error::BROKEN_OFF;
use super::jpeg::{self, Jpeg};
use super::orientation::is_quarter_turn;
use super::preview::RgbImage;
use super::{DecodeError, Decoded, Fitting, PictureSize, ReadOptions, mosaic};

/// The most pixels that a photograph may have.
pub(super) const MAX_PIXELS: u64 = 100_000_000;

/// A format of photographs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PhotographFormat {
    Jpeg,
    WebP,
    Bmp,
}

impl PhotographFormat {
    /// The format that `bytes` begin with.
    pub(super) fn of(bytes: &[u8]) -> Option<Self> {
        match bytes {
            _ if bytes.starts_with(jpeg::MAGIC) => Some(Self::Jpeg),
            [b'R', b'I', b'F', b'F', _, _, _, _, b'W', b'E', b'B', b'P', ..] => Some(Self::WebP),
            [b'B', b'M', ..] => Some(Self::Bmp),
            _ => None,
        }
    }

    /// Its name.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Jpeg => "JPEG",
            Self::WebP => "WebP",
            Self::Bmp => "BMP",
        }
    }

    /// A decoder of `bytes` that has read their header.
    fn decoder<'a>(self, bytes: &'a [u8]) -> Result<Box<dyn ImageDecoder + 'a>, DecodeError> {
        let input = Cursor::new(bytes);
        let refused = |error| self.refused(&error);
        Ok(match self {
            Self::Jpeg => Box::new(Jpeg::new(bytes)?),
            Self::WebP => Box::new(self.still(bytes, WebPDecoder::new(input).map_err(refused)?)?),
            Self::Bmp => Box::new(BmpDecoder::new(input).map_err(refused)?),
        })
    }

    /// Refuses a WebP that is animated, or that by its header is longer than `bytes`.
    fn still<Input: std::io::BufRead + std::io::Seek>(
        self,
        bytes: &[u8],
        decoder: WebPDecoder<Input>,
    ) -> Result<WebPDecoder<Input>, DecodeError> {
        let length = bytes
            .get(4..)
            .and_then(|rest| rest.first_chunk())
            .map_or(0, |&length| u32::from_le_bytes(length));
        if bytes.len() as u64 <= u64::from(length) + 7 {
            return Err(self.damaged(BROKEN_OFF));
        }
        if decoder.has_animation() {
            let what = "an animated WebP".to_owned();
            return Err(DecodeError::Unsupported { what, remedy: "save each picture as a file of its own" });
        }
        Ok(decoder)
    }

    /// The decoder's `error` as one of ours.
    pub(super) fn refused(self, error: &ImageError) -> DecodeError {
        match error {
            ImageError::Unsupported(_) => DecodeError::Unsupported {
                what: format!("this kind of {}", self.name()),
                remedy: "save it as a JPEG, or as a PNG of 8 bits",
            },
            ImageError::IoError(error) if error.kind() == std::io::ErrorKind::UnexpectedEof => {
                self.damaged(BROKEN_OFF)
            }
            other => self.damaged(other.to_string().trim_end_matches('.')),
        }
    }

    /// The error for a picture that its decoder cannot read.
    pub(super) fn damaged(self, reason: &str) -> DecodeError {
        DecodeError::Photograph { format: self.name(), reason: reason.to_owned() }
    }
}

/// The frame of the photograph in `bytes`, as it is [`shown`], mosaicked to `how.phase`.
///
/// # Errors
/// Those of [`shown`].
pub(super) fn decode(
    format: PhotographFormat,
    bytes: &[u8],
    how: &ReadOptions,
) -> Result<Decoded, DecodeError> {
    let (picture, fitting) = shown(format, bytes, how.size)?;
    Ok(Decoded { fitting, is_coded: true, ..mosaic::of_rgb(&picture, how)?.into() })
}

/// The photograph in `bytes`, turned by its EXIF orientation, and how it was fitted.
///
/// # Errors
/// [`DecodeError`] when it is damaged, of a kind that is not taken, larger than [`MAX_PIXELS`], or not of the `size` asked for.
pub(super) fn shown(
    format: PhotographFormat,
    bytes: &[u8],
    size: PictureSize,
) -> Result<(RgbImage, Option<Fitting>), DecodeError> {
    let mut decoder = format.decoder(bytes)?;
    let (width, height) = decoder.dimensions();
    if u64::from(width) * u64::from(height) > MAX_PIXELS {
        return Err(DecodeError::TooManyPixels { width: width.into(), height: height.into() });
    }
    let orientation = decoder.orientation().map_err(|error| format.refused(&error))?;
    let (width, height) = (width as usize, height as usize);
    let is_turned = is_quarter_turn(orientation);
    let fitting = size.fitting(if is_turned { (height, width) } else { (width, height) })?;
    let mut image = image(decoder).map_err(|error| format.refused(&error))?;
    if let Some(fitting) = fitting {
        let as_it_lies = if is_turned { fitting.turned() } else { fitting };
        image = as_it_lies.apply(&image);
    }
    let mut shown = DynamicImage::ImageRgb8(image);
    shown.apply_orientation(orientation);
    let (width, height) = (shown.width() as usize, shown.height() as usize);
    Ok((RgbImage { width, height, data: shown.into_rgb8().into_raw() }, fitting))
}

fn image(mut decoder: Box<dyn ImageDecoder + '_>) -> ImageResult<image::RgbImage> {
    let mut limits = Limits::no_limits();
    limits.max_alloc = Some(MAX_PIXELS * 4);
    decoder.set_limits(limits)?;
    DynamicImage::from_decoder(decoder).map(DynamicImage::into_rgb8)
}
