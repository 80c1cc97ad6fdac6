//! Recordings: every byte of a run with its time, in a file from which the run can be judged again without a board.
//!
//! ```text
//! "halfrow recording 1\n"
//! one line of JSON                     the link, and what the host needs to hold the conversation again
//! then for every exchange: u64 time in nanoseconds, u32 taken, u32 received, the bytes taken, the bytes received
//! before one that changed them: u64 0, u32 2^32 - 1, u32 32, u64 overruns, parity, framing, breaks: the line's errors so far
//! ```
//! Integers are little endian. A recording that ends early is that of an interrupted run.

use std::fmt;
use std::fs::File;
use std::io::{self, Read as _, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};
use std::time::Duration;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use super::{LineErrors, Link, LinkError};
use halfrow_files::written_aside::{Aside, Unfinished, WriteAsideError};
use halfrow_files::{NotRegular, check_regular};

const MAGIC: &[u8] = b"halfrow recording 1\n";

/// A file that is no recording, or cannot be one.
#[derive(Debug, thiserror::Error)]
pub enum RecordingError {
    /// It cannot be created.
    #[error(transparent)]
    Create(#[from] WriteAsideError),
    /// It is a pipe, which may never begin, or a device, which may never end.
    #[error(transparent)]
    NotRegular(#[from] NotRegular),
    /// The recording's file cannot be read.
    #[error("the recording {path} cannot be read; check the path in replay:FILE")]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        #[source]
        source: io::Error,
    },
    /// The file is not a recording, or is one of another version.
    #[error("{0} is no recording of this version; record a run with `halfrow verify`")]
    Foreign(PathBuf),
    /// The beginning of the recording cannot be understood.
    #[error("the head of the recording {path} is damaged; make the recording again")]
    Head {
        /// The file.
        path: PathBuf,
        /// Why.
        #[source]
        source: serde_json::Error,
    },
}

#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Head<T> {
    link: String,
    pub(super) bytes_per_second: Option<f64>,
    #[serde(default)]
    pub(super) exclusive: bool,
    #[serde(default)]
    pub(super) waits_for_cts: bool,
    run: T,
}

/// Stands for `taken` in front of the line's errors: no exchange takes so many bytes.
const LINE_ERRORS: u32 = u32::MAX;

/// What one call of [`Link::exchange`] moved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Exchange<'a> {
    pub(super) at: Duration,
    pub(super) taken: &'a [u8],
    pub(super) received: &'a [u8],
    /// The line's errors so far; none if they are as before.
    pub(super) line_errors: Option<LineErrors>,
}

impl<'a> Exchange<'a> {
    fn write(&self, file: &mut impl Write) -> io::Result<()> {
        if let Some(LineErrors { overrun, parity, framing, breaks }) = self.line_errors {
            let counts = [overrun, parity, framing, breaks].map(u64::to_le_bytes);
            let length = size_of_val(&counts) as u32;
            file.write_all(&[0; size_of::<u64>()])?;
            file.write_all(&[LINE_ERRORS, length].map(u32::to_le_bytes).concat())?;
            file.write_all(&counts.concat())?;
        }
        let nanoseconds = u64::try_from(self.at.as_nanos()).unwrap_or(u64::MAX);
        let length = |bytes: &[u8]| u32::try_from(bytes.len()).unwrap_or(u32::MAX).to_le_bytes();
        file.write_all(&nanoseconds.to_le_bytes())?;
        file.write_all(&length(self.taken))?;
        file.write_all(&length(self.received))?;
        file.write_all(self.taken)?;
        file.write_all(self.received)
    }

