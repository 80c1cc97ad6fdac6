//! The formats in which frames are written.

use std::fmt;
use std::io::{self, Cursor};
use std::path::Path;
use std::str::FromStr;

use halfrow_model::{BitDepth, Frame};

use super::{Camera, EncodeError, FrameShape, WriteError, dng, pgm, png, raw, tiff};

/// A format in which frames are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// A portable greymap, binary.
    Pgm,
    /// Grey samples, compressed.
    Png,
    /// Grey samples.
    Tiff,
    /// Raw samples for raw developers.
    Dng,
    /// Words of 16 bits, the low byte first, without a header.
    Raw,
}

/// The word is not the name of a format for frames.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` is no format for frames; use pgm, png, tif, dng or raw")]
pub struct UnknownFormat(String);

impl Format {
    /// All formats.
    pub const ALL: [Self; 5] = [Self::Pgm, Self::Png, Self::Tiff, Self::Dng, Self::Raw];

    /// The extension of its files, which is also the name that [`FromStr`] reads.
    #[must_use]
    pub fn extension(self) -> &'static str {
        match self {
            Self::Pgm => "pgm",
            Self::Png => "png",
            Self::Tiff => "tif",
            Self::Dng => "dng",
            Self::Raw => "raw",
        }
    }

    /// The format that the extension of `path` names.
    ///
    /// # Errors
    /// [`WriteError::Extension`] when it names none.
    pub fn of(path: &Path) -> Result<Self, WriteError> {
        let extension = path.extension().and_then(|extension| extension.to_str());
        let named = extension.and_then(|extension| extension.parse().ok());
        named.ok_or_else(|| WriteError::Extension { path: path.to_owned() })
    }

    /// Whether a file is a header and then one row after the other, and so can be written row by row.
    pub(super) fn has_plain_rows(self) -> bool {
        matches!(self, Self::Pgm | Self::Raw)
    }

    /// Writes what comes before the rows; only for formats for which [`Self::has_plain_rows`] holds.
    pub(super) fn write_header(self, shape: &FrameShape, out: &mut dyn io::Write) -> io::Result<()> {
        match self {
            Self::Pgm => pgm::write_header(out, (shape.width, shape.height), shape.depth),
            _ => Ok(()),
        }
    }

    /// Appends the bytes of a row to `line`; only for formats for which [`Self::has_plain_rows`] holds.
    pub(super) fn pack(self, row: &[u16], depth: BitDepth, line: &mut Vec<u8>) {
        match self {
            Self::Pgm => pgm::pack(row, depth, line),
            _ => raw::pack(row, line),
        }
    }

    pub(super) fn encode(self, frame: &Frame, camera: &Camera) -> Result<Vec<u8>, EncodeError> {
        let mut bytes = Vec::new();
        match self {
            Self::Pgm => pgm::encode(frame, &mut bytes)?,
            Self::Png => png::encode(frame, &mut bytes)?,
            Self::Tiff => tiff::encode(frame, camera.orientation, &mut Cursor::new(&mut bytes))?,
            Self::Dng => dng::encode(frame, camera, &mut Cursor::new(&mut bytes))?,
            Self::Raw => raw::encode(frame, &mut bytes)?,
        }
        Ok(bytes)
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.extension())
    }
}

impl FromStr for Format {
    type Err = UnknownFormat;

    fn from_str(text: &str) -> Result<Self, UnknownFormat> {
        let mut formats = Self::ALL.into_iter();
        let known = formats.find(|format| format.extension().eq_ignore_ascii_case(text));
        let known = known.or_else(|| text.eq_ignore_ascii_case("tiff").then_some(Self::Tiff));
        known.ok_or_else(|| UnknownFormat(text.to_owned()))
    }
}
