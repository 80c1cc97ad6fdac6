//! Bringing pictures to the size of a frame: cropped about their centre to its shape, then scaled.

use std::fmt;

use image::imageops::{self, FilterType};
use image::{ImageBuffer, Pixel, Rgb};

use super::DecodeError;
use super::size::MAX_SIDE;

/// How the size of a picture in colour is treated. Raw samples are never scaled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PictureSize {
    /// It is taken as it is.
    #[default]
    Any,
    /// It must have these numbers of columns and rows.
    Exactly(usize, usize),
    /// It is cropped and scaled to these numbers of columns and rows, at most [`MAX_SIDE`] each.
    Fitted(usize, usize),
}

impl PictureSize {
    /// How a picture of `(width, height)` is fitted; none if it is taken as it is.
    ///
    /// # Errors
    /// [`DecodeError::OtherSize`] or [`DecodeError::FittedTooLarge`].
    pub(super) fn fitting(self, (width, height): (usize, usize)) -> Result<Option<Fitting>, DecodeError> {
        match self {
            Self::Exactly(columns, rows) if (columns, rows) != (width, height) => {
                Err(DecodeError::OtherSize { width, height, columns, rows })
            }
            Self::Fitted(columns, rows) if columns.max(rows) > MAX_SIDE => {
                Err(DecodeError::FittedTooLarge { columns, rows })
            }
            Self::Fitted(columns, rows) if (columns, rows) != (width, height) => {
                Ok(Fitting::new((width, height), (columns, rows)))
            }
            _ => Ok(None),
        }
    }
}

/// How a picture was brought to the size of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fitting {
    /// Columns and rows of the picture as it is seen.
    pub found: (usize, usize),
    /// Columns and rows of the part about its centre that was kept.
    pub cropped: (usize, usize),
    /// Columns and rows of the frame.
    pub wanted: (usize, usize),
}

impl Fitting {
    /// From the size `found` to the size `wanted`: the largest part with the shape of `wanted` is kept. None if either has no
    /// pixels.
    fn new(found: (usize, usize), wanted: (usize, usize)) -> Option<Self> {
        if [found.0, found.1, wanted.0, wanted.1].contains(&0) {
            return None;
        }
        let rounded = |product: usize, by: usize| ((product + by / 2) / by).max(1);
        let cropped = if found.0 * wanted.1 > wanted.0 * found.1 {
            (rounded(found.1 * wanted.0, wanted.1), found.1)
        } else {
            (found.0, rounded(found.0 * wanted.1, wanted.0))
        };
        Some(Self { found, cropped, wanted })
    }

    /// The same fitting for the picture as it is stored in its file, a quarter turned.
    pub(super) fn turned(self) -> Self {
        let swapped = |(width, height)| (height, width);
        Self { found: swapped(self.found), cropped: swapped(self.cropped), wanted: swapped(self.wanted) }
    }

    /// `image`, fitted. Values are scaled as they are coded, not in linear light.
    pub(super) fn apply<Sample>(
        &self,
        image: &ImageBuffer<Rgb<Sample>, Vec<Sample>>,
    ) -> ImageBuffer<Rgb<Sample>, Vec<Sample>>
    where
        Rgb<Sample>: Pixel<Subpixel = Sample>,
        Sample: image::Primitive + 'static,
    {
        let side = |length| u32::try_from(length).unwrap_or(u32::MAX);
        let margin = |found: usize, cropped: usize| side(found.saturating_sub(cropped) / 2);
        let (left, top) = (margin(self.found.0, self.cropped.0), margin(self.found.1, self.cropped.1));
        let part = imageops::crop_imm(image, left, top, side(self.cropped.0), side(self.cropped.1));
        imageops::resize(&*part, side(self.wanted.0), side(self.wanted.1), FilterType::CatmullRom)
    }
}

/// As in `4032 x 3024, cropped to 4032 x 2268 about its centre, 75 % of it, scaled to 1920 x 1080 (Catmull-Rom)`.
impl fmt::Display for Fitting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { found, cropped, wanted } = self;
        write!(f, "{} x {}", found.0, found.1)?;
        if cropped != found {
            let kept = 100 * cropped.0 * cropped.1 / (found.0 * found.1);
            write!(f, ", cropped to {} x {} about its centre, {kept} % of it", cropped.0, cropped.1)?;
        }
        if cropped != wanted {
            write!(f, ", scaled to {} x {} (Catmull-Rom)", wanted.0, wanted.1)?;
        }
        Ok(())
    }
}
