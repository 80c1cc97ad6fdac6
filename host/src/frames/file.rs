//! Frames on disk: reading a file whole, and replacing it whole or not at all.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use halfrow_model::Frame;

use super::format::Format;
use super::preview::{RgbImage, encode_png_rgb};
use super::size::MAX_FILE_BYTES;
use super::{ReadError, ReadOptions, WriteError, png};
use crate::written_aside::write_aside;

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

/// Writes `frame` to the file `path`, in the format that its extension names: `.pgm`, `.png`, `.tif` or `.tiff`, `.dng`, or
/// `.raw` (16 bits, low byte first). Whatever goes wrong, the file is whole or as it was.
///
/// # Errors
/// [`WriteError`] when the extension is another, the file exists and `overwrite` is false, or it cannot be written.
pub fn write(path: &Path, frame: &Frame, overwrite: bool) -> Result<(), WriteError> {
    let bytes = Format::of(path)?
        .encode(frame)
        .map_err(|source| WriteError::Encode { path: path.to_owned(), source })?;
    Ok(write_aside(path, overwrite, |out| out.write_all(&bytes))?)
}

/// Writes `image` to the PNG file `path`, which is whole or as it was, whatever goes wrong.
///
/// # Errors
/// [`WriteError`] when the extension is not `.png`, the file exists and `overwrite` is false, or it cannot be written.
pub fn write_rgb(path: &Path, image: &RgbImage, overwrite: bool) -> Result<(), WriteError> {
    if !matches!(Format::of(path), Ok(Format::Png)) {
        return Err(WriteError::NotPng { path: path.to_owned() });
    }
    let mut bytes = Vec::new();
    encode_png_rgb(image, &mut bytes)
        .map_err(|source| WriteError::Encode { path: path.to_owned(), source: source.into() })?;
    Ok(write_aside(path, overwrite, |out| out.write_all(&bytes))?)
}
