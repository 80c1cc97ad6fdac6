//! What a command reads and what it writes, looked at before anything is done.

use std::collections::{BTreeSet, HashMap};
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use anyhow::bail;

use super::CallError;
use crate::console;
use halfrow::kernels::NamedKernel;
use halfrow::report;
use halfrow_frames::written_aside::{self, Place, WriteAsideError};

/// The files and folders of a call.
#[derive(Debug, Default)]
pub(super) struct Files {
    overwrite: bool,
    inputs: Vec<PathBuf>,
    outputs: Vec<Output>,
}

/// What is written, and by which option it is named.
#[derive(Debug)]
struct Output {
    option: &'static str,
    path: PathBuf,
    shape: Shape,
}

/// How an output lies in its folder.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Shape {
    /// A file that the call names.
    File,
    /// A file that the call names and that is claimed before the board is opened, which is when one that is there is refused.
    Claimed,
    /// A file in a folder that the call names, which is made if need be.
    InFolder,
    /// A folder that is replaced as a whole.
    Report,
}

impl Files {
    /// Those of a call that may overwrite its outputs, or not.
    pub(super) fn new(overwrite: bool) -> Self {
        Self { overwrite, ..Self::default() }
    }

    /// Adds what is read.
    pub(super) fn reads<P: Into<PathBuf>>(mut self, paths: impl IntoIterator<Item = P>) -> Self {
        self.inputs.extend(paths.into_iter().map(Into::into));
        self
    }

    /// Adds a kernel that is read if it is not one with a name.
    pub(super) fn reads_kernel(self, kernel: Option<&OsStr>) -> Self {
        self.reads(
            kernel.filter(|kernel| kernel.to_str().is_none_or(|name| name.parse::<NamedKernel>().is_err())),
        )
    }

    /// Adds files that `option` names.
    pub(super) fn writes<P: Into<PathBuf>>(
        self,
        option: &'static str,
        paths: impl IntoIterator<Item = P>,
    ) -> Self {
        self.adds(option, Shape::File, paths)
    }

    /// Adds a file that `option` names and that is claimed behind this.
    pub(super) fn writes_claimed(self, option: &'static str, path: Option<&Path>) -> Self {
        self.adds(option, Shape::Claimed, path)
    }

    /// Adds files in a folder that `option` names.
    pub(super) fn writes_into<P: Into<PathBuf>>(
        self,
        option: &'static str,
        paths: impl IntoIterator<Item = P>,
    ) -> Self {
        self.adds(option, Shape::InFolder, paths)
    }

    /// Adds a report's folder that `option` names.
    pub(super) fn writes_report(self, option: &'static str, path: Option<&Path>) -> Self {
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

    /// Whether everything can be written as far as can be told, no input is written to, and no two outputs are one. What runs
    /// that were killed left in the outputs' folders is cleared.
    pub(super) fn check(&self) -> anyhow::Result<()> {
        for output in &self.outputs {
            output.check(self.overwrite)?;
        }
        self.check_apart()?;
        self.check_folders()
    }

    fn check_apart(&self) -> anyhow::Result<()> {
        let inputs: HashMap<_, _> = self.inputs.iter().map(|input| (Place::of(input), input)).collect();
        let mut seen = HashMap::new();
        for output in &self.outputs {
            let place = Place::of(&output.path);
            let is_inside = |other: &Path| output.shape == Shape::Report && place.holds(other);
            let input = inputs.get(&place).copied();
            if let Some(input) = input.or_else(|| self.inputs.iter().find(|input| is_inside(input))) {
                bail!(CallError::InputOverwritten { path: input.clone(), option: output.option });
            }
            let other =
                self.outputs.iter().find(|other| other.shape != Shape::Report && is_inside(&other.path));
            if let Some(first) = seen.insert(place.clone(), output.option).or(other.map(|other| other.option))
            {
                bail!(CallError::OutputsShare { first, second: output.option, path: output.path.clone() });
            }
        }
        Ok(())
    }

    fn check_folders(&self) -> anyhow::Result<()> {
        let folders: BTreeSet<_> =
            self.outputs.iter().map(|output| (output.folder(), output.shape, output.option)).collect();
        for (folder, shape, option) in folders {
            let checked = written_aside::check_folder(folder, shape == Shape::InFolder);
            let path = folder.to_owned();
            checked.map_err(|source| match shape {
                Shape::InFolder => CallError::FolderClosed { path, option, source },
                Shape::File | Shape::Claimed | Shape::Report => {
                    CallError::FolderUnusable { path, option, source }
                }
            })?;
            for kept in written_aside::clear(folder) {
                console::diagnose(&format_args!(
                    "note: what a run that was killed had recorded is kept in {}",
                    kept.display()
                ));
            }
        }
        Ok(())
    }
}

/// Makes a folder, and those that it lies in.
pub(super) fn make_folder(folder: &Path) -> Result<(), CallError> {
    std::fs::create_dir_all(folder)
        .map_err(|source| CallError::FolderNotMade { path: folder.to_owned(), source })
}

impl Output {
    fn folder(&self) -> &Path {
        self.path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
    }

    fn check(&self, overwrite: bool) -> anyhow::Result<()> {
        let (path, option) = (self.path.clone(), self.option);
        match self.shape {
            Shape::Report => Ok(report::check_folder(&self.path, overwrite)?),
            Shape::File => Ok(written_aside::check(&self.path, overwrite)?),
            Shape::Claimed => Ok(written_aside::check(&self.path, true)?),
            Shape::InFolder => match written_aside::check(&self.path, overwrite) {
                Err(WriteAsideError::Exists { .. }) => bail!(CallError::Exists { path, option }),
                Err(WriteAsideError::NotAFile { .. }) => bail!(CallError::NotAFile { path, option }),
                checked => Ok(checked?),
            },
        }
    }
}
