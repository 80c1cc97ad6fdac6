//! A board that leaves out the zero behind its packets: each is complete only when the next one begins.

use super::Conversation;
use crate::board::BoardError;

/// So often in succession no link loses just the zero.
const TIMES: u32 = 3;

impl Conversation {
    /// Notes whether a wait that ended in vain ended with a packet that lacks nothing but its closing zero.
    pub(super) fn note_unclosed(&mut self) -> Result<(), BoardError> {
        let mut decoder = self.decoder.clone();
        let is_unclosed = matches!(decoder.next(&mut [0].as_slice()), Some(Ok(_)));
        self.unclosed = if is_unclosed { self.unclosed + 1 } else { 0 };
        if self.unclosed < TIMES { Ok(()) } else { Err(BoardError::Unclosed) }
    }
}
