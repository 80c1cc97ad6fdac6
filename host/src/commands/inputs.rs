//! Frames that a user names: built-in ones and files.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::{Context as _, ensure};
use clap::Args;
use halfrow_model::{Geometry, Phase};

use crate::frames::{self, Builtin, RawGeometry, RawLayout, ReadOptions};
use crate::report::{FileHash, sha256};
use crate::session::FrameSource;

/// How frame files are read.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Frame files")]
pub(super) struct InputArguments {
    /// Layout of headerless frame files: u8, u16le, mipi10 or mipi12; their size is the tables'
    #[arg(long, value_name = "LAYOUT")]
    raw: Option<RawLayout>,
}

impl InputArguments {
    /// How to read a frame for `geometry`.
    pub(super) fn read_options(&self, geometry: &Geometry, phase: Phase) -> ReadOptions {
        let raw =
            self.raw.map(|layout| RawGeometry { width: geometry.width(), height: geometry.height(), layout });
        ReadOptions { depth: geometry.depth(), phase, raw }
    }
}

/// The frames with these names: `builtin:NAME`, or files that must fit `geometry`.
pub(super) fn frame_sources(
    names: &[String],
    how: &ReadOptions,
    geometry: &Geometry,
) -> anyhow::Result<Vec<FrameSource>> {
    names.iter().map(|name| frame_source(name, how, geometry)).collect()
}

fn frame_source(name: &str, how: &ReadOptions, geometry: &Geometry) -> anyhow::Result<FrameSource> {
    if let Some(builtin) = name.strip_prefix("builtin:") {
        return Ok(FrameSource::Builtin(builtin.parse::<Builtin>()?));
    }
    let path = PathBuf::from(name);
    let frame = frames::read(&path, how)?;
    ensure!(
        (frame.width(), frame.height()) == (geometry.width(), geometry.height()),
        "{name} is {} x {}, and the tables are for {} x {}; make tables of the frame's size with `halfrow tables \
         --width {} --height {}`, or give these options here",
        frame.width(),
        frame.height(),
        geometry.width(),
        geometry.height(),
        frame.width(),
        frame.height()
    );
    Ok(FrameSource::File { path, frame: Arc::new(frame) })
}

/// The file's SHA-256.
pub(super) fn file_hash(path: &Path) -> anyhow::Result<FileHash> {
    let bytes = fs::read(path).with_context(|| format!("{} cannot be read", path.display()))?;
    Ok(FileHash { path: path.display().to_string(), sha256: sha256([bytes]) })
}
