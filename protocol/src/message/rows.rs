//! ROW_IN and ROW_OUT: rows on their way to the core and back.

use alloc::vec::Vec;

use crate::bytes::Fields;
use crate::samples::{pack, packed_length};
use crate::{Kind, Malformed, Packet};

/// Which row it is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RowPlace {
    /// The number of the row, counted through all frames of the session.
    pub row_sequence: u32,
    /// The frame's number, chosen by the host.
    pub frame: u16,
    /// The row within the frame, from 0 at the top.
    pub row: u16,
    /// Samples in the row.
    pub width: u16,
    /// Whether this is the last row of its frame: the core is flushed after it.
    pub last: bool,
}

impl RowPlace {
    /// Bytes of a place with its generation.
    pub(super) const BYTES: usize = 12;
    const LAST: u8 = 1;

    fn write(&self, generation: u8, payload: &mut Vec<u8>) {
        payload.extend_from_slice(&self.row_sequence.to_le_bytes());
        payload.extend_from_slice(&self.frame.to_le_bytes());
        payload.extend_from_slice(&self.row.to_le_bytes());
        payload.extend_from_slice(&self.width.to_le_bytes());
        payload.extend_from_slice(&[if self.last { Self::LAST } else { 0 }, generation]);
    }

    fn read(fields: &mut Fields<'_>) -> Result<(Self, u8), Malformed> {
        let place = Self {
            row_sequence: fields.u32()?,
            frame: fields.u16()?,
            row: fields.u16()?,
            width: fields.u16()?,
            last: fields.u8()? & Self::LAST != 0,
        };
        Ok((place, fields.u8()?))
    }
}

fn packed_samples<'a>(fields: &mut Fields<'a>, width: u16) -> Result<&'a [u8], Malformed> {
    fields.take(packed_length(usize::from(width)))
}

/// A row to correct.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RowIn<'a> {
    /// Which row.
    pub place: RowPlace,
    /// Its samples, as [`crate::samples::pack`] packs them.
    pub packed: &'a [u8],
}

impl<'a> RowIn<'a> {
    /// Bytes of the payload before the samples.
    pub const HEAD: usize = RowPlace::BYTES;

    pub(crate) fn write(&self, payload: &mut Vec<u8>) {
        self.place.write(0, payload);
        payload.extend_from_slice(self.packed);
    }

    /// Appends the payload of a row whose samples are not packed yet.
    pub fn write_samples(place: &RowPlace, samples: &[u16], payload: &mut Vec<u8>) {
        place.write(0, payload);
        pack(samples, payload);
    }

    pub(crate) fn read(mut fields: Fields<'a>) -> Result<Self, Malformed> {
        let (place, _) = RowPlace::read(&mut fields)?;
        let packed = packed_samples(&mut fields, place.width)?;
        Ok(fields.end(Self { place, packed }))
    }
}

/// A corrected row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RowOut<'a> {
    /// Which row.
    pub place: RowPlace,
    /// The generation of the tables that made it.
    pub generation: u8,
    /// Pixel clocks from the first sample in to the first sample out.
    pub first_latency: u16,
    /// Pixel clocks from the last sample in to the last sample out.
    pub last_latency: u16,
    /// Board clocks for which gaps kept the enable off, up to the row's last sample; stays at 65535.
    pub pauses: u16,
    /// How often the row was sent before; stays at 65535.
    pub repeats: u16,
    /// Its samples, as [`crate::samples::pack`] packs them.
    pub packed: &'a [u8],
    /// CRC-32 of the row's samples as they entered the core, each as a 16-bit word; none if the payload ends with the
    /// samples. Only meaningful from a board with the capability `entered`.
    pub entered: Option<u32>,
}

impl<'a> RowOut<'a> {
    /// Bytes of the payload before the samples.
    pub const HEAD: usize = RowPlace::BYTES + 8;
    /// Bytes of `entered`, after the samples.
    pub const ENTERED: usize = 4;

    pub(crate) fn write(&self, payload: &mut Vec<u8>) {
        self.place.write(self.generation, payload);
        for field in [self.first_latency, self.last_latency, self.pauses, self.repeats] {
            payload.extend_from_slice(&field.to_le_bytes());
        }
        payload.extend_from_slice(self.packed);
        payload.extend(self.entered.into_iter().flat_map(u32::to_le_bytes));
    }

    /// The place of a row whose samples need not all be there; none if `packet` is no row or ends before them.
    #[must_use]
    pub fn place_of(packet: &Packet<'_>) -> Option<RowPlace> {
        let is_row = packet.header.kind == Kind::RowOut.code() && packet.payload.len() >= Self::HEAD;
        is_row
            .then_some(packet.payload)
            .and_then(|payload| RowPlace::read(&mut Fields(payload)).ok())
            .map(|(place, _)| place)
    }

    pub(crate) fn read(mut fields: Fields<'a>) -> Result<Self, Malformed> {
        let (place, generation) = RowPlace::read(&mut fields)?;
        let row = Self {
            place,
            generation,
            first_latency: fields.u16()?,
            last_latency: fields.u16()?,
            pauses: fields.u16()?,
            repeats: fields.u16()?,
            packed: packed_samples(&mut fields, place.width)?,
            entered: fields.u32().ok(),
        };
        Ok(fields.end(row))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_s_payload_is_as_long_as_its_parts() {
        let (place, packed) = (RowPlace::default(), &[1, 2, 3][..]);
        let mut payload = Vec::new();
        RowIn { place, packed }.write(&mut payload);
        assert_eq!(payload.len(), RowIn::HEAD + packed.len());
        payload.clear();
        let (generation, first_latency, last_latency, pauses, repeats) = (1, 2, 3, 4, 5);
        let entered = Some(6);
        RowOut { place, generation, first_latency, last_latency, pauses, repeats, packed, entered }
            .write(&mut payload);
        assert_eq!(payload.len(), RowOut::HEAD + packed.len() + RowOut::ENTERED);
    }
}
