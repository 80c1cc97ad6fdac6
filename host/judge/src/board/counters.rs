//! What a board counts, and what the host counts beside it.

use halfrow_protocol::Kind;
use halfrow_protocol::message::{ResetLevel, Status};

use super::counted::Miscount;
use super::deadlines::Step;
use super::said::Said;
use super::{Board, BoardError};

impl Board {
    /// The board's counters, which `clear` sets back.
    ///
    /// # Errors
    /// [`BoardError`] when no answer comes.
    pub fn status(&mut self, clear: bool) -> Result<Status, BoardError> {
        self.conversation.status(clear, Step::Request)
    }

    /// Has the board set its counters back by `clear`, any number but 0, and returns what it says.
    ///
    /// # Errors
    /// [`BoardError`] when no answer comes.
    pub(crate) fn clear_by(&mut self, clear: u8) -> Result<Said, BoardError> {
        // What came before is counted before it is forgotten.
        self.status(false)?;
        let said = self.ask(Kind::Status, &[clear])?;
        self.conversation.counted.set_back(self.conversation.tally);
        Ok(said)
    }

    /// The board's counters, although the run was stopped: then they are waited for as the end of a session is.
    ///
    /// # Errors
    /// [`BoardError`] when no answer comes.
    pub(crate) fn status_although_stopped(&mut self) -> Result<Status, BoardError> {
        match self.status(false) {
            Err(BoardError::Stopped(_) | BoardError::Timeout { .. }) => {
                self.conversation.disregarding_stop(|conversation| conversation.status(false, Step::Close))
            }
            status => status,
        }
    }

    /// The packets that were sent since the board's counters were set back, all tries counted.
    #[must_use]
    pub(crate) fn packets_since_clear(&self) -> u64 {
        self.tally().packets_out.saturating_sub(self.conversation.counted.from.packets_out)
    }

    /// The requests that were answered since the board's counters were set back.
    #[must_use]
    pub(crate) fn answered_since_clear(&self) -> u64 {
        self.tally().answered.saturating_sub(self.conversation.counted.from.answered)
    }

    /// Whether every packet that was sent since the board's counters were set back came to it whole, and once.
    #[must_use]
    pub(crate) fn had_each_packet_once(&self, status: &Status) -> bool {
        u64::from(status.packets) == self.packets_since_clear() && self.conversation.counted.is_calm()
    }

    /// Whether no packet was sent once more since the board's counters were set back.
    #[must_use]
    pub(crate) fn sent_nothing_again(&self) -> bool {
        self.tally().retries == self.conversation.counted.from.retries
    }

    /// The first count of packets in this session that no link brings about which only loses some.
    #[must_use]
    pub(crate) fn miscounted(&self) -> Option<Miscount> {
        self.conversation.counted.wrong
    }

    /// Sets the counters back, and drops tables that an earlier session left: a board takes a generation that is active
    /// already for a repeated packet, and would go on using the old tables under it. Says whether there were any.
    ///
    /// # Errors
    /// [`BoardError`] when no answer comes.
    pub(crate) fn start_afresh(&mut self) -> Result<bool, BoardError> {
        let had_tables = self.status(true)?.generation != 0;
        if had_tables {
            self.reset(ResetLevel::Tables, Step::Request)?;
        }
        Ok(had_tables)
    }

    /// The fewest ROW_OUT packets that the board has sent in this session, by its own numbers.
    #[must_use]
    pub(crate) fn packets_numbered(&self) -> u32 {
        self.conversation.session.conduct.packets_numbered()
    }
}
