//! JPEG. The file is checked before the decoder sees it, because the decoder fills in what is missing or what it does not know.
//!
//! Markers and their names are those of ITU-T T.81, table B.1.

use std::borrow::Cow;
use std::io;

use image::error::{DecodingError, ImageFormatHint, UnsupportedError, UnsupportedErrorKind};
use image::{ColorType, ImageDecoder, ImageError, ImageFormat, ImageResult};
use zune_jpeg::JpegDecoder;
use zune_jpeg::errors::DecodeErrors;
use zune_jpeg::zune_core::bytestream::ZCursor;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

use super::DecodeError;
use super::error::BROKEN_OFF;
use super::photograph::PhotographFormat;

/// The first bytes of a JPEG.
pub(super) const MAGIC: &[u8] = b"\xff\xd8\xff";

/// Start of scan.
const SCAN: u8 = 0xda;
/// End of image.
const END: u8 = 0xd9;
/// Start of frame of the progressive process.
const PROGRESSIVE: u8 = 0xc2;
/// The most pixels that a coded byte can represent: each block of 8 x 8 takes at least a bit.
const PIXELS_A_BYTE: u64 = 8 * 8 * 8;
/// What replaces the end-of-image marker. The decoder reads up to nine bytes ahead, so it reaches the end of these bytes only if
/// samples are missing.
const BEYOND: [u8; 16] = [0; 16];
/// How to save a JPEG of another kind.
const REMEDY: &str = "save it as a baseline or progressive JPEG of 8 bits in RGB";

/// A JPEG whose headers are read.
pub(super) struct Jpeg<'a> {
    /// As [`checked`] returns them.
    bytes: Cow<'a, [u8]>,
    size: (u32, u32),
    is_grey: bool,
    exif: Option<Vec<u8>>,
}

type Decoder<'a> = JpegDecoder<ZCursor<&'a [u8]>>;

impl<'a> Jpeg<'a> {
    /// The JPEG in `bytes`.
    ///
    /// # Errors
    /// [`DecodeError`] when its headers show that it is damaged, or of a kind that is not accepted.
    pub(super) fn new(bytes: &'a [u8]) -> Result<Self, DecodeError> {
        let bytes = checked(bytes)?;
        let decoder = with_headers(&bytes, ColorSpace::RGB);
        let decoder = decoder.map_err(|error| PhotographFormat::Jpeg.refused(&found(error)))?;
        let size = decoder.info().map_or((0, 0), |info| (info.width.into(), info.height.into()));
        let is_grey = decoder.input_colorspace() == Some(ColorSpace::Luma);
        let exif = decoder.exif().cloned();
        Ok(Self { bytes, size, is_grey, exif })
    }
}

/// Reads the headers of a JPEG that will be decoded to `colours`. Unknown bytes are skipped between headers, but not among
/// samples.
fn with_headers(bytes: &[u8], colours: ColorSpace) -> Result<Decoder<'_>, DecodeErrors> {
    let options = DecoderOptions::default()
        .jpeg_set_out_colorspace(colours)
        .set_max_width(usize::MAX)
        .set_max_height(usize::MAX);
    let mut decoder = JpegDecoder::new_with_options(ZCursor::new(bytes), options.set_strict_mode(false));
    decoder.decode_headers()?;
    decoder.set_options(options.set_strict_mode(true));
    Ok(decoder)
}

impl ImageDecoder for Jpeg<'_> {
    fn dimensions(&self) -> (u32, u32) {
        self.size
    }

    fn color_type(&self) -> ColorType {
        if self.is_grey { ColorType::L8 } else { ColorType::Rgb8 }
    }

    fn exif_metadata(&mut self) -> ImageResult<Option<Vec<u8>>> {
        Ok(self.exif.clone())
    }

    fn read_image(self, samples: &mut [u8]) -> ImageResult<()> {
        if u64::from(self.size.0) * u64::from(self.size.1) / PIXELS_A_BYTE > self.bytes.len() as u64 {
            return Err(found(DecodeErrors::ExhaustedData));
        }
        let colours = if self.is_grey { ColorSpace::Luma } else { ColorSpace::RGB };
        with_headers(&self.bytes, colours).and_then(|mut it| it.decode_into(samples)).map_err(found)
    }

    fn read_image_boxed(self: Box<Self>, samples: &mut [u8]) -> ImageResult<()> {
        (*self).read_image(samples)
    }
}

