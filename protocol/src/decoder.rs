//! From bytes to packets, whatever the link has done to the bytes.

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

/// The most bytes between two zeros that can be a packet.
const MAX_STUFFED: usize = cobs::stuffed_length(MAX_PACKET);

/// Finds packets in a byte stream. A zero ends a packet wherever the stream was entered, so at most the packet that was
/// damaged is lost.
#[derive(Clone, Debug, Default)]
pub struct Decoder {
    /// The bytes so far of a packet that has not ended.
    stuffed: Vec<u8>,
    too_long: bool,
    /// The packet that ended last.
    packet: Vec<u8>,
}

impl Decoder {
    /// A decoder that treats whatever comes before the first zero as a packet.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes bytes from the front of `input` until a packet has ended, well or badly, or `input` is used up.
    pub fn next<'d>(&'d mut self, input: &mut &[u8]) -> Option<Result<Packet<'d>, Damage>> {
        loop {
            let Some(end) = memchr::memchr(0, input) else {
                self.collect(core::mem::take(input));
                return None;
            };
            let head = &input[..end];
            *input = &input[end + 1..];
            if !self.stuffed.is_empty() || self.too_long || !head.is_empty() {
                return Some(self.end(head));
            }
        }
    }

    fn collect(&mut self, bytes: &[u8]) {
        if self.stuffed.len() + bytes.len() > MAX_STUFFED {
            self.stuffed.clear();
            self.too_long = true;
        } else if !self.too_long {
            self.stuffed.extend_from_slice(bytes);
        }
    }

    /// The packet whose last bytes are `tail`.
    fn end(&mut self, tail: &[u8]) -> Result<Packet<'_>, Damage> {
        self.packet.clear();
        let too_long = self.too_long || self.stuffed.len() + tail.len() > MAX_STUFFED;
        let unstuffed = if too_long {
            Err(Damage::Size)
        } else if self.stuffed.is_empty() {
            cobs::unstuff(tail, &mut self.packet).ok_or(Damage::Stuffing)
        } else {
            self.stuffed.extend_from_slice(tail);
            cobs::unstuff(&self.stuffed, &mut self.packet).ok_or(Damage::Stuffing)
        };
        self.stuffed.clear();
        self.too_long = false;
        unstuffed.and_then(|()| open(&self.packet))
    }
}

/// The packet in these unstuffed bytes, if they arrived as they were sent.
fn open(packet: &[u8]) -> Result<Packet<'_>, Damage> {
    let length = packet.len();
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
