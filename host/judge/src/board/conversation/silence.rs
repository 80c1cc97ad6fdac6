//! A request that a board leaves unanswered, while it answers others.

use halfrow_protocol::Kind;
use halfrow_protocol::message::{Reply, Request, Status};

use super::Conversation;
use crate::board::BoardError;
use crate::board::answer::take_reply;
use crate::board::deadlines::Step;
use crate::board::received::Had;
use crate::board::sent_requests::Outgoing;

/// What became of the tries of a request that the board leaves unanswered while it answers others.
enum Tries {
    /// Nothing came damaged, and this is what the board counts of a further one.
    Whole(Had),
    /// The board counts each as a damaged packet.
    Damaged,
}

impl Conversation {
    /// The `error` with which asking ended, or, if that is a silence which only this request meets, one that says so.
    pub(super) fn looked_into(&mut self, error: BoardError, asking: &Outgoing<'_>) -> BoardError {
        let BoardError::NoAnswer { kind, attempts, .. } = error else { return error };
        if self.session.number == 0 {
            return error;
        }
        let bytes = asking.payload().len();
        match self.leaves_only(asking, attempts) {
            Ok(Some(Tries::Whole(had))) => BoardError::Unanswered { kind, bytes, attempts, had },
            Ok(Some(Tries::Damaged)) => BoardError::DamagedEachTime { kind, bytes, attempts },
            Err(why @ (BoardError::Stopped(_) | BoardError::Link { .. })) => why,
            Ok(None) | Err(_) => error,
        }
    }

    /// Whether the board answers another request at once, then leaves this one unanswered again, and answers the other one
    /// again. A link that was broken for a while answers all three, one that brings late answers adds strays, and a noisy one,
    /// which keeps long packets from getting through, damages those to the host too. Returns what became of the request, which
    /// was tried `attempts` times before, if it is only this one that the board leaves.
    fn leaves_only(&mut self, asking: &Outgoing<'_>, attempts: u32) -> Result<Option<Tries>, BoardError> {
        let strays = self.tally.strays;
        let before = self.answers_another(asking.kind())?;
        match self.ask_until_answered(asking, Step::Probe, |_| true) {
            Err(BoardError::NoAnswer { .. }) => {}
            Err(other) => return Err(other),
            Ok(_) => return Ok(None),
        }
        let after = self.answers_another(asking.kind())?;
        if self.tally.strays != strays || self.tally.damaged_in > 0 {
            return Ok(None);
        }
        let [first, last] = [before, after].map(|status| status.map_or(0, |status| status.damaged()));
        let is_each_damaged = first >= attempts && last.wrapping_sub(first) == 1;
        Ok(match last {
            0 => Some(Tries::Whole(Had::between(before, after))),
            _ => is_each_damaged.then_some(Tries::Damaged),
        })
    }

    /// Has the board answer another request than one of `kind`: its counters, if these are something else.
    fn answers_another(&mut self, kind: Kind) -> Result<Option<Status>, BoardError> {
        let other = if kind == Kind::Status { Request::Echo(&[]) } else { Request::Status { clear: false } };
        let answer = self.ask_until_answered(&Outgoing::Request(&other), Step::Probe, |_| true)?;
        take_reply(other.kind(), &answer, |reply| match reply {
            Reply::Status(status) => Some(Some(status)),
            Reply::Echo(_) => Some(None),
            _ => None,
        })
    }
}