/// The decoder's error as an error of the `image` crate.
fn found(error: DecodeErrors) -> ImageError {
    let format = ImageFormatHint::Exact(ImageFormat::Jpeg);
    match error {
        DecodeErrors::ExhaustedData | DecodeErrors::FormatStatic("Premature end of buffer") => {
            ImageError::IoError(io::ErrorKind::UnexpectedEof.into())
        }
        DecodeErrors::Unsupported(_) => ImageError::Unsupported(UnsupportedError::from_format_and_kind(
            format.clone(),
            UnsupportedErrorKind::Format(format),
        )),
        error => ImageError::Decoding(DecodingError::new(format, error)),
    }
}

/// Refuses a JPEG that breaks off, or that is anything but 8 bits, grey or three colours, Huffman-coded by the baseline,
/// extended or progressive process. Bytes after its end are dropped: cameras append data there. Unless it is progressive,
/// [`BEYOND`] replaces its end.
///
/// # Errors
/// [`DecodeError`] that names what is not accepted.
fn checked(bytes: &[u8]) -> Result<Cow<'_, [u8]>, DecodeError> {
    let mut segments = Segments { bytes, place: 2 };
    let mut frame = None;
    loop {
        let (marker, content) = segments.next().ok_or_else(|| damaged(BROKEN_OFF))?;
        match (marker, frame) {
            (END, None) => return Err(damaged("it ends before its picture")),
            (END, Some(PROGRESSIVE)) => return Ok(bytes[..segments.place].into()),
            (END, Some(_)) => return Ok([&bytes[..segments.place - 2], &BEYOND].concat().into()),
            (SCAN, _) => segments.skip_scan(),
            (0xc0..=0xcf, _) if !matches!(marker, 0xc4 | 0xc8 | 0xcc) => {
                check_frame(marker, content)?;
                frame = Some(marker);
            }
            _ => {}
        }
    }
}

/// Refuses a frame header, under `marker`, of a kind that is not accepted.
fn check_frame(marker: u8, header: &[u8]) -> Result<(), DecodeError> {
    let &[bits, _, _, _, _, colours, ..] = header else {
        return Err(damaged("its frame header is too short"));
    };
    let what = match (marker, bits, colours) {
        (0xc3 | 0xc7 | 0xcb | 0xcf, ..) => "a lossless JPEG".to_owned(),
        (0xc9.., ..) => "a JPEG that is coded arithmetically".to_owned(),
        (0xc5.., ..) => "a hierarchical JPEG".to_owned(),
        (_, 8, 1 | 3) => return Ok(()),
        (_, 8, 4) => "a CMYK JPEG".to_owned(),
        (_, 8, _) => format!("a JPEG of {colours} colours"),
        _ => format!("a JPEG of {bits} bits a sample"),
    };
    Err(DecodeError::Unsupported { what, remedy: REMEDY })
}

fn damaged(reason: &str) -> DecodeError {
    PhotographFormat::Jpeg.damaged(reason)
}

/// The segments of a JPEG, each a marker and what its length covers.
struct Segments<'a> {
    bytes: &'a [u8],
    place: usize,
}

impl<'a> Iterator for Segments<'a> {
    type Item = (u8, &'a [u8]);

    fn next(&mut self) -> Option<Self::Item> {
        // There may be fill bytes before a marker, and some cameras leave other bytes after a segment.
        let marker = loop {
            match self.bytes.get(self.place..)? {
                [0xff, marker @ 1..=0xfe, ..] => break *marker,
                [_, ..] => self.place += 1,
                [] => return None,
            }
        };
        self.place += 2;
        if matches!(marker, 1 | 0xd0..=END) {
            return Some((marker, &[]));
        }
        let &length = self.bytes.get(self.place..)?.first_chunk()?;
        let content = self
            .bytes
            .get(self.place + 2..)?
            .get(..usize::from(u16::from_be_bytes(length)).checked_sub(2)?)?;
        self.place += 2 + content.len();
        Some((marker, content))
    }
}

impl Segments<'_> {
    /// Goes to the next marker after the coded samples of a scan. Among the samples, 0xff is followed by zero or a restart.
    fn skip_scan(&mut self) {
        let rest = self.bytes.get(self.place..).unwrap_or_default();
        let end =
            rest.windows(2).position(|pair| pair[0] == 0xff && !matches!(pair[1], 0 | 0xd0..=0xd7 | 0xff));
        self.place += end.unwrap_or(rest.len());
    }
}
