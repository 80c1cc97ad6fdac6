//! Does everything once more when a FAIL, or an answer that no sound board gives, may come from a late packet.
//!
//! A link that delivers a copy of an old request after newer ones can leave a sound board with old tables, counters or
//! settings. In a new session, copies from earlier sessions have no effect.

use super::counters::{is_contradictory, is_moved_by_links};
use super::findings::{During, End};
use super::steps::Run;
use crate::board::{Board, Miscount};
use crate::progress::Step;
use crate::result::{BrokenOff, CheckName, Doubt, Finding};
use crate::verdict::Cause;

/// How often everything is done again until no request reaches the board twice.
pub(super) const LOOKS: u32 = 3;
/// How often a board is asked for its counters to see whether it resets them each time.
const COUNTS: usize = 4;
/// Keeps the nonces of these sessions apart from those of boards that came back.
const NONCE: u32 = 1 << 16;

impl Run<'_> {
    /// Does everything again if an old copy of a request may have caused `found`, with which the run ended.
    pub(super) fn look_again(&mut self, found: End) -> Result<(), End> {
        let mut found = found;
        for look in 1..=LOOKS {
            let Some(doubt) = self.doubt_of(&found) else { return Err(found) };
            tracing::info!("{}; looking again, since {}", found.finding().sentence(), doubt.clause());
            self.progress.step(Step::LookAgain);
            match self.look(look) {
                Ok(()) => return Err(right_in_another_session(&found, doubt)),
                // A FAIL says more than an answer that no sound board gives, so only another FAIL replaces it.
                Err(again) if again.is_failed() || again.is_answer() && !found.is_failed() => found = again,
                Err(again) if again.is_answer() && self.doubt_of(&again).is_some() => {}
                Err(again) => return Err(broken_off(again, unasked(&found), doubt)),
            }
        }
        match self.doubt_of(&found) {
            None => Err(found),
            Some(doubt) => {
                let finding = Finding::WrongOverDoubtfulLink { found: Box::new(unasked(&found)), doubt };
                Err(End::error(found.name(), Cause::Station, finding))
            }
        }
    }

    /// Does everything in another session, the run's `number`th, from 1. A board that goes away before that and comes
    /// back is in a new session anyway.
    fn look(&mut self, number: u32) -> Result<(), End> {
        if let Err(end) = self.open_session(number) {
            self.come_back(end)?;
        }
        self.findings.begin_again();
        self.all_but_identity()
    }

    /// Why the link may have caused `end`. That nothing is known about the link is no reason to doubt an error.
    pub(super) fn doubt_of(&mut self, end: &End) -> Option<Doubt> {
        let doubt = self.doubt(end.name())?;
        (end.is_failed() || doubt != Doubt::PacketsUncounted {}).then_some(doubt)
    }

    /// Opens a session in which copies of earlier sessions' requests have no effect: the run's `number`th, from 1.
    pub(super) fn open_session(&mut self, number: u32) -> Result<(), End> {
        let nonce = self.nonce(number);
        self.board.open_another_session(nonce).during(CheckName::Link)
    }

    fn nonce(&self, number: u32) -> u32 {
        self.opener.options.nonce.wrapping_add(NONCE + number)
    }

    /// The nonce of a further session within the same look.
    pub(super) fn next_nonce(&mut self) -> u32 {
        self.sessions += 1;
        self.nonce(LOOKS + self.sessions)
    }

    /// Why `check` may have found something although the board is sound: because it is not in the state that the host put
    /// it into in this session.
    pub(super) fn doubt(&mut self, check: CheckName) -> Option<Doubt> {
        if self.findings.look.beyond_links {
            return None;
        }
        if let Some(doubt) = self.findings.look.doubt.or(Doubt::of_requests(self.board)) {
            return Some(doubt);
        }
        // Without an answer, whatever prevents it, nothing is known about what the link did before.
        let Ok(status) = self.board.status_although_stopped() else {
            return Some(Doubt::PacketsUncounted {});
        };
        if is_contradictory(&status) {
            // Such a board is wrong, whatever the link did.
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
        // One more look decides: a board that miscounts will do it again, but a packet will hardly come twice again.
        let is_new = counters_alone && self.options.counts && !self.findings.counters_doubted;
        self.findings.counters_doubted |= counters_alone;
        (is_new && is_moved_by_links(&status)).then_some(Doubt::CountersOfLinks {})
    }
}

impl Run<'_> {
    /// Whether the board never counts more packets than when it was last asked, although asking is a packet itself. No
    /// link delivers a late copy of a request that clears the counters every time.
    fn loses_count(&mut self) -> bool {
        let counts: Vec<_> = (0..COUNTS).map_while(|_| self.board.status(false).ok()).collect();
        counts.len() == COUNTS && counts.windows(2).all(|two| two[1].packets <= two[0].packets)
    }
}

impl Doubt {
    /// The doubt that the host has about the open session of `board` without asking it.
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

/// What `end` found. From a problem the advice is removed, because it holds only for a board that no link disturbs.
pub(super) fn unasked(end: &End) -> Finding {
    match end.finding().clone() {
        Finding::Problem(problem) => problem.unasked().into(),
        found => found,
    }
}

fn right_in_another_session(found: &End, doubt: Doubt) -> End {
    let finding = Finding::RightInAnotherSession { found: Box::new(unasked(found)), doubt };
    End::error(found.name(), Cause::Station, finding)
}

/// Turns `end`, which broke off a second look, into a finding that also says what the look was to clear up.
pub(super) fn broken_off(mut end: End, found: Finding, doubt: Doubt) -> End {
    if let End::Error { finding, .. } = &mut end {
        let reason = finding.clone();
        *finding = Finding::SecondLookBrokenOff(Box::new(BrokenOff { found, doubt, reason }));
    }
    end
}
