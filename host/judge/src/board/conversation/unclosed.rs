//! A board that leaves out the zero behind its packets: each is complete only when the next one begins.

use super::Conversation;
use crate::board::BoardError;

/// So often in succession no link loses just the zero.
const TIMES: u32 = 3;

/// Waits that ended with a packet without its closing zero.
#[derive(Default)]
pub(super) struct Unclosed {
    /// How many, in succession.
    waits: u32,
    /// The bytes that had come at the end of the last wait.
    bytes: u64,
}

impl Conversation {
    /// Notes whether a wait that ended in vain ended with a packet that lacks nothing but its closing zero. It only does if
    /// something came during it: such a board answers every retry, while on a link that stands still the same packet stays.
    pub(super) fn note_unclosed(&mut self) -> Result<(), BoardError> {
        let mut decoder = self.decoder.clone();
        let is_whole = matches!(decoder.next(&mut [0].as_slice()), Some(Ok(_)));
        let bytes = self.tally.bytes_in;
        let is_unclosed = is_whole && bytes != self.unclosed.bytes;
        let waits = if is_unclosed { self.unclosed.waits + 1 } else { 0 };
        self.unclosed = Unclosed { waits, bytes };
        if waits < TIMES { Ok(()) } else { Err(BoardError::Unclosed) }
    }
}
