//! Recordings: every byte of a run with its time, in a file that can be judged again without a board.
//!
//! ```text
//! "halfrow recording 1\n"
//! one line of JSON                     the link, and what the host needs to hold the conversation again
//! then for every exchange: u64 time in nanoseconds, u32 taken, u32 received, the bytes taken, the bytes received
//! ```
//! Integers are little endian. A recording that ends early is one of an interrupted run.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};
use std::time::Duration;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use super::{LineErrors, Link, LinkError};

const MAGIC: &[u8] = b"halfrow recording 1\n";

/// A file that is no recording, or cannot be one.
#[derive(Debug, thiserror::Error)]
pub enum RecordingError {
    /// It cannot be created.
    #[error("the recording {path} cannot be created; choose another place for the recording")]
    Create {
        /// The file.
        path: PathBuf,
        /// Why.
        #[source]
        source: std::io::Error,
    },
    /// It is there already.
    #[error("{0} is there already; choose another name for the recording, or allow it to be overwritten")]
    Exists(PathBuf),
    /// It cannot be read.
    #[error("the recording {path} cannot be read; check the path in replay:FILE")]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        #[source]
        source: std::io::Error,
    },
    /// It is something else.
    #[error("{0} is no recording of this version; record a run with `halfrow verify`")]
    Foreign(PathBuf),
    /// Its head does not parse.
    #[error("the head of the recording {path} is damaged; make the recording again")]
    Head {
        /// The file.
        path: PathBuf,
        /// Why.
        #[source]
        source: serde_json::Error,
    },
}

#[derive(Serialize, Deserialize)]
struct Head<T> {
    link: String,
    bytes_per_second: Option<f64>,
    #[serde(default)]
    exclusive: bool,
    run: T,
}

/// What one call of [`Link::exchange`] moved.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Exchange {
    pub(super) at: Duration,
    pub(super) taken: Vec<u8>,
    pub(super) received: Vec<u8>,
}

impl Exchange {
    fn write(&self, file: &mut impl Write) -> std::io::Result<()> {
        let nanoseconds = u64::try_from(self.at.as_nanos()).unwrap_or(u64::MAX);
        let length = |bytes: &[u8]| u32::try_from(bytes.len()).unwrap_or(u32::MAX).to_le_bytes();
        file.write_all(&nanoseconds.to_le_bytes())?;
        file.write_all(&length(&self.taken))?;
        file.write_all(&length(&self.received))?;
        file.write_all(&self.taken)?;
        file.write_all(&self.received)
    }

    fn read(rest: &mut &[u8]) -> Option<Self> {
        let (nanoseconds, after) = rest.split_first_chunk()?;
        let (taken, after) = after.split_first_chunk()?;
        let (received, after) = after.split_first_chunk()?;
        let (taken, after) = after.split_at_checked(u32::from_le_bytes(*taken) as usize)?;
        let (received, after) = after.split_at_checked(u32::from_le_bytes(*received) as usize)?;
        *rest = after;
        Some(Self {
            at: Duration::from_nanos(u64::from_le_bytes(*nanoseconds)),
            taken: taken.to_vec(),
            received: received.to_vec(),
        })
    }
}

/// A link that writes down what another one carries. The file has the ending `.partial` until the recorder is dropped.
pub struct Recorder {
    link: Box<dyn Link>,
    file: BufWriter<File>,
    partial: PathBuf,
    path: PathBuf,
    unfinished: Unfinished,
}

/// Why a recording could not be finished, once its recorder is gone; empty when it is whole.
pub type Unfinished = Arc<OnceLock<std::io::Error>>;

impl Recorder {
    /// Records what `link` carries to `path`, with `run` in front.
    ///
    /// # Errors
    /// [`RecordingError`] when the file is there and `overwrite` is not given, or cannot be written.
    pub fn create(
        link: Box<dyn Link>,
        path: &Path,
        run: &impl Serialize,
        overwrite: bool,
    ) -> Result<Self, RecordingError> {
        if path.exists() && !overwrite {
            return Err(RecordingError::Exists(path.to_owned()));
        }
        let mut partial = path.as_os_str().to_owned();
        partial.push(".partial");
        let partial = PathBuf::from(partial);
        let create = |source| RecordingError::Create { path: path.to_owned(), source };
        let mut file = BufWriter::new(File::create(&partial).map_err(create)?);
        let head = Head {
            link: link.name(),
            bytes_per_second: link.bytes_per_second(),
            exclusive: link.is_exclusive(),
            run,
        };
        let write_head = |file: &mut BufWriter<File>| {
            file.write_all(MAGIC)?;
            serde_json::to_writer(&mut *file, &head)?;
            file.write_all(b"\n")
        };
        write_head(&mut file).map_err(create)?;
        Ok(Self { link, file, partial, path: path.to_owned(), unfinished: Unfinished::default() })
    }

