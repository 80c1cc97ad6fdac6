//! Frames that a user names: built-in frames and files.

use std::ffi::{OsStr, OsString};
use std::fs;
use std::path::{Path, PathBuf};
use std::str::FromStr as _;
use std::sync::Arc;

use super::given::{Decider, Given, yes_or_no};
use crate::call_error::CallError;
use crate::console;
use crate::failure::Failure;
use crate::settings::Settings;
use clap::Args;
use halfrow_model::{Geometry, Phase};
use halfrow_program::choice::one_of;

use halfrow::call::{Input, check_size};
use halfrow::frames::{
    Builtin, Decoded, Fitting, FrameFile, PictureSize, RawGeometry, RawLayout, ReadOptions, RowReader, Scene,
};
use halfrow::run::FrameSource;

/// How frame files are read.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Frame files")]
pub(crate) struct InputArguments {
    /// Layout of headerless frame files: u8, u16le, mipi10 or mipi12; their size is the tables'
    #[arg(long, value_name = "LAYOUT", hide_possible_values = true)]
    #[arg(value_parser = one_of(RawLayout::ALL.map(RawLayout::name), RawLayout::from_str))]
    raw: Option<RawLayout>,
    /// Crop pictures in colour about their centre, and scale them, to the tables' size
    #[arg(long, value_name = "YES|NO", num_args = 0..=1, require_equals = true, default_missing_value = "yes")]
    #[arg(env = "HALFROW_FIT", value_parser = yes_or_no(), hide_possible_values = true)]
    fit: Option<bool>,
}

impl InputArguments {
    /// Refuses `--fit` beside `--raw`.
    pub(crate) fn refuse_void(&self, given: &Given, settings: &Settings) -> Result<(), Failure> {
        if self.raw.is_some() {
            given.refuse_void(Decider::HEADERLESS, &settings.keys())?;
        }
        Ok(())
    }

    /// How to read a frame for `geometry`.
    pub(crate) fn read_options(&self, geometry: &Geometry, phase: Phase, settings: &Settings) -> ReadOptions {
        let (width, height) = (geometry.width(), geometry.height());
        let raw = self.raw.map(|layout| RawGeometry { width, height, layout });
        let size = match self.fit.or(settings.fit).unwrap_or(false) {
            true => PictureSize::Fitted(width, height),
            false => PictureSize::Exactly(width, height),
        };
        ReadOptions { depth: geometry.depth(), phase, raw, size }
    }
}

/// A frame that a user names.
#[derive(Clone, Debug)]
pub(crate) enum FrameName {
    /// `builtin:NAME`
    Builtin(Builtin),
    /// Any other name.
    File(PathBuf),
}

impl FrameName {
    /// The frames with these names. A file's name need not be text.
    pub(crate) fn all<S: AsRef<OsStr>>(names: &[S]) -> anyhow::Result<Vec<Self>> {
        let read = |name: &S| match name.as_ref().to_str().map_or(Ok(None), Builtin::named)? {
            Some(builtin) => Ok(Self::Builtin(builtin)),
            None => Ok(Self::File(PathBuf::from(name))),
        };
        names.iter().map(read).collect()
    }

    /// The file, if it is one.
    pub(crate) fn file(&self) -> Option<&Path> {
        match self {
            Self::Builtin(_) => None,
            Self::File(path) => Some(path),
        }
    }

    /// The name without folder and extension.
    pub(crate) fn stem(&self) -> anyhow::Result<OsString> {
        match self {
            Self::Builtin(builtin) => Ok(builtin.name().into()),
            Self::File(path) => {
                let stem = path.file_stem().ok_or_else(|| CallError::Unnamed { path: path.clone() })?;
                Ok(stem.to_owned())
            }
        }
    }

    /// Whether it is a file that can be read twice, as a pipe cannot. True also for a file that does not exist.
    pub(crate) fn can_be_read_twice(&self) -> bool {
        match self {
            Self::Builtin(_) => false,
            Self::File(path) => fs::metadata(path).map_or(true, |about| about.is_file()),
        }
    }

    /// The rows of the frame: read from a file as `how` says, or rendered for `scene`. A file must have the size of `scene`.
    pub(crate) fn rows(&self, how: &ReadOptions, scene: &Scene) -> anyhow::Result<RowReader> {
        match self {
            Self::Builtin(builtin) => Ok(builtin.render(scene)?.into()),
            Self::File(path) => {
                let rows = RowReader::open(path, how)?;
                check_size(path, (rows.width(), rows.height()), how, &scene.geometry)?;
                Ok(rows)
            }
        }
    }

    /// The frame with the rows of [`Self::rows`].
    pub(crate) fn frame(&self, how: &ReadOptions, scene: &Scene) -> anyhow::Result<Decoded> {
        match self {
            Self::Builtin(builtin) => Ok(builtin.render(scene)?.into()),
            Self::File(path) => Ok(read_frame(path, how, &scene.geometry)?.0),
        }
    }
}

/// Says on stderr how the picture in the file `path` was fitted, if it was.
pub(crate) fn tell_fitting(path: &Path, fitting: Option<Fitting>, quiet: bool) {
    if let Some(fitting) = fitting.filter(|_| !quiet) {
        console::diagnose(&format_args!("fitted {}: {fitting}", path.display()));
    }
}

/// The frames with these names. Files are read whole and must have the size of `geometry`; `tell` is called with how each was
/// fitted. The files are appended to `inputs`.
pub(crate) fn frame_sources(
    names: Vec<FrameName>,
    how: &ReadOptions,
    geometry: &Geometry,
    inputs: &mut Vec<Input>,
    tell: impl Fn(&Path, Option<Fitting>),
) -> anyhow::Result<Vec<FrameSource>> {
    let source = |name| match name {
        FrameName::Builtin(builtin) => Ok(FrameSource::Builtin(builtin)),
        FrameName::File(path) => {
            let (Decoded { frame, fitting, .. }, file) = read_frame(&path, how, geometry)?;
            inputs.push(Input::of_bytes(&path, file.bytes()));
            tell(&path, fitting);
            Ok(FrameSource::File { path, frame: Arc::new(frame) })
        }
    };
    names.into_iter().map(source).collect()
}

fn read_frame(path: &Path, how: &ReadOptions, geometry: &Geometry) -> anyhow::Result<(Decoded, FrameFile)> {
    let file = FrameFile::read(path)?;
    let decoded = file.decode(how)?;
    check_size(path, (decoded.frame.width(), decoded.frame.height()), how, geometry)?;
    Ok((decoded, file))
}
