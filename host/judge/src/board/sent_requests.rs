//! The latest requests, and how often each was answered. This tells a late answer from a lost one.

use std::collections::VecDeque;
use std::time::Duration;

use halfrow_protocol::{Kind, Packet, Reply, Request};

/// Requests that are remembered. On a link that keeps the order, only copies of the last few can still be under way.
const KEPT: usize = 16;

/// A request to be sent.
#[derive(Clone, Copy)]
pub(super) enum Outgoing<'a> {
    /// A request that the protocol knows.
    Request(&'a Request<'a>),
    /// Any payload under the given kind.
    Bytes(Kind, &'a [u8]),
}

impl Outgoing<'_> {
    pub(super) fn kind(&self) -> Kind {
        match self {
            Self::Request(request) => request.kind(),
            Self::Bytes(kind, _) => *kind,
        }
    }

    /// Appends the payload.
    pub(super) fn write(&self, payload: &mut Vec<u8>) {
        match self {
            Self::Request(request) => request.write(payload),
            Self::Bytes(_, bytes) => payload.extend_from_slice(bytes),
        }
    }

    pub(super) fn payload(&self) -> Vec<u8> {
        let mut payload = Vec::new();
        self.write(&mut payload);
        payload
    }

    /// Whether a second copy, arriving late and after other requests, may change the state of the board.
    fn changes(&self) -> bool {
        match self {
            Self::Request(Request::Status { clear }) => *clear,
            Self::Bytes(Kind::Status, clear) => clear.first().is_some_and(|&clear| clear != 0),
            other => may_change(other.kind()),
        }
    }
}

/// A request that was waited for.
#[derive(Clone, Debug)]
pub(crate) struct LastRequest {
    /// Its kind.
    pub(crate) kind: Kind,
    /// The number of its packet.
    pub(crate) sequence: u16,
    /// Its payload.
    pub(crate) payload: Vec<u8>,
}

impl Default for LastRequest {
    fn default() -> Self {
        Self { kind: Kind::Hello, sequence: 0, payload: Vec::new() }
    }
}

/// A request that was sent.
struct SentRequest {
    sequence: u16,
    kind: Kind,
    changes: bool,
    begun: Duration,
    /// How long the first answer took; none until it came.
    took: Option<Duration>,
    /// How often it was sent again without an answer to that copy so far.
    again: u32,
}

/// An answer that nobody is waiting for.
pub(super) struct Stray {
    /// If the request was sent again although nothing was lost: how long its first answer took.
    pub(super) needless: Option<Duration>,
    /// Whether the board may have been changed by a request that reached it twice.
    pub(super) changed: bool,
    /// Whether it is a further answer to a request that was sent only once.
    pub(super) is_second: bool,
}

/// The last requests.
#[derive(Default)]
pub(super) struct LastRequests(VecDeque<SentRequest>);

impl LastRequests {
    pub(super) fn note_request(&mut self, asking: &Outgoing<'_>, sequence: u16, now: Duration) {
        self.0.truncate(KEPT - 1);
        let (kind, changes) = (asking.kind(), asking.changes());
        self.0.push_front(SentRequest { sequence, kind, changes, begun: now, took: None, again: 0 });
    }

    /// Notes that the last request is sent once more. Returns whether that may change the board.
    pub(super) fn note_repeat(&mut self) -> bool {
        self.0.front_mut().is_some_and(|asked| {
            asked.again += 1;
            asked.changes
        })
    }

    /// Takes a packet. Returns what it shows if it is neither a row nor the first answer to a request.
    pub(super) fn take_answer(&mut self, packet: &Packet<'_>, now: Duration) -> Option<Stray> {
        let kind = Kind::from_code(packet.header.kind);
        if kind == Some(Kind::RowOut) {
            return None;
        }
        // The refusal of a row may carry the number of a much earlier request.
        let refused = refused(packet);
        let known = self.0.iter_mut().find(|asked| {
            asked.sequence == packet.header.sequence && refused.is_none_or(|kind| kind == asked.kind.code())
        });
        let Some(asked) = known else {
            // A refusal may be that of a row.
            let changed = kind.is_some_and(may_change);
            return (kind != Some(Kind::Refusal)).then_some(Stray {
                needless: None,
                changed,
                is_second: false,
            });
        };
        let Some(took) = asked.took else {
            asked.took = Some(now.saturating_sub(asked.begun));
            return None;
        };
        let needless = (asked.again > 0).then_some(took);
        asked.again = asked.again.saturating_sub(1);
        Some(Stray { needless, changed: asked.changes, is_second: needless.is_none() })
    }
}

/// The code of the kind that `packet` refuses, if it refuses one.
fn refused(packet: &Packet<'_>) -> Option<u8> {
    match Reply::read(packet) {
        Ok(Reply::Refusal(refusal)) => Some(refusal.kind),
        _ => None,
    }
}

/// Whether a late copy of a packet of `kind` may leave a sound board in another state. One that is missing here would be held
/// against the board.
fn may_change(kind: Kind) -> bool {
    match kind {
        Kind::Reset
        | Kind::TableWrite
        | Kind::Commit
        | Kind::Configure
        | Kind::RowIn
        | Kind::Burst
        | Kind::Expect => true,
        Kind::Hello
        | Kind::Capabilities
        | Kind::Status
        | Kind::Echo
        | Kind::TableRead
        | Kind::TableCrc
        | Kind::RowOut
        | Kind::RowAck
        | Kind::Records
        | Kind::Trap
        | Kind::Refusal => false,
    }
}

#[cfg(test)]
mod tests {
    use halfrow_protocol::Header;
    use halfrow_protocol::message::{Refusal, RefusalCode};

    use super::*;

    /// What `last` makes of an answer with this number.
    fn stray(last: &mut LastRequests, sequence: u16, kind: Kind, payload: &[u8]) -> Option<bool> {
        let header = Header { kind: kind.code(), sequence, reply: true, session: 1, window: 0 };
        let packet = Packet { header, payload };
        last.take_answer(&packet, Duration::ZERO).map(|stray| stray.changed)
    }

    /// WIRE.md numbers packets with 16 bits, so the 65,536th row after a request has that request's number.
    #[test]
    fn a_refused_row_is_no_second_answer_to_a_request_of_its_number() {
        let mut last = LastRequests::default();
        last.note_request(&Outgoing::Bytes(Kind::TableWrite, &[]), 7, Duration::ZERO);
        assert_eq!(stray(&mut last, 7, Kind::TableWrite, &[]), None);
        let refusal = |kind: Kind| {
            let mut payload = Vec::new();
            let refusal = Refusal { code: RefusalCode::Row, kind: kind.code(), detail: 0 };
            Reply::Refusal(refusal).write(&mut payload);
            payload
        };
        assert_eq!(stray(&mut last, 7, Kind::Refusal, &refusal(Kind::RowIn)), None);
        assert_eq!(stray(&mut last, 7, Kind::Refusal, &refusal(Kind::TableWrite)), Some(true));
        assert_eq!(stray(&mut last, 7, Kind::TableWrite, &[]), Some(true));
    }
}
