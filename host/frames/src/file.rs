//! Frames on disk: reading a whole file, and replacing it whole or not at all.

use std::fs::File;
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

use halfrow_model::{Frame, FrameError};

use super::format::Format;
use super::preview::{RgbImage, encode_png_rgb};
use super::size::MAX_FILE_BYTES;
use super::{
    Camera, DecodeError, Decoded, FrameShape, PictureSize, ReadError, ReadOptions, WriteError, photograph,
    png,
};
use halfrow_files::written_aside::{BUFFER, write_aside};

/// The frame in the file `path`. Its bytes determine the format, not its name; for a file without a header, `how.raw` does.
///
/// # Errors
/// [`ReadError`] when the file cannot be read or holds no frame as `how` describes it.
pub fn read(path: &Path, how: &ReadOptions) -> Result<Frame, ReadError> {
    FrameFile::read(path)?.decode(how).map(|decoded| decoded.frame)
}

/// The bytes of a file that is not longer than any frame. The file may change meanwhile, so these bytes are both decoded and
/// hashed.
#[derive(Debug)]
pub struct FrameFile {
    path: PathBuf,
    bytes: Vec<u8>,
}

impl FrameFile {
    /// The whole file `path`.
    ///
    /// # Errors
    /// [`ReadError`] when it cannot be read, or is too long.
    pub fn read(path: &Path) -> Result<Self, ReadError> {
        let opened = File::open(path).map_err(|source| ReadError::Io { path: path.to_owned(), source })?;
        Self::of_open(opened, path)
    }

    /// The rest of `input`, which is the open file `path`.
    fn of_open(input: File, path: &Path) -> Result<Self, ReadError> {
        let (path, mut bytes) = (path.to_owned(), Vec::new());
        match input.take(MAX_FILE_BYTES as u64 + 1).read_to_end(&mut bytes) {
            Err(source) => Err(ReadError::Io { path, source }),
            Ok(_) if bytes.len() > MAX_FILE_BYTES => Err(ReadError::TooLong { path }),
            Ok(_) => Ok(Self { path, bytes }),
        }
    }

    /// All of it.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Its frame, like [`read`], and how a picture was fitted.
    ///
    /// # Errors
    /// [`ReadError`] when it holds no frame as `how` describes it.
    pub fn decode(&self, how: &ReadOptions) -> Result<Decoded, ReadError> {
        let _file = tracing::warn_span!("frame", path = %self.path.display()).entered();
        super::decode_fitted(&self.bytes, how).map_err(|source| self.wrong(source))
    }

    /// Its picture, like [`read_rgb`].
    ///
    /// # Errors
    /// [`ReadError`] when it holds no such picture.
    pub fn decode_rgb(&self) -> Result<RgbImage, ReadError> {
        png::decode_rgb(&self.bytes).map_err(|source| self.wrong(source))
    }

    fn wrong(&self, source: DecodeError) -> ReadError {
        ReadError::Decode { path: self.path.clone(), source }
    }
}

/// The frame in `input`, which is the open file `path`, at its beginning.
///
/// # Errors
/// Those of [`read`].
pub(super) fn read_open(input: File, path: &Path, how: &ReadOptions) -> Result<Decoded, ReadError> {
    FrameFile::of_open(input, path)?.decode(how)
}

/// The picture in the PNG file `path`, in red, green and blue of 8 bits.
///
/// # Errors
/// [`ReadError`] when the file cannot be read or holds no such picture.
pub fn read_rgb(path: &Path) -> Result<RgbImage, ReadError> {
    FrameFile::read(path)?.decode_rgb()
}

/// The picture in the file `path`, in red, green and blue of 8 bits: a PNG that [`read_rgb`] reads, or a photograph, turned by
/// its EXIF orientation.
///
/// # Errors
/// [`ReadError`] when the file cannot be read or holds no such picture.
pub fn read_shown(path: &Path) -> Result<RgbImage, ReadError> {
    let file = FrameFile::read(path)?;
    match photograph::PhotographFormat::of(&file.bytes) {
        Some(format) => match photograph::shown(format, &file.bytes, PictureSize::Any) {
            Ok((picture, _)) => Ok(picture),
            Err(source) => Err(file.wrong(source)),
        },
        None if file.bytes.is_empty() => Err(file.wrong(DecodeError::Empty)),
        None if !file.bytes.starts_with(png::MAGIC) => Err(file.wrong(DecodeError::Unsupported {
            what: "what begins like no PNG, JPEG, WebP or BMP".to_owned(),
            remedy: "give one of these, or export it again",
        })),
        None => file.decode_rgb(),
    }
}

/// Writes `frame` to the file `path`, in the format that its extension names: `.pgm`, `.png`, `.tif` or `.tiff`, `.dng`, or
/// `.raw` (16 bits, low byte first). Whatever goes wrong, the file is whole or as before.
///
/// # Errors
/// [`WriteError`] when the extension is none of these, the file exists and `overwrite` is false, or it cannot be written.
pub fn write(path: &Path, frame: &Frame, overwrite: bool) -> Result<(), WriteError> {
    write_taken(path, frame, &Camera::default(), overwrite)
}

/// Like [`write()`], for a frame that `camera` took: a DNG records all of it, a TIFF the orientation.
///
/// # Errors
/// Those of [`write()`].
pub fn write_taken(path: &Path, frame: &Frame, camera: &Camera, overwrite: bool) -> Result<(), WriteError> {
    let bytes = Format::of(path)?
        .encode(frame, camera)
        .map_err(|source| WriteError::Encode { path: path.to_owned(), source })?;
    Ok(write_aside(path, overwrite, |out| out.write_all(&bytes))?)
}

