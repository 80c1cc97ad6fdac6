//! The frame's geometry: what a board must know about a frame besides its samples.

use crate::BitDepth;
use crate::lens::Short;

/// The narrowest frame of the datapath, in columns. At this width half a row is as long as a board's longest fixed delay.
pub const MIN_WIDTH: usize = 64;

/// The widest frame of the datapath, in columns: the MT9P031's full row.
pub const MAX_WIDTH: usize = 2592;

/// The tallest frame of the datapath, in rows.
pub const MAX_HEIGHT: usize = 2048;

/// Size, depth and optical centre of the frames that a table set is for (DATAPATH.md, "Frame").
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Geometry {
    width: usize,
    height: usize,
    depth: BitDepth,
    centre2: u32,
}

/// The datapath has no frames of this size or depth, or with this optical centre.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GeometryError {
    /// A width that is odd or outside [`MIN_WIDTH`] to [`MAX_WIDTH`].
    #[error(
        "a width of {0} columns is not an even number from {min} to {max}; give such a width, or crop or pad the frame",
        min = MIN_WIDTH,
        max = MAX_WIDTH
    )]
    Width(usize),
    /// A height outside 1 to [`MAX_HEIGHT`].
    #[error("a height of {0} rows is outside 1 to {max}; give a height within, or crop the frame", max = MAX_HEIGHT)]
    Height(usize),
    /// An optical centre outside the frame.
    #[error(
        "the optical centre is at column {}, outside the frame's 0 to {last}; \
         give the column of the lens's axis, counted from 0",
        Short(*.column)
    )]
    Centre {
        /// The column given.
        column: f64,
        /// The frame's last column.
        last: usize,
    },
}

impl Geometry {
    /// A frame of `width` columns and `height` rows, with the optical centre at column `centre2` / 2.
    ///
    /// # Errors
    /// [`GeometryError`] when the width is odd or outside [`MIN_WIDTH`] to [`MAX_WIDTH`], the height is outside 1 to
    /// [`MAX_HEIGHT`], or `centre2` is above 2W − 2.
    pub fn new(width: usize, height: usize, depth: BitDepth, centre2: u32) -> Result<Self, GeometryError> {
        if !(MIN_WIDTH..=MAX_WIDTH).contains(&width) || width % 2 == 1 {
            return Err(GeometryError::Width(width));
        }
        if !(1..=MAX_HEIGHT).contains(&height) {
            return Err(GeometryError::Height(height));
        }
        if centre2 as usize > 2 * width - 2 {
            return Err(GeometryError::Centre { column: f64::from(centre2) / 2.0, last: width - 1 });
        }
        Ok(Self { width, height, depth, centre2 })
    }

    /// A frame with the optical centre in its middle: C = W − 1.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn centred(width: usize, height: usize, depth: BitDepth) -> Result<Self, GeometryError> {
        let centre2 = u32::try_from(width.saturating_sub(1)).map_err(|_| GeometryError::Width(width))?;
        Self::new(width, height, depth, centre2)
    }

    /// The same frame with the optical centre at `column`, rounded to half a column: C = floor(2 · cx + 1/2).
    ///
    /// # Errors
    /// [`GeometryError::Centre`] when the rounded centre is outside columns 0 to W − 1 or is not a number.
    pub fn with_centre(self, column: f64) -> Result<Self, GeometryError> {
        let centre2 = (2.0 * column + 0.5).floor();
        if (0.0..=2.0 * self.width as f64 - 2.0).contains(&centre2) {
            Ok(Self { centre2: centre2 as u32, ..self })
        } else {
            Err(GeometryError::Centre { column, last: self.width - 1 })
        }
    }

    /// W: columns, even.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// H: rows.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// B: bits of a sample.
    #[must_use]
    pub fn depth(&self) -> BitDepth {
        self.depth
    }

    /// C: twice the column of the optical centre, 0 to 2W − 2.
    #[must_use]
    pub fn centre2(&self) -> u32 {
        self.centre2
    }

    /// Column and row of the frame's middle: (W − 1)/2 and (H − 1)/2.
    #[must_use]
    pub fn middle(&self) -> (f64, f64) {
        ((self.width - 1) as f64 / 2.0, (self.height - 1) as f64 / 2.0)
    }

    /// y of row `row`: its distance below the optical centre in rows. The centre is `centre_y`, by default the middle (H −
    /// 1)/2.
    #[must_use]
    pub fn row_offset(&self, row: usize, centre_y: Option<f64>) -> f64 {
        row as f64 - centre_y.unwrap_or(self.middle().1)
    }

    /// The column whose sample P(m) stands in for column `column`: itself inside the row; beyond its ends, the row's first or
    /// last column of the same colour (DATAPATH.md, "Taps").
    #[must_use]
    pub fn sample_column(&self, column: i64) -> usize {
        let parity = column.rem_euclid(2) as usize;
        match usize::try_from(column) {
            Err(_) => parity,
            Ok(column) if column < self.width => column,
            Ok(_) => self.width - 2 + parity,
        }
    }
}

impl Default for Geometry {
    /// The paper's frame: 1920 × 1080, 12 bits, the lens in the middle (Sect. 4.2).
    fn default() -> Self {
        Self { width: 1920, height: 1080, depth: BitDepth::Twelve, centre2: 1919 }
    }
}