    fn read(rest: &mut &'a [u8]) -> Option<Self> {
        let mut after = *rest;
        let mut line_errors = None;
        let (at, taken, received) = loop {
            let (nanoseconds, taken, received) =
                (number(&mut after)?, short_number(&mut after)?, short_number(&mut after)?);
            if taken != LINE_ERRORS {
                break (Duration::from_nanos(nanoseconds), taken, received);
            }
            let mut counts = after.split_off(..received as usize)?;
            let mut count = || number(&mut counts);
            line_errors =
                Some(LineErrors { overrun: count()?, parity: count()?, framing: count()?, breaks: count()? });
        };
        let (taken, received) = (after.split_off(..taken as usize)?, after.split_off(..received as usize)?);
        *rest = after;
        Some(Self { at, taken, received, line_errors })
    }
}

fn number(bytes: &mut &[u8]) -> Option<u64> {
    let (number, after) = bytes.split_first_chunk()?;
    *bytes = after;
    Some(u64::from_le_bytes(*number))
}

fn short_number(bytes: &mut &[u8]) -> Option<u32> {
    let (number, after) = bytes.split_first_chunk()?;
    *bytes = after;
    Some(u32::from_le_bytes(*number))
}

/// The file of a recording that is to be made. It is written aside until the recorder is dropped.
#[derive(Debug)]
pub struct RecordingFile(Aside);

impl RecordingFile {
    /// Makes sure, before a board is opened, that a recording can be written to `path`.
    ///
    /// # Errors
    /// [`RecordingError::Create`] when the file exists and `overwrite` is false, another run is recording to it, or it cannot be
    /// written.
    pub fn prepare(path: &Path, overwrite: bool) -> Result<Self, RecordingError> {
        Ok(Self(Aside::stream(path, overwrite)?))
    }
}

/// A link that records what another link carries.
pub struct Recorder {
    link: Box<dyn Link>,
    file: Option<RecordingFile>,
    /// As last recorded.
    line_errors: LineErrors,
    lost: Lost,
}

/// Why a recording could not be written or finished. Set at the latest when its recorder is dropped; empty if the recording is
/// complete.
pub type Lost = Arc<OnceLock<Unfinished>>;

impl fmt::Debug for Recorder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Recorder").field("link", &self.link.name()).finish_non_exhaustive()
    }
}

impl Recorder {
    /// Records to `file` what `link` carries, after a head that contains `run`.
    ///
    /// # Errors
    /// [`LinkError::Record`] when the file cannot be written.
    pub fn begin(
        link: Box<dyn Link>,
        mut file: RecordingFile,
        run: &impl Serialize,
    ) -> Result<Self, LinkError> {
        let head = Head {
            link: link.name(),
            bytes_per_second: link.bytes_per_second(),
            exclusive: link.is_exclusive(),
            waits_for_cts: link.waits_for_cts(),
            run,
        };
        let mut write_head = || {
            file.0.write_all(MAGIC)?;
            serde_json::to_writer(&mut file.0, &head)?;
            file.0.write_all(b"\n")?;
            file.0.flush()
        };
        write_head().map_err(LinkError::Record)?;
        Ok(Self { link, file: Some(file), line_errors: LineErrors::default(), lost: Lost::default() })
    }

    /// Where a failure to finish the recording will be reported.
    #[must_use]
    pub fn lost(&self) -> Lost {
        Arc::clone(&self.lost)
    }
}

impl Drop for Recorder {
    fn drop(&mut self) {
        let finished = self.file.take().map_or(Ok(()), |file| file.0.put_in_place_or_keep());
        if let Err(unfinished) = finished {
            let _ = self.lost.set(unfinished);
        }
    }
}

impl Link for Recorder {
    fn exchange(
        &mut self,
        outgoing: &[u8],
        incoming: &mut Vec<u8>,
        wait: Duration,
    ) -> Result<usize, LinkError> {
        let before = incoming.len();
        // A link of the caller's own may count what it adds.
        let taken = self.link.exchange(outgoing, incoming, wait)?.min(outgoing.len());
        let seen = self.link.line_errors();
        let line_errors = (seen != std::mem::replace(&mut self.line_errors, seen)).then_some(seen);
        let (sent, received) = (&outgoing[..taken], &incoming[before..]);
        let exchange = Exchange { at: self.link.now(), taken: sent, received, line_errors };
        if let Some(mut file) = self.file.take() {
            match exchange.write(&mut file.0) {
                Ok(()) => self.file = Some(file),
                // The board is judged all the same.
                Err(source) => drop(self.lost.set(file.0.keep_unfinished(source))),
            }
        }
        Ok(taken)
    }

