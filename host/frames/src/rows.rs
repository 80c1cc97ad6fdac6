//! Frames row by row: where the format allows it, a frame of any height takes the memory of a few rows.

use std::fs::File;
use std::io::{Read as _, Seek as _, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use halfrow_model::{BitDepth, Frame, FrameError, Phase};

use super::raster::Raster;
use super::{Camera, Decoded, Fitting, ReadError, ReadOptions, file, narrow, pgm, raw};

/// Bytes in which the header of a PGM is looked for. A file with a longer header is read whole.
const HEAD: u64 = 4096;
/// How many bytes are read at once.
const BUFFER: usize = 1 << 17;

/// Everything about a frame but its samples.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FrameShape {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// The bits of a sample.
    pub depth: BitDepth,
    /// The arrangement of the colours.
    pub phase: Phase,
    /// How it was taken, which a DNG records, and of which a TIFF records the orientation.
    pub camera: Camera,
}

impl FrameShape {
    /// Refuses a shape that no [`halfrow_model::Frame`] has.
    pub(super) fn check(&self) -> Result<(), FrameError> {
        if self.height == 0 {
            return Err(FrameError::Empty);
        }
        FrameError::check_width(self.width)
    }
}

/// The rows of a frame, from the top.
#[derive(Debug)]
pub struct RowReader {
    width: usize,
    height: usize,
    next: usize,
    fitting: Option<Fitting>,
    camera: Camera,
    is_coded: bool,
    source: Source,
}

#[derive(Debug)]
enum Source {
    File(Lines),
    Frame(Arc<Frame>),
}

/// The rows of a file, some read ahead.
#[derive(Debug)]
struct Lines {
    path: PathBuf,
    input: File,
    raster: Raster,
    depth: BitDepth,
    /// Whole rows.
    bytes: Vec<u8>,
    /// How many of these bytes have been unpacked.
    taken: usize,
}

impl RowReader {
    /// The rows of the frame in the file `path`. Its bytes determine the format, not its name; for a file without a header,
    /// `how.raw` does. What cannot be read row by row is read whole.
    ///
    /// # Errors
    /// [`ReadError`] when the file cannot be read, or when its header or its length is not that of a frame; if it is read
    /// whole, also when its content is not.
    pub fn open(path: &Path, how: &ReadOptions) -> Result<Self, ReadError> {
        let failed = |source| ReadError::Io { path: path.to_owned(), source };
        let mut input = File::open(path).map_err(failed)?;
        let about = input.metadata().map_err(failed)?;
        // A pipe cannot be read twice, so its header is not looked for.
        let raster = if about.is_file() { raster(&mut input, how).map_err(failed)? } else { None };
        let Some(raster) = raster else { return file::read_open(input, path, how).map(Self::from) };
        let length = usize::try_from(about.len()).unwrap_or(usize::MAX);
        let checked = raster.check_length(length);
        checked.map_err(|source| ReadError::Decode { path: path.to_owned(), source })?;
        let _file = tracing::warn_span!("frame", path = %path.display()).entered();
        narrow::note(raster.full(), how.depth);
        input.seek(SeekFrom::Start(raster.start as u64)).map_err(failed)?;
        let lines =
            Lines { path: path.to_owned(), input, raster, depth: how.depth, bytes: Vec::new(), taken: 0 };
        let source = Source::File(lines);
        let (width, height, camera) = (raster.width, raster.height, Camera::default());
        Ok(Self { width, height, next: 0, fitting: None, camera, is_coded: false, source })
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

    /// How the picture that the frame was made from was brought to its size, if it was.
    #[must_use]
    pub fn fitting(&self) -> Option<Fitting> {
        self.fitting
    }

    /// How the frame was taken.
    #[must_use]
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// Whether its colours are coded for the screen; see [`Decoded::is_coded`].
    #[must_use]
    pub fn is_coded(&self) -> bool {
        self.is_coded
    }

    /// Reads the next row into the first [`Self::width`] of `samples`, and returns whether there was one.
    ///
    /// # Panics
    /// When `samples` has fewer.
    ///
    /// # Errors
    /// [`ReadError`] when the file cannot be read, or a sample exceeds its depth or its header's maxval.
    pub fn next_row(&mut self, samples: &mut [u16]) -> Result<bool, ReadError> {
        let (index, samples) = (self.next, &mut samples[..self.width]);
        if index == self.height {
            return Ok(false);
        }
        self.next += 1;
        match &mut self.source {
            Source::Frame(frame) => samples.copy_from_slice(frame.row(index)),
            Source::File(lines) => lines.unpack(index, samples)?,
        }
        Ok(true)
    }
}

impl Lines {
    /// Unpacks row `index`, which must be the next one.
    fn unpack(&mut self, index: usize, samples: &mut [u16]) -> Result<(), ReadError> {
        let length = self.raster.line_bytes();
        if self.taken == self.bytes.len() {
            let rows = (BUFFER / length).clamp(1, self.raster.height - index);
            self.bytes.resize(rows * length, 0);
            let read = self.input.read_exact(&mut self.bytes);
            read.map_err(|source| ReadError::Io { path: self.path.clone(), source })?;
            self.taken = 0;
        }
        let line = &self.bytes[self.taken..][..length];
        self.taken += length;
        let unpacked = self.raster.unpack(index, line, self.depth, samples);
        unpacked.map_err(|source| ReadError::Decode { path: self.path.clone(), source })
    }
}

impl From<Decoded> for RowReader {
    fn from(decoded: Decoded) -> Self {
        let Decoded { frame, fitting, camera, is_coded } = decoded;
        Self { fitting, camera, is_coded, ..Self::from(frame) }
    }
}

impl From<Frame> for RowReader {
    fn from(frame: Frame) -> Self {
        Self::from(Arc::new(frame))
    }
}

impl From<Arc<Frame>> for RowReader {
    fn from(frame: Arc<Frame>) -> Self {
        Self {
            width: frame.width(),
            height: frame.height(),
            next: 0,
            fitting: None,
            camera: Camera::default(),
            is_coded: false,
            source: Source::Frame(frame),
        }
    }
}

/// Where the rows are, if the format of `input` has them uncompressed. None also if the header is wrong: reading the whole file
/// then reports that.
fn raster(input: &mut File, how: &ReadOptions) -> std::io::Result<Option<Raster>> {
    let found = match how.raw {
        Some(geometry) => raw::raster(geometry),
        None => {
            let mut head = Vec::with_capacity(HEAD as usize);
            input.take(HEAD).read_to_end(&mut head)?;
            pgm::raster(&head)
        }
    };
    input.rewind()?;
    Ok(found.ok().filter(|raster| raster.height > 0 && raster.width > 0 && raster.width.is_multiple_of(2)))
}
