//! Does everything once more when a FAIL, or an answer that no sound board gives, may come from a late packet.
//!
//! A link that delivers a copy of an old request after newer ones can leave a sound board with old tables, counters or
//! settings. In a new session, copies from earlier sessions have no effect.

use crate::board::{Board, Miscount};
use crate::progress::Step;
use crate::result::{BrokenOff, CheckName, Doubt, Finding};
use crate::run::findings::{During, End};
use crate::run::frames::counters::{is_contradictory, is_moved_by_links};
use crate::run::frames::observations::Observations;
use crate::run::steps::Run;
use crate::verdict::Cause;

/// How often everything is done again until no request reaches the board twice.
pub(crate) const LOOKS: u32 = 3;
/// How often a board is asked for its counters to see whether it resets them each time.
const COUNTS: usize = 4;

/// What looking again showed.
#[derive(Debug)]
enum Again {
    /// Nothing is wrong.
    Right,
    /// Something is wrong, which says no less than what was found before.
    Wrong(End),
    /// The board gave an answer that no sound board gives, which says less than the FAIL before it.
    SaysLess(End),
    /// The look broke off.
    BrokenOff(End),
}

impl Again {
    /// What a look shows that `ended` after `found` was found.
    fn of(ended: Result<(), End>, found: &End) -> Self {
        match ended {
            Ok(()) => Self::Right,
            Err(again) if again.is_failed() => Self::Wrong(again),
            Err(again) if !again.is_answer() => Self::BrokenOff(again),
            Err(again) if found.is_failed() => Self::SaysLess(again),
            Err(again) => Self::Wrong(again),
        }
    }
}

impl Run<'_> {
    /// Does everything again if an old copy of a request may have caused `found`, with which the run ended.
    pub(crate) fn look_again(&mut self, found: End, seen: &mut Observations) -> End {
        let mut found = found;
        for look in 1..=LOOKS {
            let Some(doubt) = self.doubt_of(&found) else { return found };
            tracing::info!("{}; looking again, since {}", found.finding().sentence(), doubt.clause());
            self.progress.step(Step::LookAgain);
            match Again::of(self.look(look, seen), &found) {
                Again::Right => return right_in_another_session(&found, doubt),
                Again::Wrong(again) => found = again,
                Again::SaysLess(again) if self.doubt_of(&again).is_some() => {}
                Again::SaysLess(end) | Again::BrokenOff(end) => {
                    return broken_off(end, unasked(&found), doubt);
                }
            }
        }
        match self.doubt_of(&found) {
            None => found,
            Some(doubt) => {
                let finding = Finding::WrongOverDoubtfulLink { found: Box::new(unasked(&found)), doubt };
                End::error(found.check(), Cause::Station, finding)
            }
        }
    }

    /// Does everything in another session, the run's `number`th, from 1. A board that goes away before that and comes
    /// back is in a new session anyway.
    fn look(&mut self, number: u32, seen: &mut Observations) -> Result<(), End> {
        if let Err(end) = self.open_session(number) {
            self.come_back(end)?;
        }
        self.findings.begin_again();
        *seen = Observations::default();
        self.all_but_identity(seen).map(drop)
    }

    /// Why the link may have caused `end`. That nothing is known about the link is no reason to doubt an error.
    pub(crate) fn doubt_of(&mut self, end: &End) -> Option<Doubt> {
        if end.is_beyond_links() {
            return None;
        }
        let doubt = self.doubt(end.check())?;
        (end.is_failed() || doubt != Doubt::PacketsUncounted {}).then_some(doubt)
    }

    /// Why `check` may have found something although the board is sound: because it is not in the state that the host put
    /// it into in this session.
    fn doubt(&mut self, check: CheckName) -> Option<Doubt> {
        if let Some(doubt) = self.findings.attempt.doubt.or(Doubt::of_requests(self.board)) {
            return Some(doubt);
        }
        let counts_once_more = self.options.counts && !self.counters_doubted;
        let doubt = Counts::asked_of(self.board).doubt(check == CheckName::Counters, counts_once_more);
        self.counters_doubted |= doubt == Some(Doubt::CountersOfLinks {});
        doubt
    }

    /// Opens the session in which everything is done again, for the `look`th time.
    fn open_session(&mut self, look: u32) -> Result<(), End> {
        self.board.open_another_session(self.sessions.nonce_of(look)).during(CheckName::Link)
    }
}

/// What a board counts of a session, as far as that tells of its link.
#[derive(Clone, Copy, Debug)]
enum Counts {
    /// It does not say: without an answer, whatever prevents it, nothing is known about what the link did before.
    Untold,
    /// No link makes a board count so.
    Impossible,
    /// It counted packets at some time in a way that no loss explains.
    Disturbed(Doubt),
    /// It counts so many packets of those sent. Some of its counters may be `moved` by what only a link can have caused.
    Packets { counted: u64, sent: u64, moved: bool },
}

