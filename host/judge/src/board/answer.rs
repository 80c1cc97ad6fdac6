//! An answer that was waited for, and what it says.

use std::time::Duration;

use halfrow_protocol::message::{RefusalCode, Reply, Status};
use halfrow_protocol::{Header, Kind, Packet};

use super::BoardError;
use super::conversation::Conversation;
use super::sent_requests::Outgoing;

/// How long to listen after an echo for whatever else comes.
const MORE: Duration = Duration::from_millis(200);

/// A packet that was kept.
pub(super) struct OwnedPacket {
    pub(super) header: Header,
    pub(super) payload: Vec<u8>,
    /// How long nothing had been sent before the request that it answers.
    pub(super) silent: Duration,
}

impl OwnedPacket {
    pub(super) fn packet(&self) -> Packet<'_> {
        Packet { header: self.header, payload: &self.payload }
    }

    /// Whether it is the request itself, sent under the header `sent`, and not an answer to it. The header tells: a board's
    /// window is ahead of the host's.
    pub(super) fn is_echo_of(&self, sent: &Header, asking: &Outgoing<'_>) -> bool {
        self.header == *sent && self.payload == asking.payload()
    }
}

impl Conversation {
    /// What echoes: a plain line, or a device that has more to say, which may come later. If packets of a board come as well, it
    /// is an echo only.
    pub(super) fn echoed(&mut self) -> Result<BoardError, BoardError> {
        if self.session.number != 0 {
            return Ok(BoardError::Echoed);
        }
        let begun = self.now();
        while let Some(wait) = MORE.checked_sub(self.since(begun)).filter(|wait| !wait.is_zero()) {
            self.exchange(wait, || "listening after an echo".to_owned(), |_| {})?;
        }
        let beside = self.tally.bytes_in.saturating_sub(self.tally.bytes_out);
        let is_board = self.tally.packets_in > self.tally.packets_out;
        Ok(if beside > 0 && !is_board { BoardError::Console { bytes: beside } } else { BoardError::Echoed })
    }
}

/// The counters in `answer`, which is that to a STATUS.
pub(super) fn status_in(answer: &OwnedPacket) -> Result<Status, BoardError> {
    take_reply(Kind::Status, answer, |reply| match reply {
        Reply::Status(status) => Some(status),
        _ => None,
    })
}

/// The expected part of a reply, or the error that stands in its place.
pub(super) fn take_reply<T>(
    kind: Kind,
    answer: &OwnedPacket,
    take: impl FnOnce(Reply<'_>) -> Option<T>,
) -> Result<T, BoardError> {
    match Reply::read(&answer.packet()).map_err(|source| BoardError::Malformed { kind, source })? {
        Reply::Refusal(refusal) if refusal.code == RefusalCode::Session => {
            Err(BoardError::SessionLost { silent: answer.silent })
        }
        Reply::Refusal(refusal) => Err(BoardError::Refused { kind, refusal }),
        reply => take(reply).ok_or(BoardError::Unexpected { kind }),
    }
}
