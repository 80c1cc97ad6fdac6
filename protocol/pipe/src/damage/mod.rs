//! What a fault does to the bytes of one direction, as they arrive.

mod bytes;
mod interruption;
mod packets;

use super::chance::Chance;
use super::fault::{Harm, PipeFault};

use bytes::SpoiltBytes;
use interruption::InterruptedStream;
use packets::SpoiltPackets;

pub(super) use bytes::ByteHarm;
pub(super) use interruption::{Interruption, Unit};
pub(super) use packets::PacketHarm;

/// An end of the pipe.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    Board,
    Host,
}

/// The fault in one direction.
#[derive(Debug)]
pub(super) enum Damage {
    None,
    Bytes(SpoiltBytes),
    Packets(SpoiltPackets),
    Interrupted(InterruptedStream),
}

/// How far some bytes have passed.
#[derive(Debug, PartialEq)]
pub(super) struct Passage {
    /// How many are done, from the front.
    pub(super) bytes: usize,
    /// What happens before the remaining ones.
    pub(super) interruption: Option<Interruption>,
}

impl Damage {
    /// What `fault` does to bytes towards `side`.
    pub(super) fn new(fault: Option<PipeFault>, side: Side) -> Self {
        let Some(fault) = fault.filter(|fault| fault.concerns(side)) else { return Self::None };
        let chance = Chance::new(fault.occurrence, fault.seed(side));
        match fault.harm {
            Harm::Bytes(harm) => Self::Bytes(SpoiltBytes::new(harm, chance)),
            Harm::Packets(harm) => Self::Packets(SpoiltPackets::new(harm, chance)),
            Harm::Interrupted(unit, interruption) => {
                Self::Interrupted(InterruptedStream::new(unit, interruption, chance))
            }
        }
    }

    /// Appends to `out` what is left of `bytes`. A packet whose harm depends on its end is held back until the end has come.
    pub(super) fn pass(&mut self, bytes: &[u8], out: &mut Vec<u8>) -> Passage {
        match self {
            Self::None => out.extend_from_slice(bytes),
            Self::Bytes(spoilt) => spoilt.pass(bytes, out),
            Self::Packets(spoilt) => spoilt.pass(bytes, out),
            Self::Interrupted(stream) => return stream.pass(bytes, out),
        }
        Passage { bytes: bytes.len(), interruption: None }
    }
}

#[cfg(test)]
mod tests;
