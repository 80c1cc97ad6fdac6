//! What a board counts, and what the host counts for comparison.

use halfrow_protocol::Kind;
use halfrow_protocol::message::{ResetLevel, Status};

use super::answer::status_in;
use super::counted::Miscount;
use super::deadlines::Step;
use super::sent_requests::Outgoing;
use super::{Board, BoardError};

impl Board {
    /// The board's counters.
    ///
    /// # Errors
    /// [`BoardError`] when no answer comes.
    pub fn status(&mut self) -> Result<Status, BoardError> {
        self.status_and_answered().map(|(status, _)| status)
    }

    /// Clears the board's counters, and returns what they were.
    ///
    /// # Errors
    /// [`BoardError`] when no answer comes.
    pub(crate) fn clear_counters(&mut self) -> Result<Status, BoardError> {
        self.conversation.clear_counters()
    }

    /// The board's counters, and the requests that were answered until they came, this one included, since they were cleared.
    ///
    /// # Errors
    /// [`BoardError`] when no answer comes.
    pub(crate) fn status_and_answered(&mut self) -> Result<(Status, u64), BoardError> {
        self.conversation.status(Step::Request)
    }

    /// Has the board clear its counters by `clear`, any number but 0, and returns what they were; none if it refuses.
    ///
    /// # Errors
    /// [`BoardError`] when no answer comes.
    pub(crate) fn clear_by(&mut self, clear: u8) -> Result<Option<Status>, BoardError> {
        // Counts what came before it is forgotten.
        self.status()?;
        let request = Outgoing::Bytes(Kind::Status, &[clear]);
        let answer = self.conversation.ask(&request, Step::Request, |_| true)?;
        self.conversation.counted.set_back(self.conversation.tally);
        match status_in(&answer) {
            Err(BoardError::Refused { .. }) => Ok(None),
            told => told.map(Some),
        }
    }

    /// The board's counters, even if the run was stopped. Then the wait is as short as at the end of a session.
    ///
    /// # Errors
    /// [`BoardError`] when no answer comes.
    pub(crate) fn status_although_stopped(&mut self) -> Result<Status, BoardError> {
        match self.status() {
            Err(BoardError::Stopped(_) | BoardError::Timeout { .. }) => {
                let told = self.conversation.disregarding_stop(|told| told.status(Step::Close));
                told.map(|(status, _)| status)
            }
            status => status,
        }
    }

    /// The packets sent since the board's counters were cleared, counting every try.
    #[must_use]
    pub(crate) fn packets_since_clear(&self) -> u64 {
        self.tally().packets_out.saturating_sub(self.conversation.counted.from.packets_out)
    }

    /// Whether every packet sent since the board's counters were cleared reached it whole, and once.
    #[must_use]
    pub(crate) fn had_each_packet_once(&self, status: &Status) -> bool {
        u64::from(status.packets) == self.packets_since_clear()
            && self.conversation.counted.lost_and_doubled_none()
    }

    /// Whether no packet was repeated since the board's counters were cleared.
    #[must_use]
    pub(crate) fn sent_nothing_again(&self) -> bool {
        self.tally().retries == self.conversation.counted.from.retries
    }

    /// The first count of packets in this session that a link which only loses some cannot cause.
    #[must_use]
    pub(crate) fn miscounted(&self) -> Option<Miscount> {
        self.conversation.counted.wrong
    }

    /// Clears the counters, and drops tables that an earlier session left. A board takes a COMMIT of the active generation for a
    /// repeated packet, and would go on using the old tables under it. Returns whether there were any.
    ///
    /// # Errors
    /// [`BoardError`] when no answer comes.
    pub(crate) fn start_afresh(&mut self) -> Result<bool, BoardError> {
        let had_tables = self.clear_counters()?.generation != 0;
        if had_tables {
            self.reset(ResetLevel::Tables, Step::Request)?;
        }
        Ok(had_tables)
    }

    /// A lower bound on the ROW_OUT packets that the board has sent in this session, by its own numbering.
    #[must_use]
    pub(crate) fn packets_numbered(&self) -> u32 {
        self.conversation.session.conduct.packets_numbered()
    }
}
