//! The packet: header, payload, CRC-32; and how it is put on the wire.

use alloc::vec::Vec;
use core::fmt;

use crate::{MAX_PACKET, MAX_PAYLOAD, VERSION, cobs};

/// Bytes of a header.
pub(crate) const HEADER: usize = 12;
/// Bytes of a CRC-32.
pub(crate) const CRC: usize = 4;
/// Bytes of a packet that are not payload.
pub(crate) const OVERHEAD: usize = HEADER + CRC;

/// The most bytes that a packet with `payload` bytes of payload takes on the wire, the zeros around it included.
#[must_use]
pub const fn wire_length(payload: usize) -> usize {
    cobs::stuffed_length(OVERHEAD.saturating_add(payload)).saturating_add(2)
}

/// What a packet is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Kind {
    /// Opens a session.
    Hello = 0x00,
    /// What the board is and can do.
    Capabilities = 0x01,
    /// The board's counters.
    Status = 0x02,
    /// Drops rows, the session or the tables.
    Reset = 0x03,
    /// Bytes that come back unchanged.
    Echo = 0x04,
    /// Writes entries of a shadow table.
    TableWrite = 0x10,
    /// Reads entries back through a datapath port.
    TableRead = 0x11,
    /// The CRC-32 of entries read through a datapath port.
    TableCrc = 0x12,
    /// Makes the shadow tables the active ones, from a frame on.
    Commit = 0x13,
    /// Sets width, height, depth, centre, blanking and gaps.
    Configure = 0x18,
    /// A row to correct.
    RowIn = 0x20,
    /// A corrected row.
    RowOut = 0x21,
    /// Only the acknowledgement in the header.
    RowAck = 0x22,
    /// Starts or ends frames that the board makes on its own.
    Burst = 0x30,
    /// The board's signed records of these frames.
    Records = 0x31,
    /// The signatures that the rows of a repeating frame must have.
    Expect = 0x32,
    /// The first row whose signature was not the expected one.
    Trap = 0x33,
    /// Why a request was refused.
    Refusal = 0x7f,
}

impl Kind {
    /// Every kind.
    pub const ALL: [Self; 18] = [
        Self::Hello,
        Self::Capabilities,
        Self::Status,
        Self::Reset,
        Self::Echo,
        Self::TableWrite,
        Self::TableRead,
        Self::TableCrc,
        Self::Commit,
        Self::Configure,
        Self::RowIn,
        Self::RowOut,
        Self::RowAck,
        Self::Burst,
        Self::Records,
        Self::Expect,
        Self::Trap,
        Self::Refusal,
    ];

    /// The kind with this code.
    #[must_use]
    pub fn from_code(code: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.code() == code)
    }

    /// The code on the wire.
    #[must_use]
    pub const fn code(self) -> u8 {
        self as u8
    }

    /// The name as WIRE.md writes it, such as `ROW_IN`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Hello => "HELLO",
            Self::Capabilities => "CAPABILITIES",
            Self::Status => "STATUS",
            Self::Reset => "RESET",
            Self::Echo => "ECHO",
            Self::TableWrite => "TABLE_WRITE",
            Self::TableRead => "TABLE_READ",
            Self::TableCrc => "TABLE_CRC",
            Self::Commit => "COMMIT",
            Self::Configure => "CONFIGURE",
            Self::RowIn => "ROW_IN",
            Self::RowOut => "ROW_OUT",
            Self::RowAck => "ROW_ACK",
            Self::Burst => "BURST",
            Self::Records => "RECORDS",
            Self::Expect => "EXPECT",
            Self::Trap => "TRAP",
            Self::Refusal => "REFUSAL",
        }
    }
}

/// Its name.
impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The fields before every payload, except version and length.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Header {
    /// The code of the packet's [`Kind`]; a receiver may not know it.
    pub kind: u8,
    /// A host counts its packets; a reply repeats its request's number; a board counts the rows that it sends.
    pub sequence: u16,
    /// Set in replies.
    pub reply: bool,
    /// The session number from the reply to HELLO; 0 outside a session.
    pub session: u8,
    /// From a board: the row sequence number before which the host may send. From a host: the row sequence number
    /// before which all corrected rows have arrived.
    pub window: u32,
}

