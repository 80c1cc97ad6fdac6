//! The wire between a host and a halfrow board, as `protocol/WIRE.md` specifies it.
//!
//! ```text
//!   Request, Reply ──► payload ──► packet (header, payload, CRC-32) ──► COBS between zeros ──► bytes
//!     (message)                      (packet)                            (cobs, decoder)
//! ```
//!
//! Pure: no input or output, no clock, no files, and no standard library; the feature `std` uses it only to detect what
//! the processor supports. The types here say what a packet means. The board decides what to do with it, and the host
//! when to ask again.

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
