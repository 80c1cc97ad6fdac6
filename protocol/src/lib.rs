//! The wire between a host and a halfrow board, as `protocol/WIRE.md` lays it down.
//!
//! ```text
//!   Request, Reply ──► payload ──► packet (header, payload, CRC-32) ──► COBS between zeros ──► bytes
//!     (message)                      (packet)                            (cobs, decoder)
//! ```
//!
//! Pure: no input or output, no clock, no files, and no standard library, which the feature `std` only asks what the
//! processor has. What a packet means is said by the types here;
//! what a board does with it, by the board; when to ask again, by the host.

#![no_std]

extern crate alloc;
#[cfg(feature = "std")]
extern crate std;

mod bytes;
mod cobs;
mod decoder;
pub mod message;
mod packet;
pub mod samples;

pub use decoder::{Damage, Decoder};
pub use message::{Malformed, Reply, Request};
pub use packet::{Encoder, Header, Kind, Packet, TooLong, wire_length};

/// The version of the wire that this crate speaks.
pub const VERSION: u8 = 1;

/// The longest packet, header and CRC included, before stuffing.
pub const MAX_PACKET: usize = 4096;

/// The longest payload of a packet.
pub const MAX_PAYLOAD: usize = MAX_PACKET - packet::OVERHEAD;
