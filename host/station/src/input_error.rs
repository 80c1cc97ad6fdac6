//! Why a plan or the station's settings cannot be used: always with the file, the line and what to do.

use std::error::Error;
use std::io;
use std::ops::RangeBounds;
use std::path::{Path, PathBuf};

use halfrow::files::text;
use toml::Spanned;

/// A file of TOML that cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum InputError {
    /// The file cannot be read.
    #[error("{} cannot be read; check its name, and who may read it", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// The file is not text in UTF-8, or is too long.
    #[error("{} is no file of settings, of a plan or of words; save it as text in UTF-8", path.display())]
    NotText {
        /// The file.
        path: PathBuf,
        /// Why it is not text.
        source: io::Error,
    },
    /// The file's path is not UTF-8. Lanes are told it in JSON.
    #[error("the path {} is not UTF-8, and no lane could be told it; rename what is not, or move the file", path.display())]
    Path {
        /// The file.
        path: PathBuf,
    },
    /// The file has a line that is wrong; the message names the line and ends in what to do.
    #[error("{}:{line}: {what}; {remedy}", path.display())]
    Wrong {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// What is wrong.
        what: String,
        /// What to do.
        remedy: String,
    },
    /// The file names something that cannot be used; the cause that follows says why and what to do.
    #[error("{}:{line}: {what} cannot be used", path.display())]
    Input {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// What it names.
        what: String,
        /// Why.
        source: Box<dyn Error + Send + Sync>,
    },
}

/// The text of a file of settings, of a plan or of words.
pub(crate) fn text_of(path: &Path) -> Result<String, InputError> {
    text::read(path, text::MAX_BYTES).map_err(|source| {
        let path = path.to_owned();
        match source.kind() {
            io::ErrorKind::InvalidData => InputError::NotText { path, source },
            _ => InputError::Unreadable { path, source },
        }
    })
}

/// A place in the file's text.
pub(crate) trait At {
    /// The byte at which it begins.
    fn at(self) -> usize;
}

impl At for usize {
    fn at(self) -> usize {
        self
    }
}

impl<T> At for &Spanned<T> {
    fn at(self) -> usize {
        self.span().start
    }
}

/// What is wrong at a place in the file's text, before the place is turned into a line number.
#[derive(Debug)]
pub(crate) struct Fault {
    at: usize,
    what: String,
    why: Why,
}

#[derive(Debug)]
enum Why {
    Remedy(String),
    Source(Box<dyn Error + Send + Sync>),
}

impl Fault {
    /// What stands there is wrong.
    pub(crate) fn wrong(at: impl At, what: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self { at: at.at(), what: what.into(), why: Why::Remedy(remedy.into()) }
    }

    /// What stands there names something that cannot be used.
    pub(crate) fn input(
        at: impl At,
        what: impl Into<String>,
        source: impl Into<Box<dyn Error + Send + Sync>>,
    ) -> Self {
        Self { at: at.at(), what: what.into(), why: Why::Source(source.into()) }
    }

    /// A syntax error of TOML, or a value of the wrong type; `keys` says where all keys are listed.
    pub(crate) fn of_toml(error: &toml::de::Error, keys: &str) -> Self {
        let at = error.span().map_or(0, |span| span.start);
        let what = text::told(&error.message().lines().collect::<Vec<_>>().join("; "));
        Self::wrong(at, what, format!("correct the line; {keys}"))
    }

    /// The error, with the line number of the fault in `text`, the content of `path`.
    pub(crate) fn in_file(self, path: &Path, text: &str) -> InputError {
        let before = text.as_bytes().iter().take(self.at);
        let line = 1 + before.filter(|&&byte| byte == b'\n').count();
        let (path, what) = (path.to_owned(), self.what);
        match self.why {
            Why::Remedy(remedy) => InputError::Wrong { path, line, what, remedy },
            Why::Source(source) => InputError::Input { path, line, what, source },
        }
    }
}

/// The number that stands there, if it is in `range`.
pub(crate) fn within<T: Copy + PartialOrd>(
    text: &Spanned<T>,
    range: impl RangeBounds<T>,
    what: impl Into<String>,
    remedy: impl Into<String>,
) -> Result<T, Fault> {
    let number = *text.get_ref();
    if range.contains(&number) { Ok(number) } else { Err(Fault::wrong(text, what, remedy)) }
}
