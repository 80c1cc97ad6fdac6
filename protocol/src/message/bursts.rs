//! BURST, RECORDS, EXPECT and TRAP: frames that the board makes and signs on its own (`fpga/AT-SPEED.md`).

use alloc::vec::Vec;

use crate::bytes::Fields;
use crate::samples::packed_length;
use crate::{MAX_PAYLOAD, Malformed};

macro_rules! codes {
    ($(#[$doc:meta])* $name:ident, $field:literal; $($(#[$of:meta])* $variant:ident = $code:literal,)*) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[repr(u8)]
        pub enum $name {
            $($(#[$of])* $variant = $code,)*
        }

        impl $name {
            fn read(fields: &mut Fields<'_>) -> Result<Self, Malformed> {
                match fields.u8()? {
                    $($code => Ok(Self::$variant),)*
                    other => Err(Malformed::Value { field: $field, value: other.into() }),
                }
            }
        }
    };
}

codes! {
    /// What the frames of a burst hold, and which tables they are made with (AT-SPEED.md, *Burst*).
    BurstMode, "mode";
    /// New content in each frame, made with the active tables.
    Fresh = 0,
    /// New content in each frame; every second one is made with the shadow tables.
    Alternating = 1,
    /// The same content in each frame, made with the active tables.
    Repeating = 2,
    /// Like repeating, with the trap set.
    Trapped = 3,
}

codes! {
    /// How far a burst has come.
    BurstState, "state";
    /// There has been no burst in this session.
    None = 0,
    /// Frames are to come, or one is inside the core.
    UnderWay = 1,
    /// The record of the last frame exists.
    Ended = 2,
}

/// Starts a burst, or sets how many frames the one under way has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Burst {
    /// The burst's id, drawn by the host, not 0. A request that names the last burst starts nothing.
    pub burst: u32,
    /// How many frames; [`Burst::ENDLESS`] for frames until the burst is ended, 0 to end it after the present frame.
    pub frames: u32,
    /// The seed of the content.
    pub seed: u32,
    /// f: the number of frame 0, modulo 2^16.
    pub first_frame: u16,
    /// Pixel clocks between two frames, at least the least that the board advertises.
    pub frame_blanking: u16,
    /// Content and tables of the frames.
    pub mode: BurstMode,
}

impl Burst {
    /// The number of frames of a burst that goes on until it is ended.
    pub const ENDLESS: u32 = u32::MAX;

    pub(crate) fn write(&self, payload: &mut Vec<u8>) {
        for field in [self.burst, self.frames, self.seed] {
            payload.extend_from_slice(&field.to_le_bytes());
        }
        payload.extend_from_slice(&self.first_frame.to_le_bytes());
        payload.extend_from_slice(&self.frame_blanking.to_le_bytes());
        payload.push(self.mode as u8);
    }

    pub(crate) fn read(mut fields: Fields<'_>) -> Result<Self, Malformed> {
        let burst = Self {
            burst: fields.u32()?,
            frames: fields.u32()?,
            seed: fields.u32()?,
            first_frame: fields.u16()?,
            frame_blanking: fields.u16()?,
            mode: BurstMode::read(&mut fields)?,
        };
        Ok(fields.end(burst))
    }
}

/// A board's signed record of one frame (AT-SPEED.md, *Record*). Counts stay at their greatest value instead of wrapping.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FrameRecord {
    /// CRC-32 of the rows' signatures, in the order in which they left.
    pub signature: u32,
    /// Outputs: W·H.
    pub samples: u32,
    /// Rows of which the last output was given: H.
    pub rows: u16,
    /// The smallest first or last latency of any row, in pixel clocks; 0 without a row.
    pub least_latency: u16,
    /// The largest.
    pub most_latency: u16,
    /// Board clocks without enable, from the frame's first sample to its last output.
    pub pauses: u16,
    /// The generation of the tables that the frame was made with; 0 for the shadow tables.
    pub generation: u8,
    /// Whether the frame waited for a free record, so that it did not directly follow the previous frame.
    pub held_back: bool,
}

impl FrameRecord {
    /// Bytes of a record on the wire.
    pub const BYTES: usize = 18;
    const HELD_BACK: u8 = 1;

    /// The record as it stands on the wire.
    #[must_use]
    pub fn to_bytes(&self) -> [u8; Self::BYTES] {
        let [s0, s1, s2, s3] = self.signature.to_le_bytes();
        let [n0, n1, n2, n3] = self.samples.to_le_bytes();
        let words = [self.rows, self.least_latency, self.most_latency, self.pauses].map(u16::to_le_bytes);
        let [[r0, r1], [l0, l1], [m0, m1], [p0, p1]] = words;
        let flags = if self.held_back { Self::HELD_BACK } else { 0 };
        [s0, s1, s2, s3, n0, n1, n2, n3, r0, r1, l0, l1, m0, m1, p0, p1, self.generation, flags]
    }
}

impl From<[u8; FrameRecord::BYTES]> for FrameRecord {
    fn from(bytes: [u8; FrameRecord::BYTES]) -> Self {
        let [s0, s1, s2, s3, n0, n1, n2, n3, r0, r1, l0, l1, m0, m1, p0, p1, generation, flags] = bytes;
        Self {
            signature: u32::from_le_bytes([s0, s1, s2, s3]),
            samples: u32::from_le_bytes([n0, n1, n2, n3]),
            rows: u16::from_le_bytes([r0, r1]),
            least_latency: u16::from_le_bytes([l0, l1]),
            most_latency: u16::from_le_bytes([m0, m1]),
            pauses: u16::from_le_bytes([p0, p1]),
            generation,
            held_back: flags & Self::HELD_BACK != 0,
        }
    }
}

/// Records of the session's last burst: those from frame `from` on that are made and fit into a packet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Records<'a> {
    /// The burst; 0 for none.
    pub burst: u32,
    /// The frame of the first record, counted from 0.
    pub from: u32,
    /// How far the burst has come.
    pub state: BurstState,
    /// The records, at most [`Records::MOST`] of them, as they stand on the wire.
    pub bytes: &'a [[u8; FrameRecord::BYTES]],
}

