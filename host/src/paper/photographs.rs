//! The 24 photographs of Table 1, as the experiment of Sect. 4.1 takes them: all lying, 768 x 512.

use std::path::{Path, PathBuf};

use super::expected::PHOTOGRAPHS;
use crate::frames::preview::RgbImage;
use crate::frames::{self, ReadError};

/// Columns of a photograph that lies.
pub(super) const WIDTH: usize = 768;

/// Rows of a photograph that lies.
pub(super) const HEIGHT: usize = 512;

/// A folder that does not hold the photographs.
#[derive(Debug, thiserror::Error)]
pub enum PhotographError {
    /// One is not there, or is no picture.
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
    /// One has another size.
    #[error(
        "{} is {width} x {height}, and the paper's photographs are {WIDTH} x {HEIGHT}, lying or standing; give the \
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

/// The photographs in `folder`, in the order of their numbers. Those that stand are turned a quarter clockwise.
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
        (WIDTH, HEIGHT) | (HEIGHT, WIDTH) => Ok(lying(image)),
        (width, height) => Err(PhotographError::Size { path, width, height }),
    }
}

/// `image` turned a quarter clockwise if it stands.
#[must_use]
pub fn lying(image: RgbImage) -> RgbImage {
    if image.height > image.width { turned_clockwise(&image) } else { image }
}

/// A quarter turn clockwise: the left column becomes the top row, read upwards.
fn turned_clockwise(image: &RgbImage) -> RgbImage {
    let (width, height) = (image.height, image.width);
    let pixel = |row, column| {
        let start = 3 * ((width - 1 - column) * image.width + row);
        image.data.get(start..start + 3).unwrap_or_default()
    };
    let places = (0..height).flat_map(|row| (0..width).map(move |column| (row, column)));
    let data = places.flat_map(|(row, column)| pixel(row, column)).copied().collect();
    RgbImage { width, height, data }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: 1 2 / 3 4 / 5 6 becomes 5 3 1 / 6 4 2.
    #[test]
    fn a_standing_picture_is_turned_clockwise() {
        let grey = |values: &[u8]| values.iter().flat_map(|&value| [value; 3]).collect();
        let standing = RgbImage { width: 2, height: 3, data: grey(&[1, 2, 3, 4, 5, 6]) };
        let lying = RgbImage { width: 3, height: 2, data: grey(&[5, 3, 1, 6, 4, 2]) };
        assert_eq!(turned_clockwise(&standing), lying);
    }
}
