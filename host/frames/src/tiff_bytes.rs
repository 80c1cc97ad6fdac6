//! The numbers of a TIFF's directory, which have either byte order and are in the entry or elsewhere.

use super::DecodeError;

/// The codes of the types of numbers.
const BYTE: u16 = 1;
pub(super) const SHORT: u16 = 3;
const LONG: u16 = 4;
const RATIONAL: u16 = 5;
const SIGNED_RATIONAL: u16 = 10;

/// Numbers at any place in a file, in the file's byte order.
pub(super) struct Bytes<'a> {
    bytes: &'a [u8],
    little: bool,
}

impl<'a> Bytes<'a> {
    /// The numbers of the file `bytes`, whose first two bytes give the order.
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, little: bytes.starts_with(b"II") }
    }

    /// Refuses the directory entry at `start` when it claims more values than the file has bytes.
    pub(super) fn check_count(&self, start: usize) -> Result<(), DecodeError> {
        let count = self.long(start.saturating_add(4))?;
        match usize::try_from(count) {
            Ok(count) if count <= self.bytes.len() => Ok(()),
            _ => Err(DecodeError::TiffDirectory { offset: start }),
        }
    }

    /// The number of the directory entry at `start`, or the first of several: a short or a long.
    pub(super) fn value(&self, start: usize) -> Result<u32, DecodeError> {
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

    /// All numbers of the directory entry at `start`: shorts, longs, or the numerators of fractions.
    pub(super) fn values(&self, start: usize) -> Result<Vec<u32>, DecodeError> {
        let size = match self.short(start.saturating_add(2))? {
            SHORT => 2,
            LONG => 4,
            RATIONAL | SIGNED_RATIONAL => 8,
            _ => return Err(DecodeError::TiffDirectory { offset: start }),
        };
        let count = usize::try_from(self.long(start.saturating_add(4))?).unwrap_or(usize::MAX);
        let place = start.saturating_add(8);
        let first = match count.saturating_mul(size) {
            0..=4 => place,
            _ => usize::try_from(self.long(place)?).unwrap_or(usize::MAX),
        };
        let places = (0..count).map(|index| first.saturating_add(index.saturating_mul(size)));
        places
            .map(|place| if size == 2 { self.short(place).map(u32::from) } else { self.long(place) })
            .collect()
    }

    /// The four bytes of the directory entry at `start`, the first one uppermost. For any other kind of value, a number that is
    /// not a pattern.
    pub(super) fn four_bytes(&self, start: usize) -> Result<u32, DecodeError> {
        match (self.short(start.saturating_add(2))?, self.long(start.saturating_add(4))?) {
            (BYTE, 4) => self.array(start.saturating_add(8)).map(u32::from_be_bytes),
            _ => Ok(u32::MAX),
        }
    }

    pub(super) fn short(&self, offset: usize) -> Result<u16, DecodeError> {
        let bytes = self.array(offset)?;
        Ok(if self.little { u16::from_le_bytes(bytes) } else { u16::from_be_bytes(bytes) })
    }

    pub(super) fn long(&self, offset: usize) -> Result<u32, DecodeError> {
        let bytes = self.array(offset)?;
        Ok(if self.little { u32::from_le_bytes(bytes) } else { u32::from_be_bytes(bytes) })
    }

    fn array<const N: usize>(&self, offset: usize) -> Result<[u8; N], DecodeError> {
        let rest = self.bytes.get(offset..).unwrap_or_default();
        rest.first_chunk().copied().ok_or(DecodeError::TiffDirectory { offset })
    }
}
