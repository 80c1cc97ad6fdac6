//! Compares the packets that a board counts with those sent. This tells a packet that came twice from one that was lost.

use std::mem;

use halfrow_protocol::message::{Request, Status};

use super::answer::status_in;
use super::conversation::Conversation;
use super::deadlines::Step;
use super::sent_requests::Outgoing;
use super::{BoardError, Tally};

/// How often the board is asked at most. A request that had to be repeated is followed by another one, and on a link that holds
/// back every answer each of them is repeated.
const COUNTS: usize = 3;

/// A count of packets that a link which only loses some cannot cause.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Miscount {
    /// What the board counts.
    pub(crate) counted: u64,
    /// The packets sent, without those known to be lost.
    pub(crate) sent: u64,
}

/// What is known of the packets sent since a board's counters were cleared.
#[derive(Default)]
pub(super) struct Counted {
    /// The link's tally at that time.
    pub(super) from: Tally,
    /// Greetings that the board may count although they were sent before that.
    greetings: u64,
    /// Packets that were lost. The board never receives them later.
    lost: u64,
    /// Packets that the board must have received, since an answer came back for each.
    had: u64,
    /// Whether something else reached it meanwhile.
    is_disturbed: bool,
    /// Whether, since the last count, a packet was sent whose answer nobody would miss.
    pub(super) is_blind: bool,
    /// The retries at the last count.
    retries: u64,
    /// The first count in this session which shows that something else reached the board, or that somebody else cleared its
    /// counters.
    pub(super) wrong: Option<Miscount>,
}

impl Counted {
    /// For a session that was just opened with this many greetings.
    pub(super) fn in_new_session(from: Tally, greetings: u64) -> Self {
        let greetings = greetings.saturating_sub(1);
        Self { from, greetings, retries: from.retries, ..Self::default() }
    }

    /// This many more packets are known to have had an effect.
    pub(super) fn note_had(&mut self, packets: u64) {
        self.had += packets;
    }

    /// Takes what a board counted when between `least` and `most` packets had been sent on this link.
    fn take(&mut self, status: &Status, least: u64, most: u64) {
        let counted = u64::from(status.packets);
        let sent = |packets: u64| packets.saturating_sub(self.from.packets_out);
        let (least, most) = (sent(least), sent(most) + self.greetings);
        // Losses only add up. If fewer packets are missing than before, one arrived that was not sent meanwhile.
        let is_possible = counted + self.lost <= most && counted >= self.had;
        if !is_possible {
            self.is_disturbed = true;
            self.wrong.get_or_insert(Miscount { counted, sent: most.saturating_sub(self.lost) });
        }
        self.lost = self.lost.max(least.saturating_sub(counted));
    }

    /// Whether nothing was lost and nothing came twice, by all counts since the counters were cleared.
    pub(super) fn lost_and_doubled_none(&self) -> bool {
        self.lost == 0 && !self.is_disturbed
    }

    pub(super) fn set_back(&mut self, from: Tally) {
        *self = Self { from, wrong: self.wrong, retries: from.retries, ..Self::default() };
    }
}

impl Conversation {
    /// The board's counters, with the requests that were answered since they were cleared: if this one was repeated, more of
    /// them follow, which these counters cannot contain.
    pub(super) fn status(&mut self, step: Step) -> Result<(Status, u64), BoardError> {
        self.counters(false, step)
    }

    /// Clears the board's counters, and returns what they were.
    pub(super) fn clear_counters(&mut self) -> Result<Status, BoardError> {
        self.counters(true, Step::Request).map(|(status, _)| status)
    }

    fn counters(&mut self, clear: bool, step: Step) -> Result<(Status, u64), BoardError> {
        let (retries, cleared) = (self.tally.retries, self.counted.from.answered);
        let status = self.ask_for_status(clear, step)?;
        let answered = self.tally.answered.saturating_sub(cleared);
        if step == Step::Request {
            self.count_after(retries);
        }
        Ok((status, answered))
    }

    fn ask_for_status(&mut self, clear: bool, step: Step) -> Result<Status, BoardError> {
        let (sent, retries) = (self.tally.packets_out, self.tally.retries);
        let asking = Request::Status { clear };
        let status = status_in(&self.ask(&Outgoing::Request(&asking), step, |_| true)?)?;
        let retried = self.tally.retries > retries;
        // If the request that clears was repeated, the second copy returns counters that are already cleared.
        if self.counts && !(clear && retried) {
            self.take_count(&status, sent + 1);
        }
        if clear {
            self.counted.set_back(self.tally);
        }
        Ok(status)
    }

