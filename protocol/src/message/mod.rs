//! The contents of packets. Integers are little endian. A reader skips what a later version appended to a payload that
//! it knows.

mod bursts;
mod capabilities;
mod datapath;
mod hello;
mod refusal;
mod rows;
mod setup;
mod status;
mod tables;

use alloc::vec::Vec;

pub use bursts::{Burst, BurstMode, BurstState, Expect, FrameRecord, Records, TrappedRow};
pub use capabilities::{BoardNature, Bursts, Capabilities, ClockSource, Depths, Grids};
pub use datapath::{Datapath, UnknownDatapath};
pub use hello::{Hello, MAGIC, Welcome};
pub use refusal::{Refusal, RefusalCode};
pub use rows::{RowIn, RowOut, RowPlace};
pub use setup::{Configuration, Reset, ResetLevel};
pub use status::Status;
pub use tables::{
    Bank, Commit, Entries, NODE_BYTES, NODE_WEIGHTS, NODES, ROW_FACTOR_BYTES, Shape, Span, Table,
};

use crate::bytes::Fields;
use crate::{Kind, Packet};

/// The payload of a packet does not have the form that its kind calls for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Malformed {
    /// The packet's kind is not known, or not one that this side receives.
    #[error("packet kind {0:#04x} is not known here")]
    Kind(u8),
    /// Fewer bytes than the message has.
    #[error("the payload is too short")]
    Length,
    /// A field holds a value that has no meaning.
    #[error("the field `{field}` holds {value}, which has no meaning")]
    Value {
        /// The field's name in WIRE.md.
        field: &'static str,
        /// What it holds.
        value: u32,
    },
    /// A reply to HELLO that is not a halfrow board's.
    #[error("the peer answers, but not as a halfrow board")]
    Magic,
    /// Capabilities without one that every board has.
    #[error("the capability `{0}` is missing")]
    MissingCapability(&'static str),
}

