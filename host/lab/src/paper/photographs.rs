//! The 24 photographs of Table 1, as the experiment of Sect. 4.1 takes them: all in landscape format, 768 x 512.

use std::path::{Path, PathBuf};

use super::expected::PHOTOGRAPHS;
use halfrow::frames::preview::RgbImage;
use halfrow::frames::{self, ReadError, landscape};

/// Columns of a photograph in landscape format.
pub(super) const WIDTH: usize = 768;

/// Rows of a photograph in landscape format.
pub(super) const HEIGHT: usize = 512;

/// A folder that does not hold the photographs.
#[derive(Debug, thiserror::Error)]
pub enum PhotographError {
    /// One of the paper's photographs is missing, or is not a picture.
    #[error(
        "the photograph {number} of {PHOTOGRAPHS} cannot be used; give --images a folder with kodim01.png to \
         kodim{PHOTOGRAPHS}.png, the lossless pictures of Kodak's PhotoCD (https://r0k.us/graphics/kodak)"
    )]
    Read {
        /// Which, from 1.
        number: usize,
        /// Why.
        source: ReadError,
    },
    /// One of the paper's photographs has another size than the paper's.
    #[error(
        "{} is {width} x {height}, and the paper's photographs are {WIDTH} x {HEIGHT}, landscape or standing; give the \
         pictures as they were released",
        path.display()
    )]
    Size {
        /// The file.
        path: PathBuf,
        /// Its columns.
        width: usize,
        /// Its rows.
        height: usize,
    },
}

/// The photographs in `folder`, in the order of their numbers. Those in portrait format are turned a quarter clockwise.
///
/// # Errors
/// [`PhotographError`] for the first that is missing or is not what it should be.
pub fn read(folder: &Path) -> Result<Vec<RgbImage>, PhotographError> {
    (1..=PHOTOGRAPHS).map(|number| photograph(folder, number)).collect()
}

fn photograph(folder: &Path, number: usize) -> Result<RgbImage, PhotographError> {
    let path = folder.join(format!("kodim{number:02}.png"));
    let image = frames::read_rgb(&path).map_err(|source| PhotographError::Read { number, source })?;
    match (image.width, image.height) {
        (WIDTH, HEIGHT) | (HEIGHT, WIDTH) => Ok(landscape(image)),
        (width, height) => Err(PhotographError::Size { path, width, height }),
    }
}
