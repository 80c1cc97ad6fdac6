//! RESET and CONFIGURE: what a board forgets, and what it is set to.

use alloc::vec::Vec;

use crate::Malformed;
use crate::bytes::Fields;

/// How much a reset drops.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum ResetLevel {
    /// The rows in the banks and in the core.
    Rows = 0,
    /// The rows and the session.
    Session = 1,
    /// The rows, the configuration and the tables.
    Tables = 2,
}

/// A reset.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reset {
    /// How much it drops.
    pub level: ResetLevel,
    /// The row sequence number that the board then waits for. A host that goes on picks one beyond any that it sent, so that no
    /// late row fits.
    pub next_row: u32,
}

impl Reset {
    pub(crate) fn write(&self, payload: &mut Vec<u8>) {
        payload.push(self.level as u8);
        payload.extend_from_slice(&self.next_row.to_le_bytes());
    }

    pub(crate) fn read(mut fields: Fields<'_>) -> Result<Self, Malformed> {
        let level = match fields.u8()? {
            0 => ResetLevel::Rows,
            1 => ResetLevel::Session,
            2 => ResetLevel::Tables,
            other => return Err(Malformed::Value { field: "level", value: other.into() }),
        };
        let reset = Self { level, next_row: fields.u32()? };
        Ok(fields.end(reset))
    }
}

/// The geometry and timing with which rows are played.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Configuration {
    /// W: samples per row, even.
    pub width: u16,
    /// H: rows per frame.
    pub height: u16,
    /// C: twice the column of the optical centre, 0 to 2W − 2.
    pub centre2: u16,
    /// Pixel clocks between two rows, at least the board's least blanking.
    pub blanking: u16,
    /// Seed of the gaps in and between rows; 0 for none.
    pub gap_seed: u32,
    /// B: bits per sample: 8, 10 or 12.
    pub bits: u8,
}

impl Configuration {
    pub(crate) fn write(&self, payload: &mut Vec<u8>) {
        for field in [self.width, self.height, self.centre2, self.blanking] {
            payload.extend_from_slice(&field.to_le_bytes());
        }
        payload.extend_from_slice(&self.gap_seed.to_le_bytes());
        payload.push(self.bits);
    }

    pub(crate) fn read(mut fields: Fields<'_>) -> Result<Self, Malformed> {
        let configuration = Self {
            width: fields.u16()?,
            height: fields.u16()?,
            centre2: fields.u16()?,
            blanking: fields.u16()?,
            gap_seed: fields.u32()?,
            bits: fields.u8()?,
        };
        Ok(fields.end(configuration))
    }
}