/// What a host asks of a board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Request<'a> {
    /// Open a session.
    Hello(Hello),
    /// Say what you are and can do.
    Capabilities,
    /// Report your counters.
    Status {
        /// Set the counters to zero afterwards.
        clear: bool,
    },
    /// Drop rows, session or tables.
    Reset(Reset),
    /// Send these bytes back.
    Echo(&'a [u8]),
    /// Write these entries of a shadow table.
    TableWrite(Entries<'a>),
    /// Read entries back.
    TableRead(Span),
    /// Read entries back and report their CRC-32.
    TableCrc(Span),
    /// Use the shadow tables from a frame on.
    Commit(Commit),
    /// Use this geometry.
    Configure(Configuration),
    /// Correct this row.
    RowIn(RowIn<'a>),
    /// Take the acknowledgement in the header; there is no reply.
    RowAck,
    /// Make frames on your own, or change how many the burst under way has.
    Burst(Burst),
    /// Drop the records of the burst's frames before this one, and send those from it on.
    Records {
        /// The frame, counted from 0.
        from: u32,
    },
    /// Expect these signatures from the rows of a burst.
    Expect(Expect<'a>),
    /// Send the row that was trapped.
    Trap,
}

impl<'a> Request<'a> {
    /// The packet kind that carries it.
    #[must_use]
    pub fn kind(&self) -> Kind {
        match self {
            Self::Hello(_) => Kind::Hello,
            Self::Capabilities => Kind::Capabilities,
            Self::Status { .. } => Kind::Status,
            Self::Reset(_) => Kind::Reset,
            Self::Echo(_) => Kind::Echo,
            Self::TableWrite(_) => Kind::TableWrite,
            Self::TableRead(_) => Kind::TableRead,
            Self::TableCrc(_) => Kind::TableCrc,
            Self::Commit(_) => Kind::Commit,
            Self::Configure(_) => Kind::Configure,
            Self::RowIn(_) => Kind::RowIn,
            Self::RowAck => Kind::RowAck,
            Self::Burst(_) => Kind::Burst,
            Self::Records { .. } => Kind::Records,
            Self::Expect(_) => Kind::Expect,
            Self::Trap => Kind::Trap,
        }
    }

    /// Appends the payload.
    pub fn write(&self, payload: &mut Vec<u8>) {
        match self {
            Self::Hello(hello) => hello.write(payload),
            Self::Capabilities | Self::RowAck | Self::Trap => {}
            Self::Status { clear } => payload.push(u8::from(*clear)),
            Self::Reset(reset) => reset.write(payload),
            Self::Echo(bytes) => payload.extend_from_slice(bytes),
            Self::TableWrite(entries) => entries.write(payload),
            Self::TableRead(span) | Self::TableCrc(span) => span.write(payload),
            Self::Commit(commit) => commit.write(payload),
            Self::Configure(configuration) => configuration.write(payload),
            Self::RowIn(row) => row.write(payload),
            Self::Burst(burst) => burst.write(payload),
            Self::Records { from } => payload.extend_from_slice(&from.to_le_bytes()),
            Self::Expect(expect) => expect.write(payload),
        }
    }

    /// The request in `packet`.
    ///
    /// # Errors
    /// [`Malformed`] when the kind is not a request's or the payload is not the kind's.
    pub fn read(packet: &Packet<'a>) -> Result<Self, Malformed> {
        let code = packet.header.kind;
        let mut fields = Fields(packet.payload);
        match Kind::from_code(code).ok_or(Malformed::Kind(code))? {
            Kind::Hello => Hello::read(fields).map(Self::Hello),
            Kind::Capabilities => Ok(Self::Capabilities),
            Kind::Status => Ok(Self::Status { clear: fields.u8()? != 0 }),
            Kind::Reset => Reset::read(fields).map(Self::Reset),
            Kind::Echo => Ok(Self::Echo(packet.payload)),
            Kind::TableWrite => Entries::read(fields).map(Self::TableWrite),
            Kind::TableRead => Span::read(&mut fields).map(Self::TableRead),
            Kind::TableCrc => Span::read(&mut fields).map(Self::TableCrc),
            Kind::Commit => Commit::read(fields).map(Self::Commit),
            Kind::Configure => Configuration::read(fields).map(Self::Configure),
            Kind::RowIn => RowIn::read(fields).map(Self::RowIn),
            Kind::RowAck => Ok(Self::RowAck),
            Kind::Burst => Burst::read(fields).map(Self::Burst),
            Kind::Records => fields.u32().map(|from| Self::Records { from }),
            Kind::Expect => Expect::read(fields).map(Self::Expect),
            Kind::Trap => Ok(Self::Trap),
            Kind::RowOut | Kind::Refusal => Err(Malformed::Kind(code)),
        }
    }
}

/// What a board answers, or sends of its own accord (rows).
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Reply<'a> {
    /// A session is open.
    Hello(Welcome),
    /// What the board is and can do.
    Capabilities(Capabilities),
    /// The board's counters.
    Status(Status),
    /// What the request named was dropped.
    Reset,
    /// The bytes of the request.
    Echo(&'a [u8]),
    /// The entries are written.
    TableWrite,
    /// The entries as a datapath port reads them.
    TableRead(Entries<'a>),
    /// The CRC-32 of the entries as a datapath port reads them.
    TableCrc(u32),
    /// The tables are committed.
    Commit {
        /// Their generation.
        generation: u8,
    },
    /// The geometry is set.
    Configure,
    /// A corrected row.
    RowOut(RowOut<'a>),
    /// The burst starts, or its number of frames is set.
    Burst,
    /// The signed records of a burst's frames.
    Records(Records<'a>),
    /// The signatures are kept.
    Expect,
    /// The row that was trapped, if one was.
    Trap(Option<TrappedRow<'a>>),
    /// The request was refused.
    Refusal(Refusal),
}

impl<'a> Reply<'a> {
    /// The packet kind that carries it.
    #[must_use]
    pub fn kind(&self) -> Kind {
        match self {
            Self::Hello(_) => Kind::Hello,
            Self::Capabilities(_) => Kind::Capabilities,
            Self::Status(_) => Kind::Status,
            Self::Reset => Kind::Reset,
            Self::Echo(_) => Kind::Echo,
            Self::TableWrite => Kind::TableWrite,
            Self::TableRead(_) => Kind::TableRead,
            Self::TableCrc(_) => Kind::TableCrc,
            Self::Commit { .. } => Kind::Commit,
            Self::Configure => Kind::Configure,
            Self::RowOut(_) => Kind::RowOut,
            Self::Burst => Kind::Burst,
            Self::Records(_) => Kind::Records,
            Self::Expect => Kind::Expect,
            Self::Trap(_) => Kind::Trap,
            Self::Refusal(_) => Kind::Refusal,
        }
    }

    /// Appends the payload.
    pub fn write(&self, payload: &mut Vec<u8>) {
        match self {
            Self::Hello(welcome) => welcome.write(payload),
            Self::Capabilities(capabilities) => capabilities.write(payload),
            Self::Status(status) => status.write(payload),
            Self::Reset | Self::TableWrite | Self::Configure | Self::Burst | Self::Expect => {}
            Self::Echo(bytes) => payload.extend_from_slice(bytes),
            Self::TableRead(entries) => entries.write(payload),
            Self::TableCrc(crc) => payload.extend_from_slice(&crc.to_le_bytes()),
            Self::Commit { generation } => payload.push(*generation),
            Self::RowOut(row) => row.write(payload),
            Self::Records(records) => records.write(payload),
            Self::Trap(kept) => TrappedRow::write(kept.as_ref(), payload),
            Self::Refusal(refusal) => refusal.write(payload),
        }
    }

    /// The reply or row in `packet`.
    ///
    /// # Errors
    /// [`Malformed`] when the kind is not a reply's or the payload is not the kind's.
    pub fn read(packet: &Packet<'a>) -> Result<Self, Malformed> {
        let code = packet.header.kind;
        let mut fields = Fields(packet.payload);
        match Kind::from_code(code).ok_or(Malformed::Kind(code))? {
            Kind::Hello => Welcome::read(fields).map(Self::Hello),
            Kind::Capabilities => Capabilities::read(fields).map(Self::Capabilities),
            Kind::Status => Status::read(fields).map(Self::Status),
            Kind::Reset => Ok(Self::Reset),
            Kind::Echo => Ok(Self::Echo(packet.payload)),
            Kind::TableWrite => Ok(Self::TableWrite),
            Kind::TableRead => Entries::read(fields).map(Self::TableRead),
            Kind::TableCrc => fields.u32().map(Self::TableCrc),
            Kind::Commit => fields.u8().map(|generation| Self::Commit { generation }),
            Kind::Configure => Ok(Self::Configure),
            Kind::RowOut => RowOut::read(fields).map(Self::RowOut),
            Kind::Burst => Ok(Self::Burst),
            Kind::Records => Records::read(fields).map(Self::Records),
            Kind::Expect => Ok(Self::Expect),
            Kind::Trap => TrappedRow::read(fields).map(Self::Trap),
            Kind::Refusal => Refusal::read(fields).map(Self::Refusal),
            Kind::RowIn | Kind::RowAck => Err(Malformed::Kind(code)),
        }
    }
}
