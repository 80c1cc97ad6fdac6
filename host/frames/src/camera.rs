//! What a file says about its camera, for the file that is written in its place.

use std::io::{Cursor, Seek, Write};

use tiff::decoder::Decoder;
use tiff::encoder::{DirectoryEncoder, TiffKind};
use tiff::tags::{ByteOrder, Tag, Type, ValueBuffer};
use tiff::{Directory, TiffError};

use super::{Orientation, dng};

/// The tags that are carried from DNG to DNG. Those of a group hold only together, and all are left when the first is missing.
const GROUPS: [&[u16]; 4] = [
    &[dng::WHITE],
    &[dng::BLACK, dng::BLACK_REPEAT],
    &[
        dng::COLOUR_MATRIX,
        dng::NEUTRAL,
        dng::ILLUMINANT,
        dng::PLANES,
        50722, // ColorMatrix2
        50723, // CameraCalibration1
        50724, // CameraCalibration2
        50727, // AnalogBalance
        50729, // AsShotWhiteXY
        50730, // BaselineExposure
        50779, // CalibrationIlluminant2
        50931, // CameraCalibrationSignature
        50932, // ProfileCalibrationSignature
        50964, // ForwardMatrix1
        50965, // ForwardMatrix2
    ],
    &[dng::CAMERA, dng::MAKE, dng::MODEL],
];

/// A longer value is not carried: no matrix and no camera's name has so many numbers or letters.
const LONGEST: u64 = 256;

/// How a camera was held, and, if its frame comes from a DNG, what that says about its levels, its colours and its name.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Camera {
    /// How a viewer must turn raw samples.
    pub orientation: Orientation,
    tags: Vec<CarriedTag>,
}

/// A tag with its value in this computer's byte order.
#[derive(Clone, Debug, PartialEq, Eq)]
struct CarriedTag {
    tag: u16,
    kind: Type,
    bytes: Vec<u8>,
}

impl From<Orientation> for Camera {
    fn from(orientation: Orientation) -> Self {
        Self { orientation, tags: Vec::new() }
    }
}

impl Camera {
    /// The camera of the DNG in `bytes`.
    ///
    /// # Errors
    /// Those of the decoder, also when it does not support the kind of picture.
    pub(super) fn of_dng(bytes: &[u8], orientation: Orientation) -> Result<Self, TiffError> {
        let mut decoder = Decoder::new(Cursor::new(bytes))?;
        let mut directory = decoder.image_ifd();
        let mut tags = Vec::new();
        for group in GROUPS {
            let counted =
                |&tag: &u16| directory.find_entry(Tag::Unknown(tag)).map(|entry| (tag, entry.count()));
            let fits = |&(_, count): &(u16, u64)| (1..=LONGEST).contains(&count);
            let found: Vec<_> = group.iter().filter_map(counted).filter(fits).map(|(tag, _)| tag).collect();
            if found.first() != group.first() {
                continue;
            }
            for tag in found {
                let mut value = ValueBuffer::empty(Type::BYTE);
                directory.find_tag_buf(Tag::Unknown(tag), &mut value)?;
                value.set_byte_order(ByteOrder::native());
                tags.push(CarriedTag { tag, kind: value.data_type(), bytes: value.as_bytes().to_vec() });
            }
        }
        Ok(Self { orientation, tags })
    }

    /// Whether it has this tag.
    pub(super) fn says(&self, tag: u16) -> bool {
        self.tags.iter().any(|carried| carried.tag == tag)
    }

    /// Writes its tags into `directory`.
    ///
    /// # Errors
    /// Those of the encoder.
    pub(super) fn describe<W: Write + Seek, K: TiffKind>(
        &self,
        directory: &mut DirectoryEncoder<'_, W, K>,
    ) -> Result<(), TiffError> {
        directory.write_tag(Tag::Orientation, self.orientation.tag())?;
        for CarriedTag { tag, kind, bytes } in &self.tags {
            let entry = directory.write_entry_bytes(*kind, bytes)?;
            let mut carried = Directory::empty();
            carried.extend([(Tag::Unknown(*tag), entry)]);
            directory.extend_from(&carried);
            // A value that is not in its entry begins at an even offset.
            if bytes.len() > 4 && !bytes.len().is_multiple_of(2) {
                directory.write_data(0_u8)?;
            }
        }
        Ok(())
    }
}