    /// Takes a count that the board made after at least `least` packets had been sent. If none can have been lost unnoticed since
    /// the count before, and as many arrived as were sent, then a request that was answered twice came once.
    fn take_count(&mut self, status: &Status, least: u64) {
        let (was_blind, lost) = (self.counted.is_blind, self.counted.lost);
        let is_calm = self.tally.retries == self.counted.retries;
        self.counted.take(status, least, self.tally.packets_out);
        let came_once = is_calm && !was_blind && self.counted.lost == lost && self.counted.wrong.is_none();
        let doubled = mem::take(&mut self.session.doubled_changes);
        self.session.repeated_changes += if came_once { 0 } else { doubled };
        (self.counted.is_blind, self.counted.retries) = (false, self.tally.retries);
    }

    /// Asks for a count if something was answered twice.
    pub(super) fn count_doubled(&mut self) {
        if self.session.doubled_changes > 0 {
            self.count();
        }
    }

    /// The same after a board has answered twice, so that a second answer which is still under way is settled too.
    pub(super) fn count_second_answers(&mut self) {
        if self.session.second_answers > 0 {
            self.count();
        }
    }

    /// Asks how many packets reached the board, where one may have been lost and nobody would ask for it again. A failure is
    /// ignored: whatever keeps this answer away keeps the next one away too, and must not hide what came before.
    pub(super) fn count(&mut self) {
        let most = if self.counts { COUNTS } else { 0 };
        for _ in 0..most {
            let retries = self.tally.retries;
            if let Err(error) = self.ask_for_status(false, Step::Request) {
                tracing::debug!("the board does not count: {error}");
                return;
            }
            if self.tally.retries == retries {
                return;
            }
        }
    }

    /// The same if something was repeated since there were `retries`: a loss that is known by then cannot hide a later copy.
    pub(super) fn count_after(&mut self, retries: u64) {
        if self.tally.retries > retries {
            self.count();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The verdict on a board that gives one STATUS after the other: in each pair the packets that it counts, and those sent.
    fn wrong(said: &[(u32, u64)]) -> Option<Miscount> {
        let mut counted = Counted::default();
        for &(packets, sent) in said {
            counted.take(&Status { packets, ..Status::default() }, sent, sent);
        }
        counted.wrong
    }

    #[test]
    fn packets_that_are_lost_are_no_doubt_and_one_that_comes_twice_is_one() {
        assert_eq!(wrong(&[(5, 5), (8, 9), (20, 22), (30, 32)]), None);
        assert_eq!(wrong(&[(6, 5)]), Some(Miscount { counted: 6, sent: 5 }));
        // One lost, and then another one doubled: the totals are equal.
        assert_eq!(wrong(&[(8, 9), (20, 20)]), Some(Miscount { counted: 20, sent: 19 }));
        // The first finding stays.
        assert_eq!(wrong(&[(6, 5), (8, 9)]), Some(Miscount { counted: 6, sent: 5 }));
    }

    /// The answer may be to the first of two requests, while the second one is still under way.
    #[test]
    fn a_request_that_is_under_way_is_not_lost() {
        let mut counted = Counted::default();
        counted.take(&Status { packets: 5, ..Status::default() }, 5, 6);
        counted.take(&Status { packets: 7, ..Status::default() }, 7, 7);
        assert_eq!(counted.wrong, None);
    }

    #[test]
    fn a_board_that_counts_fewer_packets_than_it_answered_was_set_back() {
        let mut counted = Counted::default();
        counted.note_had(4);
        counted.take(&Status { packets: 4, ..Status::default() }, 9, 9);
        assert_eq!(counted.wrong, None);
        counted.note_had(1);
        counted.take(&Status { packets: 4, ..Status::default() }, 10, 10);
        assert_eq!(counted.wrong, Some(Miscount { counted: 4, sent: 5 }));
    }

    /// A repeated greeting is counted in the session that the first one opened.
    #[test]
    fn a_greeting_that_came_twice_is_no_doubt() {
        let mut counted = Counted::in_new_session(Tally { packets_out: 2, ..Tally::default() }, 2);
        counted.take(&Status { packets: 2, ..Status::default() }, 3, 3);
        assert_eq!(counted.wrong, None);
    }
}
