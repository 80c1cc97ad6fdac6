//! HELLO: a host opens a session.

use alloc::vec::Vec;

use crate::Malformed;
use crate::bytes::Fields;

/// The four bytes that identify a halfrow board.
pub const MAGIC: [u8; 4] = *b"HRW1";

/// A host's greeting.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Hello {
    /// Drawn anew for every session: a reply without it is stale.
    pub nonce: u32,
    /// Identifies the host program, which draws it when it starts and keeps it while it runs.
    pub host: u32,
    /// The oldest version of the wire that the host speaks.
    pub version_min: u8,
    /// The newest one.
    pub version_max: u8,
    /// Take the board over even if another host holds it.
    pub take_over: bool,
}

impl Hello {
    pub(crate) fn write(&self, payload: &mut Vec<u8>) {
        payload.extend_from_slice(&self.nonce.to_le_bytes());
        payload.extend_from_slice(&self.host.to_le_bytes());
        payload.extend_from_slice(&[self.version_min, self.version_max, u8::from(self.take_over)]);
    }

    pub(crate) fn read(mut fields: Fields<'_>) -> Result<Self, Malformed> {
        let hello = Self {
            nonce: fields.u32()?,
            host: fields.u32()?,
            version_min: fields.u8()?,
            version_max: fields.u8()?,
            take_over: fields.u8()? != 0,
        };
        Ok(fields.end(hello))
    }
}

/// A board's answer to [`Hello`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Welcome {
    /// The nonce of the greeting.
    pub nonce: u32,
    /// The version of the wire that the session uses.
    pub version: u8,
    /// The session's number, 1 to 255.
    pub session: u8,
    /// The build of the board's design: the first 32 bits of its commit.
    pub build: u32,
    /// The board's serial number (the FPGA's DNA where there is one), or 0.
    pub serial: u64,
}

impl Welcome {
    pub(crate) fn write(&self, payload: &mut Vec<u8>) {
        payload.extend_from_slice(&self.nonce.to_le_bytes());
        payload.extend_from_slice(&MAGIC);
        payload.extend_from_slice(&[self.version, self.session]);
        payload.extend_from_slice(&self.build.to_le_bytes());
        payload.extend_from_slice(&self.serial.to_le_bytes());
    }

    pub(crate) fn read(mut fields: Fields<'_>) -> Result<Self, Malformed> {
        let nonce = fields.u32()?;
        if fields.array()? != MAGIC {
            return Err(Malformed::Magic);
        }
        let welcome = Self {
            nonce,
            version: fields.u8()?,
            session: fields.u8()?,
            build: fields.u32()?,
            serial: fields.u64()?,
        };
        Ok(fields.end(welcome))
    }
}
