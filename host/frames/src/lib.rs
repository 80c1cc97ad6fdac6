//! Frames: reading, writing, making and viewing them.
//!
//! Raw samples in a file are taken as they are, never rescaled. Only a picture in colour is brought to the size and depth asked
//! for when it is mosaicked. Most files state neither the Bayer phase nor the depth, so [`ReadOptions`] gives both.

#![warn(missing_debug_implementations)]

mod builtin;
mod camera;
pub mod dng;
mod error;
mod file;
mod fitting;
mod format;
mod heat_map;
mod jpeg;
mod mosaic;
mod narrow;
mod orientation;
pub mod parallel;
mod patterns;
pub mod pgm;
mod photograph;
pub mod png;
pub mod preview;
mod raster;
pub mod raw;
mod rows;
mod scene;
mod size;
pub mod street;
pub mod tiff;
mod tiff_bytes;
mod tiff_directory;
mod turned;

use halfrow_model::{BitDepth, Frame, Phase};

pub use builtin::{Builtin, UnknownBuiltin};
pub use camera::Camera;
pub use error::{DecodeError, EncodeError, PackingError, ReadError, WriteError};
pub use file::{FrameFile, check_png, read, read_rgb, read_shown, write, write_rgb, write_rows, write_taken};
pub use fitting::{Fitting, PictureSize};
pub use format::{Format, UnknownFormat};
pub use heat_map::{HeatMap, MAGMA};
pub use mosaic::mosaic;
pub use orientation::Orientation;
pub use raw::{RawGeometry, RawLayout, UnknownLayout};
pub use rows::{FrameShape, RowReader};
pub use scene::Scene;
pub use size::MAX_SIDE;
pub use turned::landscape;

/// What a file does not say about its samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ReadOptions {
    /// The bits of a sample.
    pub depth: BitDepth,
    /// The arrangement of the colours.
    pub phase: Phase,
    /// The geometry of a file without a header. If given, no header is looked for.
    pub raw: Option<RawGeometry>,
    /// How the size of pictures in colour is treated.
    pub size: PictureSize,
}

/// A frame that was read.
#[derive(Clone, Debug, PartialEq)]
pub struct Decoded {
    /// The frame.
    pub frame: Frame,
    /// How the picture that it was made from was brought to its size, if it was.
    pub fitting: Option<Fitting>,
    /// How it was taken. A picture in colour is already turned.
    pub camera: Camera,
    /// Whether its colours are coded for the screen, as those of a JPEG, WebP or BMP are known to be.
    pub is_coded: bool,
}

/// Of raw samples, or of a picture that already had its size.
impl From<Frame> for Decoded {
    fn from(frame: Frame) -> Self {
        Self { frame, fitting: None, camera: Camera::default(), is_coded: false }
    }
}

/// The frame in `bytes`: in the format that they begin with, or without a header if `how.raw` is given.
///
/// # Errors
/// [`DecodeError`] when the bytes are not a frame as `how` describes it.
pub fn decode(bytes: &[u8], how: &ReadOptions) -> Result<Frame, DecodeError> {
    decode_fitted(bytes, how).map(|decoded| decoded.frame)
}

/// Like [`decode`], with how a picture was fitted.
fn decode_fitted(bytes: &[u8], how: &ReadOptions) -> Result<Decoded, DecodeError> {
    if let Some(geometry) = how.raw {
        raw::decode(bytes, geometry, how).map(Decoded::from)
    } else if bytes.starts_with(png::MAGIC) {
        png::picture(bytes, how.size)?.into_frame(how)
    } else if tiff::MAGICS.iter().any(|magic| bytes.starts_with(magic)) {
        tiff::decode_fitted(bytes, how)
    } else if bytes.starts_with(pgm::MAGIC) {
        pgm::decode(bytes, how).map(Decoded::from)
    } else if let Some(format) = photograph::PhotographFormat::of(bytes) {
        photograph::decode(format, bytes, how)
    } else {
        Err(unknown(bytes))
    }
}

/// The error for `bytes` of no supported format. Common formats get a remedy of their own.
fn unknown(bytes: &[u8]) -> DecodeError {
    const PICTURE: &str = "convert it to PNG or TIFF";
    const PHOTOGRAPH: &str = "convert it to JPEG or PNG";
    let (what, remedy) = match bytes {
        [] => return DecodeError::Empty,
        [b'P', b'2', ..] => ("a PGM in plain text (P2)", "convert it to the binary kind (P5)"),
        [b'P', b'3' | b'6', ..] => ("a PPM", PICTURE),
        [b'P', b'1' | b'4', ..] => ("a PBM, black and white,", "give the samples, as PGM, PNG or TIFF"),
        [b'P', b'7', b'\n', ..] => ("a PAM", "convert it to PGM (P5), PNG or TIFF"),
        [b'I', b'I', b'+', 0, ..] | [b'M', b'M', 0, b'+', ..] => ("a BigTIFF", "save it as a classic TIFF"),
        [b'G', b'I', b'F', b'8', ..] => ("a GIF", PICTURE),
        [0, 0, 0, 12, b'J', b'X', b'L', b' ', ..] | [0xff, 0x0a, ..] => ("a JPEG XL", PHOTOGRAPH),
        [_, _, _, _, b'f', b't', b'y', b'p', b'a', b'v', b'i', ..] => ("an AVIF", PHOTOGRAPH),
        [_, _, _, _, b'f', b't', b'y', b'p', b'h' | b'm', b'e' | b'i', ..] => ("a HEIC", PHOTOGRAPH),
        _ => return DecodeError::UnknownFormat,
    };
    DecodeError::Unsupported { what: what.to_owned(), remedy }
}
