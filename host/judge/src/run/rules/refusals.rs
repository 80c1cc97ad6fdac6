//! The refusals that came, compared with the board's count of them.

use halfrow_protocol::message::RefusalCode;

use super::Rules;
use super::counts::at_least;
use crate::board::Response;
use crate::result::Counter;
use crate::run::findings::End;

/// How many refusals came.
#[derive(Clone, Copy, Default)]
pub(super) struct Refusals {
    /// Of packets of the open session.
    own: u32,
    /// Of packets of other sessions.
    foreign: u32,
}

impl Refusals {
    /// Counts `said` if it is a refusal.
    pub(super) fn note(&mut self, said: &Response) {
        match said {
            Response::Refused(refusal) if refusal.code == RefusalCode::Session => self.foreign += 1,
            Response::Refused(_) => self.own += 1,
            Response::Replied(_) => {}
        }
    }
}

impl Rules<'_, '_> {
    /// The board must count at least the refusals that came in this session: whatever a link loses or doubles, each was
    /// sent for a request.
    pub(super) fn refusals_counted(&mut self) -> Result<(), End> {
        let after = self.status()?;
        let (Refusals { own, foreign }, before) = (self.refusals, self.before);
        at_least(
            None,
            &after,
            &[
                (Counter::Refusals, before.refusals.saturating_add(own)),
                (Counter::ForeignPackets, before.foreign_packets.saturating_add(foreign)),
            ],
        )
    }
}
