//! Photographs of the folder `HALFROW_IMAGES`, or of `../shared/kodak` next to the project, as frames.

use std::path::{Path, PathBuf};

use halfrow::frames::{ReadOptions, read};
use halfrow_model::{Frame, Geometry};

use crate::not_tested::not_tested;

/// The photographs, sorted by path. Without `HALFROW_IMAGES` there may be none, which is reported as not tested.
///
/// # Panics
/// When the folder that `HALFROW_IMAGES` names cannot be read or holds none.
#[must_use]
pub fn paths() -> Vec<PathBuf> {
    let named = std::env::var_os("HALFROW_IMAGES").map(PathBuf::from);
    let beside = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/kodak"));
    let mut paths = photographs_in(named.as_deref().unwrap_or(beside)).unwrap_or_default();
    paths.sort();
    if let (Some(named), true) = (named, paths.is_empty()) {
        panic!("HALFROW_IMAGES names {}, where no .png file can be found", named.display());
    }
    if paths.is_empty() {
        not_tested(
            "what needs photographs",
            "set HALFROW_IMAGES to the folder of kodim01.png to kodim24.png",
        );
    }
    paths
}

fn photographs_in(folder: &Path) -> std::io::Result<Vec<PathBuf>> {
    let paths = std::fs::read_dir(folder)?.filter_map(|entry| Some(entry.ok()?.path()));
    Ok(paths.filter(|path| path.extension().is_some_and(|extension| extension == "png")).collect())
}

/// The photograph's mosaic, repeated until it fills the frame. Its width and height are even, so the Bayer pattern goes on.
///
/// # Panics
/// When the photograph cannot be read.
#[must_use]
pub fn filled(path: &Path, geometry: &Geometry) -> Frame {
    let photograph = read(path, &ReadOptions::default()).unwrap();
    let samples = (0..geometry.height())
        .flat_map(|row| photograph.row(row % photograph.height()).iter().cycle().take(geometry.width()))
        .copied()
        .collect();
    Frame::new(geometry.width(), geometry.depth(), photograph.phase(), samples).unwrap()
}
