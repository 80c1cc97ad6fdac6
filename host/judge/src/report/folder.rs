//! The folder of a report: its JSON and its other views, all of them of the same run.

use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::{self, BufReader, Write as _};
use std::os::unix::fs::PermissionsExt as _;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use serde::de::IgnoredAny;

use super::{VIEWS, json};
use crate::result::{Evidence, Report};
use crate::verdict::Verdict;
use halfrow_files::is_of_system;
use halfrow_files::written_aside::{AsideFolder, Claim, Misplaced, WriteAsideError};

const JSON: &str = "report.json";

/// A report that could not be written.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// The report's path does not end in the name of a folder.
    #[error("`{}` names no folder of its own; give the report a new one, as in `reports/today`", path.display())]
    Name {
        /// The path.
        path: PathBuf,
    },
    /// The report's folder exists already, and may not be replaced unless that is allowed.
    #[error("{} exists; allow it to be overwritten, or name another folder", path.display())]
    Exists {
        /// The path.
        path: PathBuf,
    },
    /// In the report's place is a symbolic link, and links are not written through.
    #[error("{} is a link to {}, and links are not written through; name the folder itself", path.display(), to.display())]
    Link {
        /// The link.
        path: PathBuf,
        /// Where it leads.
        to: PathBuf,
    },
    /// Another run is writing a report of this name.
    #[error("another run is writing {}; wait until it is done, or name another folder", path.display())]
    Claimed {
        /// The path.
        path: PathBuf,
    },
    /// In the report's place is something that halfrow did not write, and that is left alone.
    #[error("{} is not an earlier report, and is left alone: {why}; give the report another name", path.display())]
    NotAReport {
        /// The path.
        path: PathBuf,
        /// How it can be told.
        why: String,
    },
    /// The report's folder exists and is write-protected.
    #[error("{} is write-protected and is left alone; let its owner write into it, or name another folder", path.display())]
    Protected {
        /// The path.
        path: PathBuf,
    },
    /// The report's folder exists and cannot be replaced, for example because something is mounted there.
    #[error(
        "{0} cannot be replaced, for example because something is mounted there; name a new folder inside it, such as \
         {0}/report", path.display()
    )]
    Immovable {
        /// The path.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// The report's folder cannot be looked at or made there.
    #[error("cannot prepare the report's folder {}; check that the folder above it exists, is writable and has space", path.display())]
    Prepare {
        /// The path.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// The system refused to write a file of the report.
    #[error("cannot write {name} of the report {}; check that its folder exists, is writable and has space", path.display())]
    Write {
        /// The report's path.
        path: PathBuf,
        /// The file's name.
        name: &'static str,
        /// The system's reason.
        source: io::Error,
    },
    /// The report was written, but could not be put in its place.
    #[error("cannot put the report in its place, {}; check that nothing else uses that folder", path.display())]
    Place {
        /// The path.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// The report could not be encoded as JSON, which is a fault of this program.
    #[error("the report cannot be encoded as JSON; this is a fault of halfrow, so report it")]
    Json(#[from] serde_json::Error),
    /// The report could not be encoded as JUnit XML, which is a fault of this program.
    #[error("the report cannot be encoded as JUnit XML; this is a fault of halfrow, so report it")]
    Junit(#[from] quick_junit::SerializeError),
    /// The report's pictures could not be encoded, which is a fault of this program.
    #[error("the report's pictures cannot be encoded; this is a fault of halfrow, so report it")]
    Pictures(#[from] png::EncodingError),
}

/// The place of a report that is still to be written. The folder is written aside and renamed at the end, so that until the new
/// report is whole readers find the earlier one, or none.
#[derive(Debug)]
pub struct ReportFolder {
    path: PathBuf,
    overwrite: bool,
    aside: AsideFolder,
    /// Held until the report is in its place, so that of two runs that may not overwrite only one can begin.
    _claim: Option<Claim>,
}

impl ReportFolder {
    /// Makes sure that a report can be written to `path`. Call it before a board is opened.
    ///
    /// # Errors
    /// [`ReportError`] when the folder above does not exist or is not writable, when something at `path` is neither an earlier
    /// report nor an empty folder or, without `overwrite`, is not an empty folder, when it is write-protected or cannot be
    /// renamed, or when another run is about to put a report there.
    pub fn prepare(path: &Path, overwrite: bool) -> Result<Self, ReportError> {
        let path = &named(path);
        check(path, overwrite)?;
        let claim = if overwrite { None } else { Some(claim(path)?) };
        // The run that held the claim before may have put a report in place.
        check(path, overwrite)?;
        let failed = |source| ReportError::Prepare { path: path.to_owned(), source };
        let aside = AsideFolder::new(path).map_err(failed)?;
        aside.try_place().map_err(|source| {
            if is_of_system(&source) {
                return failed(source);
            }
            ReportError::Immovable { path: path.to_owned(), source }
        })?;
        Ok(Self { path: path.to_owned(), overwrite, aside, _claim: claim })
    }

    /// The folder, if it holds an earlier report.
    #[must_use]
    pub fn earlier(&self) -> Option<&Path> {
        self.path.join(JSON).exists().then_some(&self.path)
    }

    /// Writes the report and puts it in its place. When that fails, an earlier report is left as it was.
    ///
    /// # Errors
    /// [`ReportError`] when a view cannot be encoded, a file cannot be written, or something has got in the way meanwhile.
    pub fn commit(self, report: &Report, evidence: &[Evidence]) -> Result<(), ReportError> {
        self.write(JSON, &json::render(report)?)?;
        for view in &VIEWS {
            self.write(view.name, &(view.render)(report, evidence)?)?;
        }
        let Self { path, overwrite, aside, .. } = self;
        let occupied = |path: &Path| Ok((!is_empty(path)?).then(String::new));
        let placed = if overwrite { aside.replace(foreign) } else { aside.replace(occupied) };
        placed.map_err(|misplaced| match misplaced {
            Misplaced::Taken(why) if overwrite => ReportError::NotAReport { path, why },
            Misplaced::Taken(_) => ReportError::Exists { path },
            Misplaced::Io(source) => ReportError::Place { path, source },
        })
    }

    fn write(&self, name: &'static str, text: &str) -> Result<(), ReportError> {
        let failed = |source| ReportError::Write { path: self.path.clone(), name, source };
        let mut file = File::create_new(self.aside.path().join(name)).map_err(failed)?;
        file.write_all(text.as_bytes()).and_then(|()| file.sync_all()).map_err(failed)
    }
}

fn claim(path: &Path) -> Result<Claim, ReportError> {
    Claim::take(path).map_err(|error| match error {
        WriteAsideError::Io { path, source } => ReportError::Prepare { path, source },
        _ => ReportError::Claimed { path: path.to_owned() },
    })
}

/// The path without a slash at its end, with which a symbolic link would be followed unnoticed.
fn named(path: &Path) -> PathBuf {
    path.components().collect()
}

/// Checks that a report may be written to `path` at present.
///
/// # Errors
/// [`ReportError`] when `path` does not end in a name, or when something there may not be replaced.
pub fn check(path: &Path, overwrite: bool) -> Result<(), ReportError> {
    let path = &named(path);
    let failed = |source| ReportError::Prepare { path: path.to_owned(), source };
    if path.file_name().is_none() {
        return Err(ReportError::Name { path: path.to_owned() });
    }
    match fs::symlink_metadata(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        Err(source) => Err(failed(source)),
        Ok(there) if there.is_symlink() => {
            let to = fs::read_link(path).unwrap_or_default();
            Err(ReportError::Link { path: path.to_owned(), to })
        }
        Ok(there) if there.is_dir() && there.permissions().mode() & 0o200 == 0 => {
            Err(ReportError::Protected { path: path.to_owned() })
        }
        Ok(_) => match foreign(path).map_err(failed)? {
            Some(why) => Err(ReportError::NotAReport { path: path.to_owned(), why }),
            None if overwrite || is_empty(path).map_err(failed)? => Ok(()),
            None => Err(ReportError::Exists { path: path.to_owned() }),
        },
    }
}

/// Whether `path` is an empty folder, such as scripts make before a run.
fn is_empty(path: &Path) -> io::Result<bool> {
    Ok(is_folder(path)? && fs::read_dir(path)?.next().is_none())
}

/// Whether `path` is a folder, and no link to one.
fn is_folder(path: &Path) -> io::Result<bool> {
    match fs::symlink_metadata(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(false),
        found => found.map(|found| found.is_dir()),
    }
}

/// What shows that `path` is neither an empty folder nor a folder with only a report in it; none if it is. Replacing a folder
/// removes everything in it, so it may hold nothing else.
fn foreign(path: &Path) -> io::Result<Option<String>> {
    if !is_folder(path)? {
        return Ok(Some("it is not a folder".to_owned()));
    }
    let entries = match fs::read_dir(path).and_then(Iterator::collect::<io::Result<Vec<_>>>) {
        Err(error) if !is_of_system(&error) => return Ok(Some(format!("it cannot be listed ({error})"))),
        listed => listed?,
    };
    let ours = |name: &OsStr| name == JSON || VIEWS.iter().any(|view| name == view.name);
    if let Some(other) = entries.iter().map(fs::DirEntry::file_name).find(|name| !ours(name)) {
        return Ok(Some(format!("it also holds `{}`", other.display())));
    }
    let is_file = |entry: &&fs::DirEntry| entry.file_type().is_ok_and(|kind| kind.is_file());
    if let Some(other) = entries.iter().find(|entry| !is_file(entry)) {
        return Ok(Some(format!("its `{}` is not a file", other.file_name().display())));
    }
    let is_ours = entries.is_empty() || is_report(&path.join(JSON))?;
    Ok((!is_ours).then(|| format!("it holds no {JSON} of halfrow's")))
}

/// Whether a file is a report's JSON of any version, by the keys with which every report begins.
///
/// # Errors
/// The system's reason, when that has nothing to do with the file.
fn is_report(path: &Path) -> io::Result<bool> {
    #[derive(Deserialize)]
    struct Head {
        #[serde(rename = "schema")]
        _schema: u32,
        command: String,
        #[serde(rename = "verdict")]
        _verdict: Verdict,
        #[serde(rename = "exit_code")]
        _exit_code: u8,
        #[serde(rename = "board")]
        _board: IgnoredAny,
    }
    let head =
        File::open(path).and_then(|file| Ok(serde_json::from_reader::<_, Head>(BufReader::new(file))?));
    match head {
        Ok(head) => Ok(["verify", "soak"].contains(&head.command.as_str())),
        Err(error) if is_of_system(&error) => Err(error),
        Err(_) => Ok(false),
    }
}