    fn now(&self) -> Duration {
        self.link.now()
    }

    fn bytes_per_second(&self) -> Option<f64> {
        self.link.bytes_per_second()
    }

    fn is_exclusive(&self) -> bool {
        self.link.is_exclusive()
    }

    fn waits_for_cts(&self) -> bool {
        self.link.waits_for_cts()
    }

    fn name(&self) -> String {
        self.link.name()
    }

    fn line_errors(&self) -> LineErrors {
        self.link.line_errors()
    }
}

/// A recording that was read into memory.
#[derive(Debug)]
pub struct Recording {
    path: PathBuf,
    head: String,
    bytes: Vec<u8>,
    /// Offset of the first exchange.
    start: usize,
}

impl Recording {
    /// Reads the recording `path`.
    ///
    /// # Errors
    /// [`RecordingError`] when it cannot be read or is something else.
    pub fn read(path: &Path) -> Result<Self, RecordingError> {
        check_regular(path)?;
        let bytes =
            read_ours(path).map_err(|source| RecordingError::Read { path: path.to_owned(), source })?;
        Self::parse(path, bytes).ok_or_else(|| RecordingError::Foreign(path.to_owned()))
    }

    fn parse(path: &Path, bytes: Vec<u8>) -> Option<Self> {
        let rest = bytes.strip_prefix(MAGIC)?;
        let end = rest.iter().position(|&byte| byte == b'\n')?;
        let head = String::from_utf8(rest[..end].to_vec()).ok()?;
        Some(Self { path: path.to_owned(), head, start: MAGIC.len() + end + 1, bytes })
    }

    /// What the host stored in the head.
    ///
    /// # Errors
    /// [`RecordingError::Head`] when that is not a `T`.
    pub fn run<T: DeserializeOwned>(&self) -> Result<T, RecordingError> {
        self.head().map(|head| head.run)
    }

    pub(super) fn head<T: DeserializeOwned>(&self) -> Result<Head<T>, RecordingError> {
        serde_json::from_str(&self.head)
            .map_err(|source| RecordingError::Head { path: self.path.clone(), source })
    }

    /// The file's path.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// All bytes that the host sent, in order, exchange by exchange.
    pub fn sent(&self) -> impl Iterator<Item = &[u8]> {
        let mut place = self.start;
        std::iter::from_fn(move || self.next(&mut place)).map(|exchange| exchange.taken)
    }

    /// How many bytes the host sent in the exchanges from `place` on.
    pub(super) fn sent_from(&self, mut place: usize) -> usize {
        std::iter::from_fn(|| self.next(&mut place).map(|exchange| exchange.taken.len())).sum()
    }

    /// The offset of the first exchange, for [`Self::next`].
    pub(super) fn start(&self) -> usize {
        self.start
    }

    /// The exchange at `place`. Moves `place` to the following one.
    pub(super) fn next(&self, place: &mut usize) -> Option<Exchange<'_>> {
        let mut rest = self.bytes.get(*place..)?;
        let exchange = Exchange::read(&mut rest)?;
        *place = self.bytes.len() - rest.len();
        Some(exchange)
    }
}

/// All bytes of a recording. Of any other file, which may be long, only the first ones.
fn read_ours(path: &Path) -> io::Result<Vec<u8>> {
    let file = File::open(path)?;
    let mut bytes = Vec::new();
    (&file).take(MAGIC.len() as u64).read_to_end(&mut bytes)?;
    if bytes == MAGIC {
        (&file).read_to_end(&mut bytes)?;
    }
    Ok(bytes)
}
