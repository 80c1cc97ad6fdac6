//! What a call reads and writes, checked before anything is done.

use std::collections::{BTreeSet, HashMap};
use std::ffi::OsStr;
use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::kernels::NamedKernel;
use crate::report::{self, ReportError};
use halfrow_files::written_aside::{self, Place, WriteAsideError, folder_of};

/// A file or folder that a call must not write, or cannot.
#[derive(Debug, Error)]
pub enum FilesError {
    /// An output is named `-`, which means stdout to many programs. It would become a file or folder of that name.
    #[error(
        "`{option} -` names no place, and nothing is written to stdout there; name a file or folder with {option}"
    )]
    ToStdout {
        /// The option that names the output.
        option: &'static str,
    },
    /// The call would write over a file that it reads.
    #[error(
        "{} is read by this call, and {option} would write there; an input is never overwritten, so name another place \
         with {option}", path.display()
    )]
    InputOverwritten {
        /// The input.
        path: PathBuf,
        /// The option that names the output.
        option: &'static str,
    },
    /// The call would write two outputs to the same file.
    #[error("{first} and {second} would both be written to {}; give them different names", path.display())]
    OutputsShare {
        /// The option that names the one.
        first: &'static str,
        /// The option that names the other.
        second: &'static str,
        /// The place.
        path: PathBuf,
    },
    /// A file in the output folder exists already, and may not be replaced unless that is allowed.
    #[error("{} exists; allow it to be overwritten, or name another folder with {option}", path.display())]
    Exists {
        /// The file.
        path: PathBuf,
        /// The option that names the folder.
        option: &'static str,
    },
    /// In the place of a file in the output folder is a folder, a device or a link, which is never replaced.
    #[error("{} is no regular file, and so is not replaced; name another folder with {option}", path.display())]
    NotAFile {
        /// What is there.
        path: PathBuf,
        /// The option that names the folder.
        option: &'static str,
    },
    /// The output folder exists, but no file can be written into it.
    #[error("cannot write into the folder {}; check that it has space, or name another with {option}", path.display())]
    FolderClosed {
        /// The folder.
        path: PathBuf,
        /// The option that names it.
        option: &'static str,
        /// The system's reason.
        source: io::Error,
    },
    /// The folder that a file is to be written into is missing, or no file can be written into it.
    #[error(
        "nothing can be written into the folder {}; check that it exists, is writable and has space, or name another place with \
         {option}", path.display()
    )]
    FolderUnusable {
        /// The folder.
        path: PathBuf,
        /// The option that names the file.
        option: &'static str,
        /// The system's reason.
        source: io::Error,
    },
    /// A file that is there already, or is none.
    #[error(transparent)]
    File(#[from] WriteAsideError),
    /// A report's folder that may not be replaced.
    #[error(transparent)]
    Report(#[from] ReportError),
}

impl FilesError {
    /// The option that names the place, if it is a single one.
    #[must_use]
    pub fn option(&self) -> Option<&'static str> {
        match self {
            Self::ToStdout { option }
            | Self::InputOverwritten { option, .. }
            | Self::Exists { option, .. }
            | Self::NotAFile { option, .. }
            | Self::FolderClosed { option, .. }
            | Self::FolderUnusable { option, .. } => Some(option),
            Self::OutputsShare { .. } | Self::File(_) | Self::Report(_) => None,
        }
    }
}

/// The files and folders of a call.
#[derive(Debug, Default)]
pub struct Files {
    overwrite: bool,
    inputs: Vec<PathBuf>,
    outputs: Vec<Output>,
}

/// Something that is written, and the option that names it.
#[derive(Debug)]
struct Output {
    option: &'static str,
    path: PathBuf,
    shape: Shape,
}

/// What kind of file or folder an output is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Shape {
    /// A file that the call names.
    File,
    /// A file that the call names and that is claimed later, before the board is opened. An existing file is refused then.
    Claimed,
    /// A file in a folder that the call names. The folder is made if need be.
    InFolder,
    /// A folder that is replaced as a whole.
    Report,
}

impl Files {
    /// Starts an empty list. `overwrite` says whether the call may overwrite its outputs.
    #[must_use]
    pub fn new(overwrite: bool) -> Self {
        Self { overwrite, ..Self::default() }
    }

    /// Adds inputs.
    #[must_use]
    pub fn reads<P: Into<PathBuf>>(mut self, paths: impl IntoIterator<Item = P>) -> Self {
        self.inputs.extend(paths.into_iter().map(Into::into));
        self
    }

    /// Adds a kernel file as an input; a named kernel is no file.
    #[must_use]
    pub fn reads_kernel(self, kernel: Option<&OsStr>) -> Self {
        self.reads(
            kernel.filter(|kernel| kernel.to_str().is_none_or(|name| name.parse::<NamedKernel>().is_err())),
        )
    }