/// Writes a frame of `shape` to the file `path`, as [`write()`] does. `next_row` fills each row in turn. If the format stores
/// plain rows one after the other, only one row is held in memory.
///
/// # Errors
/// [`WriteError`], as `E`: those of [`write()`], and when the rows are not a frame: `shape` has no rows or an odd width, or a
/// sample exceeds its depth. Also the errors of `next_row`. Nothing is written then.
pub fn write_rows<E: From<WriteError>>(
    path: &Path,
    shape: &FrameShape,
    overwrite: bool,
    next_row: impl FnMut(&mut [u16]) -> Result<(), E>,
) -> Result<(), E> {
    let format = Format::of(path)?;
    shape.check().map_err(|refused| no_frame(path, refused))?;
    if format.has_plain_rows() {
        return write_plain_rows(path, format, shape, overwrite, next_row);
    }
    let mut samples = vec![0; shape.width * shape.height];
    samples.chunks_exact_mut(shape.width).try_for_each(next_row)?;
    let frame = Frame::new(shape.width, shape.depth, shape.phase, samples);
    let frame = frame.map_err(|refused| no_frame(path, refused))?;
    Ok(write_taken(path, &frame, &shape.camera, overwrite)?)
}

fn no_frame(path: &Path, source: FrameError) -> WriteError {
    WriteError::Encode { path: path.to_owned(), source: source.into() }
}

fn write_plain_rows<E: From<WriteError>>(
    path: &Path,
    format: Format,
    shape: &FrameShape,
    overwrite: bool,
    mut next_row: impl FnMut(&mut [u16]) -> Result<(), E>,
) -> Result<(), E> {
    let mut refused = None;
    let written = write_aside(path, overwrite, |out| {
        let (mut row, mut blocks) = (vec![0; shape.width], Blocks::new(out));
        format.write_header(shape, &mut blocks.bytes)?;
        for index in 0..shape.height {
            let checked = next_row(&mut row).and_then(|()| {
                Ok(FrameError::check_row(index, shape.depth, &row)
                    .map_err(|refused| no_frame(path, refused))?)
            });
            if let Err(error) = checked {
                refused = Some(error);
                return Err(io::ErrorKind::Other.into());
            }
            format.pack(&row, shape.depth, &mut blocks.bytes);
            blocks.write_whole()?;
        }
        blocks.write_rest()
    });
    match refused {
        Some(error) => Err(error),
        None => Ok(written.map_err(WriteError::from)?),
    }
}

/// Output to a file in blocks that begin at multiples of their length: the system keeps such a block in a few large pages, and
/// any other in many small ones.
struct Blocks<'a> {
    out: &'a mut dyn Write,
    bytes: Vec<u8>,
}

impl<'a> Blocks<'a> {
    fn new(out: &'a mut dyn Write) -> Self {
        Self { out, bytes: Vec::with_capacity(2 * BUFFER) }
    }

    /// Writes the blocks that are whole.
    fn write_whole(&mut self) -> io::Result<()> {
        let whole = self.bytes.len() / BUFFER * BUFFER;
        if whole > 0 {
            self.out.write_all(&self.bytes[..whole])?;
            self.bytes.drain(..whole);
        }
        Ok(())
    }

    /// Writes what is left.
    fn write_rest(self) -> io::Result<()> {
        self.out.write_all(&self.bytes)
    }
}

/// Whether `path` names a PNG file.
///
/// # Errors
/// [`WriteError::NotPng`] when its extension is not `.png`.
pub fn check_png(path: &Path) -> Result<(), WriteError> {
    match Format::of(path) {
        Ok(Format::Png) => Ok(()),
        _ => Err(WriteError::NotPng { path: path.to_owned() }),
    }
}

/// Writes `image` to the PNG file `path`, which is whole or as before, whatever goes wrong.
///
/// # Errors
/// [`WriteError`] when the extension is not `.png`, the file exists and `overwrite` is false, or it cannot be written.
pub fn write_rgb(path: &Path, image: &RgbImage, overwrite: bool) -> Result<(), WriteError> {
    check_png(path)?;
    let mut bytes = Vec::new();
    encode_png_rgb(image, &mut bytes)
        .map_err(|source| WriteError::Encode { path: path.to_owned(), source: source.into() })?;
    Ok(write_aside(path, overwrite, |out| out.write_all(&bytes))?)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Keeps each write separately.
    #[derive(Default)]
    struct Writes(Vec<Vec<u8>>);

    impl Write for Writes {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            self.0.push(bytes.to_vec());
            Ok(bytes.len())
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn all_but_the_last_write_are_whole_blocks() {
        let (mut writes, mut wanted) = (Writes::default(), Vec::new());
        let mut blocks = Blocks::new(&mut writes);
        for (number, length) in [18, BUFFER - 18, 3840, BUFFER, 3 * BUFFER + 7, 5].into_iter().enumerate() {
            let piece = vec![number as u8; length];
            wanted.extend_from_slice(&piece);
            blocks.bytes.extend_from_slice(&piece);
            blocks.write_whole().unwrap();
        }
        blocks.write_rest().unwrap();
        let (last, whole) = writes.0.split_last().unwrap();
        assert!(whole.iter().all(|write| write.len().is_multiple_of(BUFFER)) && last.len() < BUFFER);
        assert_eq!(writes.0.concat(), wanted);
    }
}