impl Header {
    const REPLY: u8 = 1;

    fn write(&self, payload_length: usize) -> [u8; HEADER] {
        let mut bytes = [0; HEADER];
        bytes[0] = VERSION;
        bytes[1] = self.kind;
        bytes[2..4].copy_from_slice(&self.sequence.to_le_bytes());
        #[expect(clippy::cast_possible_truncation, reason = "the encoder refuses payloads over 4080 bytes")]
        bytes[4..6].copy_from_slice(&(payload_length as u16).to_le_bytes());
        bytes[6] = if self.reply { Self::REPLY } else { 0 };
        bytes[7] = self.session;
        bytes[8..12].copy_from_slice(&self.window.to_le_bytes());
        bytes
    }

    /// The version, the header and the length of the payload.
    pub(crate) fn read(bytes: &[u8; HEADER]) -> (u8, Self, usize) {
        let [version, kind, sequence_0, sequence_1, length_0, length_1, flags, session, window @ ..] = *bytes;
        let header = Self {
            kind,
            sequence: u16::from_le_bytes([sequence_0, sequence_1]),
            reply: flags & Self::REPLY != 0,
            session,
            window: u32::from_le_bytes(window),
        };
        (version, header, usize::from(u16::from_le_bytes([length_0, length_1])))
    }
}

/// A packet that arrived intact: its CRC, length and version were right.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Packet<'a> {
    /// Its header.
    pub header: Header,
    /// Its payload, at most [`MAX_PAYLOAD`] bytes.
    pub payload: &'a [u8],
}

/// A payload over [`MAX_PAYLOAD`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("a payload of {0} bytes is over the {MAX_PAYLOAD} of a packet; split it")]
pub struct TooLong(pub usize);

/// Puts packets on the wire; reuses its buffer from packet to packet.
#[derive(Debug, Default)]
pub struct Encoder {
    packet: Vec<u8>,
}

impl Encoder {
    /// An encoder.
    #[must_use]
    pub fn new() -> Self {
        Self { packet: Vec::with_capacity(MAX_PACKET) }
    }

    /// Appends a packet to `wire`: a zero, the stuffed packet, a zero. Its payload is what `write_payload` appends to its
    /// argument.
    ///
    /// # Errors
    /// [`TooLong`], with nothing appended, when the payload is over [`MAX_PAYLOAD`].
    pub fn encode(
        &mut self,
        header: &Header,
        write_payload: impl FnOnce(&mut Vec<u8>),
        wire: &mut Vec<u8>,
    ) -> Result<(), TooLong> {
        self.encode_altered(header, write_payload, |_| {}, wire)
    }

    /// Like [`Self::encode`], but `alter` changes header and payload before the CRC is computed, for example into a packet
    /// that no receiver accepts.
    ///
    /// # Errors
    /// Like [`Self::encode`].
    pub fn encode_altered(
        &mut self,
        header: &Header,
        write_payload: impl FnOnce(&mut Vec<u8>),
        alter: impl FnOnce(&mut [u8]),
        wire: &mut Vec<u8>,
    ) -> Result<(), TooLong> {
        self.packet.clear();
        self.packet.extend_from_slice(&[0; HEADER]);
        write_payload(&mut self.packet);
        let length = self.packet.len() - HEADER;
        if length > MAX_PAYLOAD {
            return Err(TooLong(length));
        }
        self.packet[..HEADER].copy_from_slice(&header.write(length));
        alter(&mut self.packet);
        let crc = crc32fast::hash(&self.packet);
        self.packet.extend_from_slice(&crc.to_le_bytes());
        wire.reserve(wire_length(length));
        wire.push(0);
        cobs::stuff(&self.packet, wire);
        wire.push(0);
        Ok(())
    }
}
