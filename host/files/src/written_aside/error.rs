//! Why a file could not be put in its place.

use std::io;
use std::path::PathBuf;

/// A file that could not be written.
#[derive(Debug, thiserror::Error)]
pub enum WriteAsideError {
    /// The file exists already, and may not be replaced unless that is allowed.
    #[error("{} exists; allow it to be overwritten, or name another file", path.display())]
    Exists {
        /// The file.
        path: PathBuf,
    },
    /// In the file's place is a folder, a device or the like, which is never replaced.
    #[error("{} is no regular file; name a file, not a folder or a device", path.display())]
    NotAFile {
        /// What is there.
        path: PathBuf,
    },
    /// In the file's place is a symbolic link, and links are not written through.
    #[error("{} is a link to {}, and links are not written through; name the file itself", path.display(), to.display())]
    Link {
        /// The link.
        path: PathBuf,
        /// Where it leads.
        to: PathBuf,
    },
    /// Another run is writing a file or folder of this name.
    #[error("another run is writing {}; wait until it is done, or choose another name", path.display())]
    Claimed {
        /// The name.
        path: PathBuf,
    },
    /// The system refused to write the file.
    #[error("cannot write {}; check that its folder exists, is writable and has space", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
}

/// The file was written, but could not be put in its place.
#[derive(Debug, thiserror::Error)]
#[error("{source}{}", match kept {
    Some(kept) => format!(" (what there is of it is kept in {})", kept.display()),
    None => String::new(),
})]
pub struct Unfinished {
    /// Where it is kept as far as it goes; none if it is not.
    pub kept: Option<PathBuf>,
    /// Why.
    pub source: WriteAsideError,
}
