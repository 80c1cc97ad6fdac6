//! From bytes to packets, whatever the link did to the bytes.

use alloc::vec::Vec;

use crate::packet::{CRC, HEADER, OVERHEAD};
use crate::{Header, MAX_PACKET, Packet, VERSION, cobs};

/// Why the bytes between two zeros are no packet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Damage {
    /// No stuffing makes these bytes.
    #[error("the byte stuffing is broken")]
    Stuffing,
    /// Fewer bytes than a header and a CRC take, or more than any packet has.
    #[error("it is shorter or longer than any packet")]
    Size,
    /// The bytes are not the ones that were sent.
    #[error("its CRC-32 is wrong")]
    Crc,
    /// Whole, but of a version that this crate does not speak.
    #[error("it is of version {0} of the wire, and only version {VERSION} is known here")]
    Version(u8),
    /// Not as many bytes of payload as the header says.
    #[error("its length is not what its header says")]
    Length,
}

/// Finds packets in a byte stream. A zero ends a packet wherever the stream was entered, so at most the packet that was
/// damaged is lost.
#[derive(Debug, Default)]
pub struct Decoder {
    stuffed: Vec<u8>,
    too_long: bool,
    delivered: bool,
}

impl Decoder {
    /// A decoder that takes whatever comes before the first zero for a packet.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes bytes from the front of `input` until a packet has ended, well or badly, or `input` is used up.
    pub fn next<'d>(&'d mut self, input: &mut &[u8]) -> Option<Result<Packet<'d>, Damage>> {
        loop {
            if core::mem::take(&mut self.delivered) {
                self.stuffed.clear();
                self.too_long = false;
            }
            let end = memchr::memchr(0, input);
            let (head, rest) = input.split_at(end.unwrap_or(input.len()));
            self.collect(head);
            if end.is_none() {
                *input = rest;
                return None;
            }
            *input = &rest[1..];
            self.delivered = true;
            if !self.stuffed.is_empty() || self.too_long {
                return Some(self.open());
            }
        }
    }

    fn collect(&mut self, bytes: &[u8]) {
        if self.stuffed.len() + bytes.len() > cobs::stuffed_length(MAX_PACKET) {
            self.stuffed.clear();
            self.too_long = true;
        } else if !self.too_long {
            self.stuffed.extend_from_slice(bytes);
        }
    }

    fn open(&mut self) -> Result<Packet<'_>, Damage> {
        if self.too_long {
            return Err(Damage::Size);
        }
        let length = cobs::unstuff(&mut self.stuffed).ok_or(Damage::Stuffing)?;
        let packet = &self.stuffed[..length];
        if length > MAX_PACKET {
            return Err(Damage::Size);
        }
        let (body, crc) = packet.split_last_chunk::<CRC>().ok_or(Damage::Size)?;
        let (header, payload) = body.split_first_chunk::<HEADER>().ok_or(Damage::Size)?;
        if crc32fast::hash(body) != u32::from_le_bytes(*crc) {
            return Err(Damage::Crc);
        }
        let (version, header, payload_length) = Header::read(header);
        if version != VERSION {
            return Err(Damage::Version(version));
        }
        if payload_length + OVERHEAD != length {
            return Err(Damage::Length);
        }
        Ok(Packet { header, payload })
    }
}
