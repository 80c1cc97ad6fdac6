//! DNG (Digital Negative 1.4): the raw samples, with what a raw developer needs to know about them.
//!
//! The samples are 16-bit words, uncompressed. Their levels and colours, and the camera's name, are those of the DNG that the
//! frame comes from. Of any other frame nothing is known about the sensor: black is 0, white is 2^B − 1, and the colours are
//! declared to be linear sRGB with a neutral of (1, 1, 1), so that a developer shows what [`super::preview::demosaic`] shows.
//! Tag names are those of Adobe's specification.

use std::io::{Seek, Write};

use halfrow_model::{Colour, Frame, Phase};
use tiff::TiffError;
use tiff::encoder::colortype::Gray16;
use tiff::encoder::{DirectoryEncoder, Rational, SRational, TiffEncoder, TiffKind};
use tiff::tags::Tag;

use super::Camera;

/// PhotometricInterpretation of a colour filter array.
pub(super) const FILTER_ARRAY: u16 = 32803;

/// CFARepeatPatternDim, and the value that it must have here: two rows of two columns.
pub(super) const REPEAT: (u16, [u16; 2]) = (33421, [2, 2]);
/// CFAPattern: one of red 0, green 1 and blue 2 for each place, row after row.
pub(super) const PATTERN: u16 = 33422;
/// DNGVersion.
pub(super) const VERSION: u16 = 50706;
/// DNGBackwardVersion: the oldest reader that understands the file.
const BACKWARD_VERSION: u16 = 50707;
/// Make.
pub(super) const MAKE: u16 = 271;
/// Model.
pub(super) const MODEL: u16 = 272;
/// UniqueCameraModel.
pub(super) const CAMERA: u16 = 50708;
/// CFAPlaneColor: the order of the colours in [`COLOUR_MATRIX`].
pub(super) const PLANES: u16 = 50710;
/// CFALayout: 1 where rows and columns are not staggered.
pub(super) const LAYOUT: u16 = 50711;
/// LinearizationTable.
pub(super) const LINEARISATION: u16 = 50712;
/// BlackLevelRepeatDim: the rows and columns over which [`BLACK`] repeats.
pub(super) const BLACK_REPEAT: u16 = 50713;
/// BlackLevel.
pub(super) const BLACK: u16 = 50714;
/// BlackLevelDeltaH and BlackLevelDeltaV: what is added to [`BLACK`] in each column and row.
pub(super) const BLACK_DELTAS: [u16; 2] = [50715, 50716];
/// WhiteLevel.
pub(super) const WHITE: u16 = 50717;
/// ColorMatrix1: from XYZ to the camera's colours.
pub(super) const COLOUR_MATRIX: u16 = 50721;
/// AsShotNeutral: the camera's colours of what should look white.
pub(super) const NEUTRAL: u16 = 50728;
/// ActiveArea: top, left, bottom and right of what the sensor saw.
pub(super) const ACTIVE_AREA: u16 = 50829;
/// CalibrationIlluminant1: the light that [`COLOUR_MATRIX`] holds for.
pub(super) const ILLUMINANT: u16 = 50778;
/// D65 in Exif's list of light sources.
const D65: u16 = 21;

/// From XYZ to linear sRGB by IEC 61966-2-1, in ten thousandths.
const XYZ_TO_SRGB: [i32; 9] = [32406, -15372, -4986, -9689, 18758, 415, 557, -2040, 10570];

/// Writes `frame` as a DNG, its samples unchanged, with what is known about its `camera`.
///
/// # Errors
/// Those of the encoder and of `out`.
pub fn encode(frame: &Frame, camera: &Camera, out: &mut (impl Write + Seek)) -> Result<(), TiffError> {
    let (width, height) = (u32::try_from(frame.width())?, u32::try_from(frame.height())?);
    let mut encoder = TiffEncoder::new(out)?;
    let mut image = encoder.new_image::<Gray16>(width, height)?;
    // Some developers expect exactly one strip.
    image.rows_per_strip(height)?;
    describe_file(image.encoder(), camera)?;
    describe_samples(image.encoder(), frame, camera)?;
    camera.describe(image.encoder())?;
    image.write_data(frame.samples())
}

fn describe_file<W: Write + Seek, K: TiffKind>(
    directory: &mut DirectoryEncoder<'_, W, K>,
    camera: &Camera,
) -> Result<(), TiffError> {
    // The full picture, not a reduced version of another.
    directory.write_tag(Tag::NewSubfileType, 0_u32)?;
    directory.write_tag(Tag::Software, concat!("halfrow ", env!("CARGO_PKG_VERSION")))?;
    if !camera.says(CAMERA) {
        directory.write_tag(Tag::Make, "halfrow")?;
        directory.write_tag(Tag::Model, "frame")?;
        directory.write_tag(Tag::Unknown(CAMERA), "halfrow frame")?;
    }
    directory.write_tag(Tag::Unknown(VERSION), [1_u8, 4, 0, 0])?;
    directory.write_tag(Tag::Unknown(BACKWARD_VERSION), [1_u8, 1, 0, 0])
}

fn describe_samples<W: Write + Seek, K: TiffKind>(
    directory: &mut DirectoryEncoder<'_, W, K>,
    frame: &Frame,
    camera: &Camera,
) -> Result<(), TiffError> {
    let (repeat, sides) = REPEAT;
    directory.write_tag(Tag::PhotometricInterpretation, FILTER_ARRAY)?;
    directory.write_tag(Tag::Unknown(repeat), sides)?;
    directory.write_tag(Tag::Unknown(PATTERN), pattern(frame.phase()))?;
    if !camera.says(BLACK) {
        directory.write_tag(Tag::Unknown(BLACK), 0_u16)?;
    }
    if !camera.says(WHITE) {
        directory.write_tag(Tag::Unknown(WHITE), frame.depth().max())?;
    }
    if camera.says(COLOUR_MATRIX) {
        return Ok(());
    }
    directory.write_tag(Tag::Unknown(PLANES), [0_u8, 1, 2])?;
    directory.write_tag(Tag::Unknown(COLOUR_MATRIX), XYZ_TO_SRGB.map(|n| SRational { n, d: 10_000 }))?;
    directory.write_tag(Tag::Unknown(NEUTRAL), [1; 3].map(|n| Rational { n, d: 1 }))?;
    directory.write_tag(Tag::Unknown(ILLUMINANT), D65)
}

/// The colours of the four places at the upper left, as in [`PATTERN`].
fn pattern(phase: Phase) -> [u8; 4] {
    [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(row, column)| match phase.colour(row, column) {
        Colour::Red => 0,
        Colour::Green => 1,
        Colour::Blue => 2,
    })
}

/// The phase with this [`PATTERN`].
pub(super) fn phase_of(found: [u8; 4]) -> Option<Phase> {
    Phase::ALL.into_iter().find(|&phase| pattern(phase) == found)
}
