//! Photographs of the folder `HALFROW_IMAGES`, or of `../shared/kodak` beside the project, as frames.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use halfrow::frames::{ReadOptions, read};
use halfrow_model::{Frame, Geometry};

/// The photographs in their order; none when there is no such folder, which is said past the harness, since that keeps
/// what passing tests print.
#[must_use]
#[allow(clippy::disallowed_methods)]
pub fn paths() -> Vec<PathBuf> {
    let beside = concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/kodak");
    let folder = std::env::var_os("HALFROW_IMAGES").map_or_else(|| PathBuf::from(beside), PathBuf::from);
    let Ok(entries) = std::fs::read_dir(&folder) else {
        let _ = writeln!(
            std::io::stderr(),
            "NOT TESTED on photographs: set HALFROW_IMAGES to the folder of kodim01.png to kodim24.png"
        );
        return Vec::new();
    };
    let mut paths: Vec<_> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "png"));
    paths.sort();
    paths
}

/// The photograph's mosaic, repeated until it fills the frame. Its sides are even, so the colours go on.
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