    /// Where it will be said if the recording cannot be finished.
    #[must_use]
    pub fn unfinished(&self) -> Unfinished {
        Arc::clone(&self.unfinished)
    }

    fn finish(&mut self) -> std::io::Result<()> {
        self.file.flush()?;
        self.file.get_ref().sync_all()?;
        std::fs::rename(&self.partial, &self.path)
    }
}

impl Drop for Recorder {
    fn drop(&mut self) {
        if let Err(error) = self.finish() {
            tracing::error!("the recording stays in {}: {error}", self.partial.display());
            let _ = self.unfinished.set(error);
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
        let taken = self.link.exchange(outgoing, incoming, wait)?;
        let exchange = Exchange {
            at: self.link.now(),
            taken: outgoing[..taken].to_vec(),
            received: incoming[before..].to_vec(),
        };
        exchange.write(&mut self.file).map_err(LinkError::Record)?;
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

    fn name(&self) -> String {
        self.link.name()
    }

    fn line_errors(&self) -> LineErrors {
        self.link.line_errors()
    }
}

/// A recording, read into memory.
#[derive(Debug)]
pub struct Recording {
    path: PathBuf,
    head: String,
    exchanges: Vec<Exchange>,
}

impl Recording {
    /// Reads the recording `path`.
    ///
    /// # Errors
    /// [`RecordingError`] when it cannot be read or is something else.
    pub fn read(path: &Path) -> Result<Self, RecordingError> {
        let bytes =
            std::fs::read(path).map_err(|source| RecordingError::Read { path: path.to_owned(), source })?;
        Self::parse(path, &bytes).ok_or_else(|| RecordingError::Foreign(path.to_owned()))
    }

    fn parse(path: &Path, bytes: &[u8]) -> Option<Self> {
        let rest = bytes.strip_prefix(MAGIC)?;
        let end = rest.iter().position(|&byte| byte == b'\n')?;
        let head = String::from_utf8(rest[..end].to_vec()).ok()?;
        let mut rest = &rest[end + 1..];
        let exchanges = std::iter::from_fn(|| Exchange::read(&mut rest)).collect();
        Some(Self { path: path.to_owned(), head, exchanges })
    }

    /// What the host wrote in front of the bytes.
    ///
    /// # Errors
    /// [`RecordingError::Head`] when it is not a `T`.
    pub fn run<T: DeserializeOwned>(&self) -> Result<T, RecordingError> {
        self.head().map(|head| head.run)
    }

    /// The rate that the recorded link said it had.
    ///
    /// # Errors
    /// [`RecordingError::Head`] when the head does not parse.
    pub fn bytes_per_second(&self) -> Result<Option<f64>, RecordingError> {
        self.head::<serde::de::IgnoredAny>().map(|head| head.bytes_per_second)
    }

    /// Whether the recorded link was its program's alone.
    ///
    /// # Errors
    /// [`RecordingError::Head`] when the head does not parse.
    pub fn is_exclusive(&self) -> Result<bool, RecordingError> {
        self.head::<serde::de::IgnoredAny>().map(|head| head.exclusive)
    }

    fn head<T: DeserializeOwned>(&self) -> Result<Head<T>, RecordingError> {
        serde_json::from_str(&self.head)
            .map_err(|source| RecordingError::Head { path: self.path.clone(), source })
    }

    /// The file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// All bytes that the host sent, in order.
    #[must_use]
    pub fn sent(&self) -> Vec<u8> {
        self.exchanges.iter().flat_map(|exchange| &exchange.taken).copied().collect()
    }

    pub(super) fn into_exchanges(self) -> Vec<Exchange> {
        self.exchanges
    }
}
