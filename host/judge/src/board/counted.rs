//! The packets that a board counts beside those that were sent: by that one that came twice is told from one that was lost.

use std::mem;

use halfrow_protocol::message::{Reply, Request, Status};

use super::conversation::Conversation;
use super::deadlines::Step;
use super::{BoardError, Tally};

/// How often the board is asked once more since the request before was sent twice: over a link that holds every answer back each is.
const COUNTS: usize = 3;

/// A count of packets that no link brings about which only loses some.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Miscount {
    /// What the board counts.
    pub(crate) counted: u64,
    /// The packets that were sent, without those that were known to be lost.
    pub(crate) sent: u64,
}

/// What is known of the packets that were sent since a board's counters were set back.
#[derive(Default)]
pub(super) struct Counted {
    /// What the link had done by then.
    pub(super) from: Tally,
    /// Greetings that may be counted although they were sent before.
    greetings: u64,
    /// Packets that were lost. The board never has them later.
    lost: u64,
    /// Packets that the board had, since something came back for each.
    had: u64,
    /// Whether something else came to it meanwhile.
    is_disturbed: bool,
    /// Whether a packet was sent since the last count of which nobody would miss the answer.
    pub(super) is_blind: bool,
    /// What had been sent again at the last count.
    retries: u64,
    /// The first count in this session that shows that something else came to the board, or that somebody else set it back.
    pub(super) wrong: Option<Miscount>,
}

impl Counted {
    /// In a session that was just opened by so many packets.
    pub(super) fn in_new_session(from: Tally, greetings: u64) -> Self {
        let greetings = greetings.saturating_sub(1);
        Self { from, greetings, retries: from.retries, ..Self::default() }
    }

    /// So many packets more had an effect.
    pub(super) fn came(&mut self, packets: u64) {
        self.had += packets;
    }

    /// Takes what a board counts that had `least` to `most` packets sent to it, on this link.
    fn take(&mut self, status: &Status, least: u64, most: u64) {
        let counted = u64::from(status.packets);
        let sent = |packets: u64| packets.saturating_sub(self.from.packets_out);
        let (least, most) = (sent(least), sent(most) + self.greetings);
        // Losses only add up: where fewer packets are missing than before, one came that was not sent meanwhile.
        let is_possible = counted + self.lost <= most && counted >= self.had;
        if !is_possible {
            self.is_disturbed = true;
            self.wrong.get_or_insert(Miscount { counted, sent: most.saturating_sub(self.lost) });
        }
        self.lost = self.lost.max(least.saturating_sub(counted));
    }

    /// Whether nothing was lost and nothing came twice, by all counts since they were set back.
    pub(super) fn is_calm(&self) -> bool {
        self.lost == 0 && !self.is_disturbed
    }

    pub(super) fn set_back(&mut self, from: Tally) {
        *self = Self { from, wrong: self.wrong, retries: from.retries, ..Self::default() };
    }
}

impl Conversation {
    /// The board's counters, which `clear` sets back.
    pub(super) fn status(&mut self, clear: bool, step: Step) -> Result<Status, BoardError> {
        let retries = self.tally.retries;
        let status = self.ask_for_status(clear, step)?;
        if step == Step::Request {
            self.count_behind(retries);
        }
        Ok(status)
    }

    fn ask_for_status(&mut self, clear: bool, step: Step) -> Result<Status, BoardError> {
        let (sent, retries) = (self.tally.packets_out, self.tally.retries);
        let status = self.request(&Request::Status { clear }, step, |reply| match reply {
            Reply::Status(status) => Some(status),
            _ => None,
        })?;
        let retried = self.tally.retries > retries;
        // What is set back twice counts little at the second time.
        if self.counts && !(clear && retried) {
            self.take_count(&status, sent + 1);
        }
        if clear {
            self.counted.set_back(self.tally);
        }
        Ok(status)
    }

    /// Takes what a board counts that had `least` packets sent to it or more. Where none can have been lost unseen since the count
    /// before, and as many came as were sent, what was answered twice came once.
    fn take_count(&mut self, status: &Status, least: u64) {
        let (was_blind, lost) = (self.counted.is_blind, self.counted.lost);
        let is_calm = self.tally.retries == self.counted.retries;
        self.counted.take(status, least, self.tally.packets_out);
        let came_once = is_calm && !was_blind && self.counted.lost == lost && self.counted.wrong.is_none();
        let doubled = mem::take(&mut self.session.doubled_changes);
        self.session.repeated_changes += if came_once { 0 } else { doubled };
        (self.counted.is_blind, self.counted.retries) = (false, self.tally.retries);
    }

    /// Asks for a count where something was answered twice.
    pub(super) fn count_doubled(&mut self) {
        if self.session.doubled_changes > 0 {
            self.count();
        }
    }

    /// The same behind a board that answers twice, so that a second answer that is still under way is settled as well.
    pub(super) fn count_second_answers(&mut self) {
        if self.session.second_answers > 0 {
            self.count();
        }
    }

    /// Asks how many packets came to the board, where one may have been lost and nobody would ask for it again. Whatever keeps
    /// the answer away keeps the next one away as well, and must not stand in front of what came before.
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

    /// The same if something was asked again behind so many `retries`: a loss that is known by then hides no copy that comes later.
    pub(super) fn count_behind(&mut self, retries: u64) {
        if self.tally.retries > retries {
            self.count();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is thought of a board that says so in one STATUS after the other: the packets that it counts, of so many that
    /// were sent.
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
        // One lost, and then another one twice: as many as were sent.
        assert_eq!(wrong(&[(8, 9), (20, 20)]), Some(Miscount { counted: 20, sent: 19 }));
        // What was seen once stays.
        assert_eq!(wrong(&[(6, 5), (8, 9)]), Some(Miscount { counted: 6, sent: 5 }));
    }

    /// The answer may be that to the first of two requests, and then the second one is still under way.
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
        counted.came(4);
        counted.take(&Status { packets: 4, ..Status::default() }, 9, 9);
        assert_eq!(counted.wrong, None);
        counted.came(1);
        counted.take(&Status { packets: 4, ..Status::default() }, 10, 10);
        assert_eq!(counted.wrong, Some(Miscount { counted: 4, sent: 5 }));
    }

    /// A greeting that was asked again is counted in the session that the first one opened.
    #[test]
    fn a_greeting_that_came_twice_is_no_doubt() {
        let mut counted = Counted::in_new_session(Tally { packets_out: 2, ..Tally::default() }, 2);
        counted.take(&Status { packets: 2, ..Status::default() }, 3, 3);
        assert_eq!(counted.wrong, None);
    }
}