    /// Adds files that `option` names.
    #[must_use]
    pub fn writes<P: Into<PathBuf>>(self, option: &'static str, paths: impl IntoIterator<Item = P>) -> Self {
        self.adds(option, Shape::File, paths)
    }

    /// Adds a file that `option` names and that is claimed after this check.
    #[must_use]
    pub fn writes_claimed(self, option: &'static str, path: Option<&Path>) -> Self {
        self.adds(option, Shape::Claimed, path)
    }

    /// Adds files in a folder that `option` names.
    #[must_use]
    pub fn writes_into<P: Into<PathBuf>>(
        self,
        option: &'static str,
        paths: impl IntoIterator<Item = P>,
    ) -> Self {
        self.adds(option, Shape::InFolder, paths)
    }

    /// Adds a report's folder that `option` names.
    #[must_use]
    pub fn writes_report(self, option: &'static str, path: Option<&Path>) -> Self {
        self.adds(option, Shape::Report, path)
    }

    fn adds<P: Into<PathBuf>>(
        mut self,
        option: &'static str,
        shape: Shape,
        paths: impl IntoIterator<Item = P>,
    ) -> Self {
        let outputs = paths.into_iter().map(|path| Output { option, path: path.into(), shape });
        self.outputs.extend(outputs);
        self
    }

    /// Checks that everything can be written, as far as can be told, that no input is written to, and that no two outputs are the
    /// same. Changes nothing.
    ///
    /// # Errors
    /// [`FilesError`]
    pub fn check(&self) -> Result<(), FilesError> {
        for output in &self.outputs {
            output.check(self.overwrite)?;
        }
        self.check_apart()?;
        self.check_folders()
    }

    /// Removes what killed runs left in the outputs' folders, once [`Self::check`] has passed. Recordings among it are kept, and
    /// the names under which they are kept are returned.
    #[must_use = "somebody is to be told where a recording is kept"]
    pub fn clear_leftovers(&self) -> Vec<PathBuf> {
        let folders: BTreeSet<_> = self.outputs.iter().map(|output| folder_of(&output.path)).collect();
        folders.into_iter().flat_map(written_aside::clear).collect()
    }

    fn check_apart(&self) -> Result<(), FilesError> {
        let inputs: HashMap<_, _> = self.inputs.iter().map(|input| (Place::of(input), input)).collect();
        let mut seen = HashMap::new();
        for output in &self.outputs {
            let place = Place::of(&output.path);
            let is_inside = |other: &Path| output.shape == Shape::Report && place.holds(other);
            let input = inputs.get(&place).copied();
            if let Some(input) = input.or_else(|| self.inputs.iter().find(|input| is_inside(input))) {
                return Err(FilesError::InputOverwritten { path: input.clone(), option: output.option });
            }
            let other =
                self.outputs.iter().find(|other| other.shape != Shape::Report && is_inside(&other.path));
            if let Some(first) = seen.insert(place.clone(), output.option).or(other.map(|other| other.option))
            {
                return Err(FilesError::OutputsShare {
                    first,
                    second: output.option,
                    path: output.path.clone(),
                });
            }
        }
        Ok(())
    }

    fn check_folders(&self) -> Result<(), FilesError> {
        let folders: BTreeSet<_> = self
            .outputs
            .iter()
            .map(|output| (folder_of(&output.path), output.shape, output.option))
            .collect();
        for (folder, shape, option) in folders {
            let checked = written_aside::check_folder(folder, shape == Shape::InFolder);
            let path = folder.to_owned();
            checked.map_err(|source| match shape {
                Shape::InFolder => FilesError::FolderClosed { path, option, source },
                Shape::File | Shape::Claimed | Shape::Report => {
                    FilesError::FolderUnusable { path, option, source }
                }
            })?;
        }
        Ok(())
    }
}

/// Refuses an output that `option` names `-`. For callers that look at its ending before they list it in [`Files`].
///
/// # Errors
/// [`FilesError::ToStdout`]
pub fn refuse_stdout(option: &'static str, path: &Path) -> Result<(), FilesError> {
    if path == Path::new("-") { Err(FilesError::ToStdout { option }) } else { Ok(()) }
}

impl Output {
    fn check(&self, overwrite: bool) -> Result<(), FilesError> {
        let (path, option) = (self.path.clone(), self.option);
        let named = if self.shape == Shape::InFolder { folder_of(&self.path) } else { &self.path };
        refuse_stdout(option, named)?;
        match self.shape {
            Shape::Report => Ok(report::check_folder(&self.path, overwrite)?),
            Shape::File => Ok(written_aside::check(&self.path, overwrite)?),
            Shape::Claimed => Ok(written_aside::check(&self.path, true)?),
            Shape::InFolder => match written_aside::check(&self.path, overwrite) {
                Err(WriteAsideError::Exists { .. }) => Err(FilesError::Exists { path, option }),
                Err(WriteAsideError::NotAFile { .. }) => Err(FilesError::NotAFile { path, option }),
                checked => Ok(checked?),
            },
        }
    }
}
