//! Where corrected frames and their previews are written.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use crate::arguments::inputs::FrameName;
use crate::call_error::CallError;
use crate::files::make_folder;
use halfrow::call::Files;
use halfrow::files::written_aside::Place;
use halfrow::frames::{Format, check_png};

/// The files of a call, one for each input, in the order of the inputs.
pub(super) struct Places {
    /// The corrected frames.
    pub(super) frames: Vec<PathBuf>,
    /// Their previews; empty if none are asked for.
    pub(super) previews: Vec<PathBuf>,
    folders: Vec<PathBuf>,
}

/// What the call says about them.
pub(super) struct Wanted<'a> {
    /// The file or folder of the frames.
    pub(super) output: &'a Path,
    /// The format of the frames, if the call names it.
    pub(super) format: Option<Format>,
    /// The file or folder of the previews.
    pub(super) preview: Option<&'a Path>,
}

impl Places {
    /// One file for one frame; for several, files in a folder, named after the inputs.
    pub(super) fn of(inputs: &[FrameName], wanted: &Wanted<'_>) -> anyhow::Result<Self> {
        let mut places = Self { frames: Vec::new(), previews: Vec::new(), folders: Vec::new() };
        let format = wanted.format.unwrap_or(Format::Pgm);
        places.frames = places.paths(inputs, wanted.output, format, "-o")?;
        if let Some(preview) = wanted.preview {
            places.previews = places.paths(inputs, preview, Format::Png, "--preview")?;
        }
        for path in &places.frames {
            let named = Format::of(path)?;
            if let Some(format) = wanted.format.filter(|&format| format != named) {
                return Err(CallError::OtherFormat { path: path.clone(), format }.into());
            }
        }
        places.previews.iter().try_for_each(|path| check_png(path))?;
        places.check()?;
        Ok(places)
    }

    fn paths(
        &mut self,
        inputs: &[FrameName],
        place: &Path,
        format: Format,
        option: &'static str,
    ) -> anyhow::Result<Vec<PathBuf>> {
        let is_file = place.extension().is_some() && !place.is_dir();
        if is_file {
            let frames = inputs.len();
            if frames != 1 {
                return Err(CallError::OneFile { path: place.to_owned(), frames, option }.into());
            }
        } else {
            self.folders.push(place.to_owned());
        }
        let path = |input: &FrameName| match is_file {
            true => Ok(place.to_owned()),
            false => {
                let mut name = input.stem()?;
                name.push(format!(".{format}"));
                Ok(place.join(name))
            }
        };
        inputs.iter().map(path).collect()
    }

    /// Refuses to write two frames to the same file.
    fn check(&self) -> Result<(), CallError> {
        let mut seen = HashSet::new();
        for path in self.frames.iter().chain(&self.previews) {
            if !seen.insert(Place::of(path)) {
                return Err(CallError::FramesShare { path: path.clone() });
            }
        }
        Ok(())
    }

    /// Adds these files to the files of the call.
    pub(super) fn add_to(&self, mut files: Files) -> Files {
        for (option, paths) in [("--output", &self.frames), ("--preview", &self.previews)] {
            let is_in = |path: &&PathBuf| self.folders.iter().any(|folder| path.parent() == Some(folder));
            let (inside, named): (Vec<_>, Vec<_>) = paths.iter().partition(is_in);
            files = files.writes_into(option, inside).writes(option, named);
        }
        files
    }

    /// Makes the folders that do not exist.
    pub(super) fn make_folders(&self) -> Result<(), CallError> {
        for folder in &self.folders {
            make_folder(folder)?;
        }
        Ok(())
    }
}
