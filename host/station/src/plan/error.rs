//! Why a plan cannot be used: always with the file, the line and what to do.

use std::error::Error;
use std::io;
use std::path::{Path, PathBuf};

/// A plan that cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum PlanError {
    /// The file cannot be read.
    #[error("the plan {} cannot be read; check its name, and who may read it", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// The plan says what no plan can say.
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
    /// The plan names what cannot be used; the source says why, and what to do.
    #[error("{}:{line}: {what} cannot be used", path.display())]
    Input {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// What the plan names.
        what: String,
        /// Why.
        source: Box<dyn Error + Send + Sync>,
    },
}

/// What is wrong at a place of the plan's text, before the place has become a line.
#[derive(Debug)]
pub(super) struct Fault {
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
    /// At byte `at` stands what no plan can say.
    pub(super) fn wrong(at: usize, what: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self { at, what: what.into(), why: Why::Remedy(remedy.into()) }
    }

    /// At byte `at` something is named that cannot be used.
    pub(super) fn input(
        at: usize,
        what: impl Into<String>,
        source: impl Into<Box<dyn Error + Send + Sync>>,
    ) -> Self {
        Self { at, what: what.into(), why: Why::Source(source.into()) }
    }

    /// What TOML or the types of the plan's values refuse.
    pub(super) fn of_toml(error: &toml::de::Error) -> Self {
        let at = error.span().map_or(0, |span| span.start);
        let what = error.message().lines().collect::<Vec<_>>().join("; ");
        Self::wrong(
            at,
            what,
            "correct the line; `halfrow-station plan schema` lists every key and its values",
        )
    }

    /// The error, whose line is that of the fault in `text`, the content of `path`.
    pub(super) fn in_file(self, path: &Path, text: &str) -> PlanError {
        let before = text.as_bytes().iter().take(self.at);
        let line = 1 + before.filter(|&&byte| byte == b'\n').count();
        let (path, what) = (path.to_owned(), self.what);
        match self.why {
            Why::Remedy(remedy) => PlanError::Wrong { path, line, what, remedy },
            Why::Source(source) => PlanError::Input { path, line, what, source },
        }
    }
}
