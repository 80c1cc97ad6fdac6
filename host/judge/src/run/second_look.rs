//! Everything once more, when a FAIL, or an answer that no sound board gives, may come from a packet that was late.
//!
//! A link that delivers a copy of an old request behind newer ones can leave a sound board with old tables, counters or
//! settings. In a session of its own no copy of an earlier session means anything.

use super::counters::{is_contradictory, is_moved_by_links};
use super::findings::{During, End};
use super::steps::Run;
use crate::board::{Board, Miscount};
use crate::progress::Step;
use crate::result::{BrokenOff, CheckName, Doubt, Finding};
use crate::verdict::Cause;

/// How often it is all done again until no request comes to the board twice.
pub(super) const LOOKS: u32 = 3;
/// How often a board is asked that may set its counters back whenever it is.
const COUNTS: usize = 4;
/// Keeps the nonces of these sessions from those of boards that came back.
const NONCE: u32 = 1 << 16;

impl Run<'_> {
    /// Does everything again that ended in `found`, if an old copy of a request may have brought it about.
    pub(super) fn look_again(&mut self, found: End) -> Result<(), End> {
        let mut found = found;
        for look in 1..=LOOKS {
            let Some(doubt) = self.doubt_of(&found) else { return Err(found) };
            tracing::warn!("{}; looking again, since {}", found.check().2.sentence(), doubt.sentence());
            self.progress.step(Step::LookAgain);
            match self.look(look) {
                Ok(()) => return Err(right_in_another_session(&found, doubt)),
                // An answer that no sound board gives says less than what was found wrong.
                Err(again) if again.is_failed() || again.is_answer() && !found.is_failed() => found = again,
                Err(again) if again.is_answer() && self.doubt_of(&again).is_some() => {}
                Err(again) => return Err(broken_off(again, unasked(&found), doubt)),
            }
        }
        match self.doubt_of(&found) {
            None => Err(found),
            Some(doubt) => {
                let finding = Finding::WrongOverDoubtfulLink { found: Box::new(unasked(&found)), doubt };
                Err(End::error(found.check().0, Cause::Station, finding))
            }
        }
    }

    /// Does everything in another session, `number` of those of the run, from 1. A board that goes away in front of it and comes back
    /// is in one.
    fn look(&mut self, number: u32) -> Result<(), End> {
        if let Err(end) = self.open_session(number) {
            self.come_back(end)?;
        }
        self.findings.begin_again();
        self.all_but_identity()
    }

    /// Why what ended the run may come from the link. That nothing is known of the link is no reason to doubt an error.
    pub(super) fn doubt_of(&mut self, end: &End) -> Option<Doubt> {
        let doubt = self.doubt(end.check().0)?;
        (end.is_failed() || doubt != Doubt::PacketsUncounted {}).then_some(doubt)
    }

    /// Opens a session in which no copy of an earlier one's requests means anything, `number` of those of the run, from 1.
    pub(super) fn open_session(&mut self, number: u32) -> Result<(), End> {
        let nonce = self.nonce(number);
        self.board.open_another_session(nonce).during(CheckName::Link)
    }

    fn nonce(&self, number: u32) -> u32 {
        self.way_back.options.nonce.wrapping_add(NONCE + number)
    }

    /// The nonce of one more session that is opened for its own sake.
    pub(super) fn next_nonce(&mut self) -> u32 {
        self.sessions += 1;
        self.nonce(LOOKS + self.sessions)
    }

    /// Why the board may not be as the host made it in this session, although it is sound and `check` found something.
    pub(super) fn doubt(&mut self, check: CheckName) -> Option<Doubt> {
        if self.findings.look.beyond_links {
            return None;
        }
        if let Some(doubt) = self.findings.look.doubt.or(Doubt::of_requests(self.board)) {
            return Some(doubt);
        }
        // Without an answer nothing tells what the link did before, whatever keeps it away.
        let Ok(status) = self.board.status_although_stopped() else {
            return Some(Doubt::PacketsUncounted {});
        };
        if is_contradictory(&status) {
            // Such a board is wrong whatever the link did.
            return None;
        }
        if let Some(doubt) = Doubt::of_packets(self.board) {
            return (!self.loses_count()).then_some(doubt);
        }
        let (counted, sent) = (u64::from(status.packets), self.board.packets_since_clear());
        let counters_alone = check == CheckName::Counters;
        if counted > sent || counters_alone && counted != sent {
            return Some(Doubt::PacketsMiscounted { counted, sent });
        }
        // A board that miscounts does so again, and a packet that came twice does not come again.
        let is_new = counters_alone && self.options.counts && !self.findings.counters_doubted;
        self.findings.counters_doubted |= counters_alone;
        (is_new && is_moved_by_links(&status)).then_some(Doubt::CountersOfLinks {})
    }
}

impl Run<'_> {
    /// Whether the board never counts more packets than when it was last asked, although that was one: no link has a late copy of
    /// a request that clears the counters at hand each time.
    fn loses_count(&mut self) -> bool {
        let counts: Vec<_> = (0..COUNTS).map_while(|_| self.board.status(false).ok()).collect();
        counts.len() == COUNTS && counts.windows(2).all(|two| two[1].packets <= two[0].packets)
    }
}

impl Doubt {
    /// What the host knows of the open session of `board` without asking it.
    pub(super) fn of_session(board: &Board) -> Option<Self> {
        Self::of_requests(board).or(Self::of_packets(board))
    }

    fn of_requests(board: &Board) -> Option<Self> {
        let requests = board.repeated_changes();
        (requests > 0).then_some(Self::RequestsTwice { requests })
    }

    fn of_packets(board: &Board) -> Option<Self> {
        let Miscount { counted, sent } = board.miscounted()?;
        Some(Self::PacketsMiscounted { counted, sent })
    }
}

/// What `end` found, without what it asks for where that is of a board that no link disturbs.
pub(super) fn unasked(end: &End) -> Finding {
    match end.check().2.clone() {
        Finding::Problem(problem) => problem.unasked().into(),
        found => found,
    }
}

fn right_in_another_session(found: &End, doubt: Doubt) -> End {
    let finding = Finding::RightInAnotherSession { found: Box::new(unasked(found)), doubt };
    End::error(found.check().0, Cause::Station, finding)
}

/// What kept a second look from its end, behind what it was to clear up.
pub(super) fn broken_off(mut end: End, found: Finding, doubt: Doubt) -> End {
    if let End::Error { finding, .. } = &mut end {
        let reason = finding.clone();
        *finding = Finding::SecondLookBrokenOff(Box::new(BrokenOff { found, doubt, reason }));
    }
    end
}
