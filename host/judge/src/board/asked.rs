//! What was asked of late, and how often it was answered: by that a late answer is told from a lost one.

use std::collections::VecDeque;
use std::time::Duration;

use halfrow_protocol::{Kind, Packet, Request};

/// Requests that are remembered. Only copies of the last few can still be under way over a link that keeps their order.
const KEPT: usize = 16;

/// A request to be sent.
#[derive(Clone, Copy)]
pub(super) enum Asking<'a> {
    /// One as the protocol has it.
    Request(&'a Request<'a>),
    /// Any payload of a kind.
    Bytes(Kind, &'a [u8]),
}

impl Asking<'_> {
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

    /// Whether a second copy that comes late, behind others, may leave the board other than it was.
    fn changes(&self) -> bool {
        match self {
            Self::Request(Request::Status { clear }) => *clear,
            other => may_change(other.kind()),
        }
    }
}

/// A request that was sent.
struct Asked {
    sequence: u16,
    changes: bool,
    begun: Duration,
    /// How long the first answer took; none before it came.
    took: Option<Duration>,
    /// How often it was sent again and no answer to that has come.
    again: u32,
}

/// An answer that nobody waits for.
pub(super) struct Stray {
    /// How long the first answer took to a request that was sent again although nothing was lost.
    pub(super) needless: Option<Duration>,
    /// Whether the board may have been changed by a request that came twice.
    pub(super) changed: bool,
}

/// The last requests.
#[derive(Default)]
pub(super) struct LastAsked(VecDeque<Asked>);

impl LastAsked {
    pub(super) fn asked(&mut self, asking: &Asking<'_>, sequence: u16, now: Duration) {
        self.0.truncate(KEPT - 1);
        self.0.push_front(Asked { sequence, changes: asking.changes(), begun: now, took: None, again: 0 });
    }

    /// The last request is sent once more. Says whether that may change the board.
    pub(super) fn asked_again(&mut self) -> bool {
        self.0.front_mut().is_some_and(|asked| {
            asked.again += 1;
            asked.changes
        })
    }

    /// Takes a packet; returns what it tells when it is no row, and not the first answer to a request.
    pub(super) fn answered(&mut self, packet: &Packet<'_>, now: Duration) -> Option<Stray> {
        let kind = Kind::from_code(packet.header.kind);
        if kind == Some(Kind::RowOut) {
            return None;
        }
        let known = self.0.iter_mut().find(|asked| asked.sequence == packet.header.sequence);
        let Some(asked) = known else {
            // A row may be refused.
            let changed = kind.is_some_and(may_change);
            return (kind != Some(Kind::Refusal)).then_some(Stray { needless: None, changed });
        };
        let Some(took) = asked.took else {
            asked.took = Some(now.saturating_sub(asked.begun));
            return None;
        };
        let needless = (asked.again > 0).then_some(took);
        asked.again = asked.again.saturating_sub(1);
        Some(Stray { needless, changed: asked.changes })
    }
}

fn may_change(kind: Kind) -> bool {
    matches!(
        kind,
        Kind::Reset
            | Kind::TableWrite
            | Kind::Commit
            | Kind::Configure
            | Kind::RowIn
            | Kind::Burst
            | Kind::Expect
    )
}
