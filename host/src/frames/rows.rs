//! Frames row by row, so that a frame of any height takes the memory of a row wherever its format allows it.

use std::fs::File;
use std::io::{BufReader, Read as _, Seek as _, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use halfrow_model::{BitDepth, Frame, Phase};

use super::raster::Raster;
use super::{ReadError, ReadOptions, file, pgm, raw};

/// Bytes in which the header of a PGM is looked for. A file with a longer one is read whole.
const HEAD: u64 = 4096;
/// Bytes that are read at once.
const BUFFER: usize = 1 << 17;

/// What a frame is besides its samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameShape {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// The bits of a sample.
    pub depth: BitDepth,
    /// The arrangement of the colours.
    pub phase: Phase,
}

/// The rows of a frame, from the top.
#[derive(Debug)]
pub struct RowReader {
    width: usize,
    height: usize,
    next: usize,
    source: Source,
}

#[derive(Debug)]
enum Source {
    File { path: PathBuf, input: BufReader<File>, raster: Raster, depth: BitDepth, line: Vec<u8> },
    Frame(Arc<Frame>),
}

impl RowReader {
    /// The rows of the frame in the file `path`. The bytes tell the format, not the name; without a header, `how.raw`
    /// must. What cannot be read row by row is read whole.
    ///
    /// # Errors
    /// [`ReadError`] when the file cannot be read, or its header, its length, or all of it is not that of a frame.
    pub fn open(path: &Path, how: &ReadOptions) -> Result<Self, ReadError> {
        let failed = |source| ReadError::Io { path: path.to_owned(), source };
        let mut input = File::open(path).map_err(failed)?;
        let about = input.metadata().map_err(failed)?;
        // A pipe cannot be read twice, so it is not looked into.
        let raster = if about.is_file() { raster(&mut input, how).map_err(failed)? } else { None };
        let Some(raster) = raster else { return file::read_open(input, path, how).map(Self::from) };
        let length = usize::try_from(about.len()).unwrap_or(usize::MAX);
        let checked = raster.check_length(length);
        checked.map_err(|source| ReadError::Decode { path: path.to_owned(), source })?;
        input.seek(SeekFrom::Start(raster.start as u64)).map_err(failed)?;
        let (input, line) = (BufReader::with_capacity(BUFFER, input), vec![0; raster.line_bytes()]);
        let source = Source::File { path: path.to_owned(), input, raster, depth: how.depth, line };
        Ok(Self { width: raster.width, height: raster.height, next: 0, source })
    }

    /// Columns.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// Reads the next row into the first [`Self::width`] of `samples`, and returns whether there was one.
    ///
    /// # Panics
    /// When there are fewer.
    ///
    /// # Errors
    /// [`ReadError`] when the file cannot be read, or a sample is above its depth or its header's maxval.
    pub fn next_row(&mut self, samples: &mut [u16]) -> Result<bool, ReadError> {
        let (index, samples) = (self.next, &mut samples[..self.width]);
        if index == self.height {
            return Ok(false);
        }
        self.next += 1;
        match &mut self.source {
            Source::Frame(frame) => samples.copy_from_slice(frame.row(index)),
            Source::File { path, input, raster, depth, line } => {
                input.read_exact(line).map_err(|source| ReadError::Io { path: path.clone(), source })?;
                let unpacked = raster.unpack(index, line, *depth, samples);
                unpacked.map_err(|source| ReadError::Decode { path: path.clone(), source })?;
            }
        }
        Ok(true)
    }
}

impl From<Frame> for RowReader {
    fn from(frame: Frame) -> Self {
        Self::from(Arc::new(frame))
    }
}

impl From<Arc<Frame>> for RowReader {
    fn from(frame: Arc<Frame>) -> Self {
        Self { width: frame.width(), height: frame.height(), next: 0, source: Source::Frame(frame) }
    }
}

/// Where the rows are, if `input` is of a format that has them uncompressed. What is wrong with its header is left to be
/// said by who reads all of it.
fn raster(input: &mut File, how: &ReadOptions) -> std::io::Result<Option<Raster>> {
    let found = match how.raw {
        Some(geometry) => raw::raster(geometry),
        None => {
            let mut head = Vec::new();
            input.take(HEAD).read_to_end(&mut head)?;
            pgm::raster(&head)
        }
    };
    input.rewind()?;
    Ok(found.ok().filter(|raster| raster.height > 0 && raster.width > 0 && raster.width.is_multiple_of(2)))
}