impl<'a> Records<'a> {
    /// Bytes before the records.
    pub const HEAD: usize = 10;
    /// The most records in a packet.
    pub const MOST: usize = (MAX_PAYLOAD - Self::HEAD) / FrameRecord::BYTES;

    /// The records, one per frame.
    pub fn records(&self) -> impl Iterator<Item = FrameRecord> + use<'a> {
        self.bytes.iter().map(|&bytes| bytes.into())
    }

    pub(crate) fn write(&self, payload: &mut Vec<u8>) {
        let bytes = &self.bytes[..self.bytes.len().min(Self::MOST)];
        payload.extend_from_slice(&self.burst.to_le_bytes());
        payload.extend_from_slice(&self.from.to_le_bytes());
        #[expect(clippy::cast_possible_truncation, reason = "a packet holds 226 records")]
        payload.extend_from_slice(&[self.state as u8, bytes.len() as u8]);
        payload.extend_from_slice(bytes.as_flattened());
    }

    pub(crate) fn read(mut fields: Fields<'a>) -> Result<Self, Malformed> {
        let (burst, from, state) = (fields.u32()?, fields.u32()?, BurstState::read(&mut fields)?);
        let count = usize::from(fields.u8()?);
        let (bytes, _) = fields.take(count * FrameRecord::BYTES)?.as_chunks();
        Ok(fields.end(Self { burst, from, state, bytes }))
    }
}

/// The signatures that the rows of a repeating frame must have, for the trap.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Expect<'a> {
    /// The first of the rows.
    pub first: u16,
    /// One signature per row, as they stand on the wire; at most [`Expect::MOST`].
    pub bytes: &'a [[u8; Expect::BYTES]],
}

impl<'a> Expect<'a> {
    /// Bytes of a signature on the wire.
    pub const BYTES: usize = 4;
    const HEAD: usize = 4;
    /// The most signatures in a packet.
    pub const MOST: usize = (MAX_PAYLOAD - Self::HEAD) / Self::BYTES;

    /// The signatures, one per row.
    pub fn signatures(&self) -> impl Iterator<Item = u32> + use<'a> {
        self.bytes.iter().map(|&bytes| u32::from_le_bytes(bytes))
    }

    pub(crate) fn write(&self, payload: &mut Vec<u8>) {
        let bytes = &self.bytes[..self.bytes.len().min(Self::MOST)];
        payload.extend_from_slice(&self.first.to_le_bytes());
        #[expect(clippy::cast_possible_truncation, reason = "a packet holds 1019 signatures")]
        payload.extend_from_slice(&(bytes.len() as u16).to_le_bytes());
        payload.extend_from_slice(bytes.as_flattened());
    }

    pub(crate) fn read(mut fields: Fields<'a>) -> Result<Self, Malformed> {
        let (first, count) = (fields.u16()?, usize::from(fields.u16()?));
        let (bytes, _) = fields.take(count * Self::BYTES)?.as_chunks();
        Ok(fields.end(Self { first, bytes }))
    }
}

/// The first row of a burst whose signature was not the expected one (AT-SPEED.md, *Trap*).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TrappedRow<'a> {
    /// n: the frame of the burst, from 0.
    pub frame: u32,
    /// The row of the frame.
    pub row: u16,
    /// Samples in the row.
    pub width: u16,
    /// The signature that the row has.
    pub signature: u32,
    /// Its samples, as [`crate::samples::pack`] packs them.
    pub packed: &'a [u8],
}

impl<'a> TrappedRow<'a> {
    /// Appends the field `kept`, and the row if one was trapped.
    pub(crate) fn write(kept: Option<&Self>, payload: &mut Vec<u8>) {
        payload.push(u8::from(kept.is_some()));
        if let Some(Self { frame, row, width, signature, packed }) = kept {
            payload.extend_from_slice(&frame.to_le_bytes());
            payload.extend_from_slice(&row.to_le_bytes());
            payload.extend_from_slice(&width.to_le_bytes());
            payload.extend_from_slice(&signature.to_le_bytes());
            payload.extend_from_slice(packed);
        }
    }

    pub(crate) fn read(mut fields: Fields<'a>) -> Result<Option<Self>, Malformed> {
        match fields.u8()? {
            0 => return Ok(fields.end(None)),
            1 => {}
            other => return Err(Malformed::Value { field: "kept", value: other.into() }),
        }
        let (frame, row, width, signature) = (fields.u32()?, fields.u16()?, fields.u16()?, fields.u32()?);
        let packed = fields.take(packed_length(usize::from(width)))?;
        Ok(fields.end(Some(Self { frame, row, width, signature, packed })))
    }
}
