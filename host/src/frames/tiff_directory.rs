//! A first look at a TIFF's directory, which decides whether its decoder may see the file.
//!
//! A header of a few bytes can promise more than memory holds, and in places the decoder computes with such numbers
//! unchecked. So the tags that set sizes and codings are read here first, and anything but a plain picture is refused.

use super::{DecodeError, size};

const WIDTH: u16 = 256;
const HEIGHT: u16 = 257;
const BITS: u16 = 258;
const COMPRESSION: u16 = 259;
const PHOTOMETRIC: u16 = 262;
const CHANNELS: u16 = 277;
const PLANAR: u16 = 284;
const TILE_WIDTH: u16 = 322;
const TILE_HEIGHT: u16 = 323;

/// Refuses a TIFF that is not one plain picture: grey from black to white, or colour, with or without alpha, of 8 or 16
/// bits, uncompressed or packed by LZW, deflate or PackBits.
///
/// # Errors
/// [`DecodeError`] that names what is not taken, or the byte where the directory breaks off.
pub(super) fn check(bytes: &[u8]) -> Result<(), DecodeError> {
    let tags = Tags::read(bytes)?;
    let one = |tag, otherwise| tags.value(tag).unwrap_or(otherwise);
    let (width, height) = size::checked(one(WIDTH, 0).into(), one(HEIGHT, 0).into())?;
    size::checked(one(TILE_WIDTH, 0).into(), one(TILE_HEIGHT, 0).into())?;
    let (colour, channels, bits) = (one(PHOTOMETRIC, 1), one(CHANNELS, 1), one(BITS, 1));
    if !matches!((colour, channels), (1, 1) | (2, 3 | 4)) {
        let what = format!("a TIFF with colour code {colour} and {channels} channels");
        return Err(DecodeError::Unsupported { what, remedy: "save it as grey (black is zero) or RGB" });
    }
    if !matches!(bits, 8 | 16) {
        let what = format!("a TIFF of {bits} bits a sample");
        return Err(DecodeError::Unsupported { what, remedy: "save it with 8 or 16 bits" });
    }
    if one(PLANAR, 1) != 1 {
        let what = "a TIFF with a plane for each colour".to_owned();
        return Err(DecodeError::Unsupported { what, remedy: "save it with interleaved colours" });
    }
    let compression = one(COMPRESSION, 1);
    if !matches!(compression, 1 | 5 | 8 | 32773 | 32946) {
        let what = format!("a TIFF with compression {compression}");
        return Err(DecodeError::Unsupported {
            what,
            remedy: "save it uncompressed, or with LZW or deflate",
        });
    }
    let samples = width * height * if channels == 1 { 1 } else { 3 };
    size::plausible(bytes.len(), samples * if bits == 8 { 1 } else { 2 })
}

/// The tags of the first directory that hold a number.
struct Tags(Vec<(u16, u32)>);

impl Tags {
    fn read(bytes: &[u8]) -> Result<Self, DecodeError> {
        let file = Bytes { bytes, little: bytes.starts_with(b"II") };
        if file.short(2)? != 42 {
            let what = "a BigTIFF, or no TIFF at all,".to_owned();
            return Err(DecodeError::Unsupported { what, remedy: "save it as a classic TIFF" });
        }
        let directory = usize::try_from(file.long(4)?).unwrap_or(usize::MAX);
        let entries = usize::from(file.short(directory)?);
        let mut tags = Vec::new();
        for entry in 0..entries {
            let start = directory.saturating_add(2 + 12 * entry);
            file.check_count(start)?;
            let tag = file.short(start)?;
            if Self::wanted(tag) {
                tags.push((tag, file.value(start)?));
            }
        }
        tags.sort_unstable();
        match tags.windows(2).any(|pair| matches!(pair, [first, second] if first.0 == second.0)) {
            true => Err(DecodeError::TiffDirectory { offset: directory }),
            false => Ok(Self(tags)),
        }
    }

    fn wanted(tag: u16) -> bool {
        [WIDTH, HEIGHT, BITS, COMPRESSION, PHOTOMETRIC, CHANNELS, PLANAR, TILE_WIDTH, TILE_HEIGHT]
            .contains(&tag)
    }

    fn value(&self, tag: u16) -> Option<u32> {
        self.0.iter().find(|(found, _)| *found == tag).map(|&(_, value)| value)
    }
}

/// Numbers of either byte order at any place of a file.
struct Bytes<'a> {
    bytes: &'a [u8],
    little: bool,
}

impl Bytes<'_> {
    /// Refuses the directory entry at `start` when it claims more values than the file has bytes.
    fn check_count(&self, start: usize) -> Result<(), DecodeError> {
        let count = self.long(start.saturating_add(4))?;
        match usize::try_from(count) {
            Ok(count) if count <= self.bytes.len() => Ok(()),
            _ => Err(DecodeError::TiffDirectory { offset: start }),
        }
    }

    /// The number of the directory entry at `start`, or the first of several: a short or a long.
    fn value(&self, start: usize) -> Result<u32, DecodeError> {
        const SHORT: u16 = 3;
        const LONG: u16 = 4;
        let place = start.saturating_add(8);
        match (self.short(start.saturating_add(2))?, self.long(start.saturating_add(4))?) {
            (SHORT, 1 | 2) => self.short(place).map(u32::from),
            (SHORT, 3..) => {
                let elsewhere = usize::try_from(self.long(place)?).unwrap_or(usize::MAX);
                self.short(elsewhere).map(u32::from)
            }
            (LONG, 1) => self.long(place),
            _ => Err(DecodeError::TiffDirectory { offset: start }),
        }
    }

    fn short(&self, offset: usize) -> Result<u16, DecodeError> {
        let bytes = self.array(offset)?;
        Ok(if self.little { u16::from_le_bytes(bytes) } else { u16::from_be_bytes(bytes) })
    }

    fn long(&self, offset: usize) -> Result<u32, DecodeError> {
        let bytes = self.array(offset)?;
        Ok(if self.little { u32::from_le_bytes(bytes) } else { u32::from_be_bytes(bytes) })
    }

    fn array<const N: usize>(&self, offset: usize) -> Result<[u8; N], DecodeError> {
        let rest = self.bytes.get(offset..).unwrap_or_default();
        rest.first_chunk().copied().ok_or(DecodeError::TiffDirectory { offset })
    }
}
