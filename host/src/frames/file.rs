//! Frames on disk: the format of a file, reading it whole, and replacing it whole or not at all.

use std::fs::File;
use std::io::{Cursor, Read};
use std::path::Path;

use halfrow_model::Frame;

use super::preview::RgbImage;
use super::size::MAX_FILE_BYTES;
use super::{EncodeError, RawLayout, ReadError, ReadOptions, WriteError, pgm, png, raw, tiff};
use crate::written_aside::write_aside;

/// A format that frames are written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Pgm,
    Png,
    Tiff,
    Raw,
}

impl Format {
    fn of(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?.to_ascii_lowercase();
        match extension.as_str() {
            "pgm" => Some(Self::Pgm),
            "png" => Some(Self::Png),
            "tif" | "tiff" => Some(Self::Tiff),
            "raw" => Some(Self::Raw),
            _ => None,
        }
    }

    fn encode(self, frame: &Frame) -> Result<Vec<u8>, EncodeError> {
        let mut bytes = Vec::new();
        match self {
            Self::Pgm => pgm::encode(frame, &mut bytes)?,
            Self::Png => png::encode(frame, &mut bytes)?,
            Self::Tiff => tiff::encode(frame, &mut Cursor::new(&mut bytes))?,
            Self::Raw => raw::encode(frame, RawLayout::U16Le, &mut bytes)?,
        }
        Ok(bytes)
    }
}

/// The frame in the file `path`. The bytes tell the format, not the name; without a header, `how.raw` must.
///
/// # Errors
/// [`ReadError`] when the file cannot be read or holds no frame as `how` describes it.
pub fn read(path: &Path, how: &ReadOptions) -> Result<Frame, ReadError> {
    super::decode(&bytes(path)?, how).map_err(|source| ReadError::Decode { path: path.to_owned(), source })
}

/// The picture in the PNG file `path`, in red, green and blue of 8 bits.
///
/// # Errors
/// [`ReadError`] when the file cannot be read or holds no such picture.
pub fn read_rgb(path: &Path) -> Result<RgbImage, ReadError> {
    png::decode_rgb(&bytes(path)?).map_err(|source| ReadError::Decode { path: path.to_owned(), source })
}

/// All bytes of a file that is no longer than any frame.
fn bytes(path: &Path) -> Result<Vec<u8>, ReadError> {
    let failed = |source| ReadError::Io { path: path.to_owned(), source };
    let mut bytes = Vec::new();
    let most = MAX_FILE_BYTES as u64 + 1;
    File::open(path).and_then(|file| file.take(most).read_to_end(&mut bytes)).map_err(failed)?;
    if bytes.len() > MAX_FILE_BYTES {
        return Err(ReadError::TooLong { path: path.to_owned() });
    }
    Ok(bytes)
}

/// Writes `frame` to the file `path`, in the format that its extension names: `.pgm`, `.png`, `.tif` or `.tiff`, or
/// `.raw` (16 bits, low byte first). Whatever goes wrong, the file is whole or as it was.
///
/// # Errors
/// [`WriteError`] when the extension is another, the file exists and `overwrite` is false, or it cannot be written.
pub fn write(path: &Path, frame: &Frame, overwrite: bool) -> Result<(), WriteError> {
    let format = Format::of(path).ok_or_else(|| WriteError::Extension { path: path.to_owned() })?;
    let bytes =
        format.encode(frame).map_err(|source| WriteError::Encode { path: path.to_owned(), source })?;
    Ok(write_aside(path, overwrite, |out| out.write_all(&bytes))?)
}