impl Counts {
    fn asked_of(board: &mut Board) -> Self {
        let Ok(status) = board.status_although_stopped() else { return Self::Untold };
        if is_contradictory(&status) {
            return Self::Impossible;
        }
        match Doubt::of_packets(board) {
            Some(_) if loses_count(board) => Self::Impossible,
            Some(doubt) => Self::Disturbed(doubt),
            None => Self::Packets {
                counted: status.packets.into(),
                sent: board.packets_since_clear(),
                moved: is_moved_by_links(&status),
            },
        }
    }

    /// Why the link may have caused something wrong: wrong counters, if `of_counters`. If only counters are wrong that a link
    /// can change, one more look decides, `once_more`: a board that miscounts will do it again, but a packet will hardly
    /// come twice again.
    fn doubt(self, of_counters: bool, once_more: bool) -> Option<Doubt> {
        match self {
            Self::Untold => Some(Doubt::PacketsUncounted {}),
            Self::Impossible => None,
            Self::Disturbed(doubt) => Some(doubt),
            Self::Packets { counted, sent, .. } if counted > sent || of_counters && counted != sent => {
                Some(Doubt::PacketsMiscounted { counted, sent })
            }
            Self::Packets { moved, .. } => {
                (of_counters && once_more && moved).then_some(Doubt::CountersOfLinks {})
            }
        }
    }
}

/// Whether the board never counts more packets than when it was last asked, although asking is a packet itself. No link
/// delivers a late copy of a request that clears the counters every time.
fn loses_count(board: &mut Board) -> bool {
    let counts: Vec<_> = (0..COUNTS).map_while(|_| board.status().ok()).collect();
    counts.len() == COUNTS && counts.windows(2).all(|two| two[1].packets <= two[0].packets)
}

impl Doubt {
    /// The doubt that the host has about the open session of `board` without asking it.
    pub(crate) fn of_session(board: &Board) -> Option<Self> {
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
pub(crate) fn unasked(end: &End) -> Finding {
    match end.finding().clone() {
        Finding::Problem(problem) => problem.unasked().into(),
        found => found,
    }
}

fn right_in_another_session(found: &End, doubt: Doubt) -> End {
    let finding = Finding::RightInAnotherSession { found: Box::new(unasked(found)), doubt };
    End::error(found.check(), Cause::Station, finding)
}

/// Turns `end`, which broke off a second look, into a finding that also says what the look was to clear up.
pub(crate) fn broken_off(mut end: End, found: Finding, doubt: Doubt) -> End {
    if let End::Error { finding, .. } = &mut end {
        let reason = finding.clone();
        *finding = Finding::SecondLookBrokenOff(Box::new(BrokenOff { found, doubt, reason }));
    }
    end
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use halfrow_protocol::Kind;

    use super::*;
    use crate::board::BoardError;

    const OF_FRAMES: bool = false;
    const OF_COUNTERS: bool = true;

    #[test]
    fn what_a_board_counts_says_whether_its_link_may_be_to_blame() {
        let packets = |counted, moved| Counts::Packets { counted, sent: 9, moved };
        let miscounted = |counted| Some(Doubt::PacketsMiscounted { counted, sent: 9 });
        let of_links = Some(Doubt::CountersOfLinks {});
        for (counts, of_counters, once_more, doubt) in [
            (Counts::Untold, OF_FRAMES, true, Some(Doubt::PacketsUncounted {})),
            (Counts::Impossible, OF_COUNTERS, true, None),
            (Counts::Disturbed(Doubt::AnswerLost {}), OF_FRAMES, false, Some(Doubt::AnswerLost {})),
            // A packet that came twice may have done anything; one that was lost, only change counters.
            (packets(10, false), OF_FRAMES, true, miscounted(10)),
            (packets(8, true), OF_FRAMES, true, None),
            (packets(8, false), OF_COUNTERS, false, miscounted(8)),
            (packets(9, true), OF_FRAMES, true, None),
            (packets(9, false), OF_COUNTERS, true, None),
            (packets(9, true), OF_COUNTERS, true, of_links),
            (packets(9, true), OF_COUNTERS, false, None),
        ] {
            assert_eq!(counts.doubt(of_counters, once_more), doubt, "{counts:?}, {of_counters}, {once_more}");
        }
    }

    #[test]
    fn only_another_fail_replaces_a_fail() {
        let failed = || End::failed(CheckName::Link, Finding::EchoWrong {});
        let answer = || End::board(CheckName::Link, &BoardError::Unexpected { kind: Kind::Echo });
        let gone = || End::board(CheckName::Link, &BoardError::SessionLost { silent: Duration::ZERO });
        let again = |ended, found: End| Again::of(ended, &found);
        assert!(matches!(again(Ok(()), failed()), Again::Right));
        assert!(matches!(again(Err(failed()), failed()), Again::Wrong(_)));
        assert!(matches!(again(Err(failed()), answer()), Again::Wrong(_)));
        assert!(matches!(again(Err(answer()), answer()), Again::Wrong(_)));
        assert!(matches!(again(Err(answer()), failed()), Again::SaysLess(_)));
        assert!(matches!(again(Err(gone()), failed()), Again::BrokenOff(_)));
        assert!(matches!(again(Err(gone()), answer()), Again::BrokenOff(_)));
    }
}
