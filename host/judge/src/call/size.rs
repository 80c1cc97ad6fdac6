//! Checks that a frame has the size of the tables that it is for.

use std::path::{Path, PathBuf};

use halfrow_model::{Geometry, MAX_HEIGHT, MAX_WIDTH, MIN_WIDTH};
use thiserror::Error;

use crate::frames::{PictureSize, ReadOptions};

/// The frame has another size than the tables are for.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{} is {width} x {height}, and the tables are for {columns} x {rows}; {remedy}", path.display())]
pub struct FrameOfOtherSize {
    /// The frame's file, or what the call names it by.
    pub path: PathBuf,
    /// The frame's columns.
    pub width: usize,
    /// The frame's rows.
    pub height: usize,
    /// The columns that the tables are for.
    pub columns: usize,
    /// The rows that the tables are for.
    pub rows: usize,
    /// What to do.
    pub remedy: String,
}

/// Refuses a frame of `width` x `height` that does not fit `geometry`. It is called `path` in the error, and was read as `how`
/// says.
///
/// # Errors
/// [`FrameOfOtherSize`]
pub fn check_size(
    path: &Path,
    (width, height): (usize, usize),
    how: &ReadOptions,
    geometry: &Geometry,
) -> Result<(), FrameOfOtherSize> {
    let (columns, rows) = (geometry.width(), geometry.height());
    if (width, height) == (columns, rows) {
        return Ok(());
    }
    let remedy = match Geometry::centred(width, height, geometry.depth()) {
        _ if matches!(how.size, PictureSize::Fitted(..)) => {
            "raw samples are never scaled; give a picture in colour, or tables of the frame's size".to_owned()
        }
        Ok(_) => "make tables of the frame's size".to_owned(),
        Err(_) => format!(
            "no tables can have the frame's size, since the datapath takes an even number of columns from \
             {MIN_WIDTH} to {MAX_WIDTH} and up to {MAX_HEIGHT} rows; scale or crop the picture"
        ),
    };
    Err(FrameOfOtherSize { path: path.to_owned(), width, height, columns, rows, remedy })
}
