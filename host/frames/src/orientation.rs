//! How the camera was held.

use image::metadata;

/// How a picture must be turned and mirrored to be upright, by the tag Orientation of TIFF and EXIF.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Orientation(metadata::Orientation);

impl Orientation {
    /// The tag's number.
    pub(super) const TAG: u16 = 274;

    /// The orientation of this value of the tag; upright if the value has no meaning.
    pub(super) fn of_tag(value: u32) -> Self {
        let known = u8::try_from(value).ok().and_then(metadata::Orientation::from_exif);
        known.map_or_else(Self::default, Self)
    }

    /// The orientation in the bytes of an EXIF block; upright if there is none.
    pub(super) fn of_exif(block: &[u8]) -> Self {
        metadata::Orientation::from_exif_chunk(block).map_or_else(Self::default, Self)
    }

    /// The tag's value, 1 to 8.
    pub(super) fn tag(self) -> u16 {
        self.0.to_exif().into()
    }

    /// Columns and rows of a picture as it is shown, from those stored in its file.
    pub(super) fn seen(self, (width, height): (usize, usize)) -> (usize, usize) {
        if is_quarter_turn(self.0) { (height, width) } else { (width, height) }
    }

    /// The same as the type of the `image` crate.
    pub(super) fn turn(self) -> metadata::Orientation {
        self.0
    }
}

/// Upright.
impl Default for Orientation {
    fn default() -> Self {
        Self(metadata::Orientation::NoTransforms)
    }
}

/// Whether rows become columns.
pub(super) fn is_quarter_turn(orientation: metadata::Orientation) -> bool {
    use metadata::Orientation::{Rotate90, Rotate90FlipH, Rotate270, Rotate270FlipH};
    matches!(orientation, Rotate90 | Rotate90FlipH | Rotate270 | Rotate270FlipH)
}
