//! A stream that stands still or ends.

use std::time::Duration;

use super::Passage;
use crate::chance::Chance;

/// What stops a stream.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Interruption {
    /// It stands still for this long.
    Stall(Duration),
    /// The pipe breaks, for good.
    Disconnect,
}

/// What is counted to find the place of the interruption.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Unit {
    /// Bytes.
    Byte,
    /// Packets: non-empty runs between zeros.
    Packet,
}

/// A stream that is interrupted before some of its bytes or packets.
#[derive(Debug)]
pub(crate) struct InterruptedStream {
    unit: Unit,
    interruption: Interruption,
    chance: Chance,
    /// Bytes passed or packets begun, and so the number of the next one.
    count: u64,
    inside: bool,
}

impl InterruptedStream {
    pub(super) fn new(unit: Unit, interruption: Interruption, chance: Chance) -> Self {
        Self { unit, interruption, chance, count: 0, inside: false }
    }

    pub(super) fn pass(&mut self, bytes: &[u8], out: &mut Vec<u8>) -> Passage {
        let place = match self.unit {
            _ if self.chance.next().is_none() => None,
            Unit::Byte => self.struck_byte(bytes.len()),
            Unit::Packet => bytes.iter().position(|&byte| self.strikes_before(byte)),
        };
        let passed = &bytes[..place.unwrap_or(bytes.len())];
        out.extend_from_slice(passed);
        Passage { bytes: passed.len(), interruption: place.map(|_| self.interruption) }
    }

    /// The first of the next `length` bytes that is struck.
    fn struck_byte(&mut self, length: usize) -> Option<usize> {
        let number = self.chance.next()?;
        let offset = usize::try_from(number.checked_sub(self.count)?).ok().filter(|&offset| offset < length);
        self.count += offset.unwrap_or(length) as u64;
        offset.filter(|_| self.chance.strikes(number))
    }

    /// Whether a struck packet begins with `byte`. It then counts as begun, and does not strike again when the interrupted
    /// bytes are passed once more.
    fn strikes_before(&mut self, byte: u8) -> bool {
        let begins = byte != 0 && !self.inside;
        self.inside = byte != 0;
        self.count += u64::from(begins);
        begins && self.chance.strikes(self.count - 1)
    }
}
