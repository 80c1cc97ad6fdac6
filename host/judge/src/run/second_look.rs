//! Everything once more, when a FAIL may come from a packet that was late.
//!
//! A link that delivers a copy of an old request behind newer ones can leave a sound board with old tables, counters or
//! settings. In a session of its own no copy of an earlier session means anything.

use super::counters::is_contradictory;
use super::findings::{During, End};
use super::steps::Run;
use crate::progress::Step;
use crate::result::{CheckName, Doubt, Finding};
use crate::verdict::Cause;

/// How often it is all done again until no request comes to the board twice.
pub(super) const LOOKS: u32 = 3;
/// Keeps the nonces of these sessions from those of boards that came back.
const NONCE: u32 = 1 << 16;

impl Run<'_> {
    /// Does everything again that ended in `failed`, if an old copy of a request may have brought it about.
    pub(super) fn look_again(&mut self, failed: End) -> Result<(), End> {
        let mut failed = failed;
        for look in 1..=LOOKS {
            let Some(doubt) = self.doubt(failed.check().0) else { return Err(failed) };
            let (_, _, found) = failed.check();
            tracing::warn!("{}; looking again, since {}", found.sentence(), doubt.sentence());
            self.progress.step(Step::LookAgain);
            self.open_session(look)?;
            self.findings.begin_again();
            match self.all_but_identity() {
                Err(again @ End::Failed { .. }) => failed = again,
                Err(error) => return Err(error),
                Ok(()) => {
                    let (check, _, found) = failed.check();
                    let finding = Finding::RightInAnotherSession { found: Box::new(found.clone()), doubt };
                    return Err(End::error(check, Cause::Station, finding));
                }
            }
        }
        match self.doubt(failed.check().0) {
            None => Err(failed),
            Some(doubt) => {
                let (check, _, found) = failed.check();
                let finding = Finding::WrongOverDoubtfulLink { found: Box::new(found.clone()), doubt };
                Err(End::error(check, Cause::Station, finding))
            }
        }
    }

    /// Opens a session in which no copy of an earlier one's requests means anything, `number` of those of the run, from 1.
    pub(super) fn open_session(&mut self, number: u32) -> Result<(), End> {
        let nonce = self.way_back.options.nonce.wrapping_add(NONCE + number);
        self.board.open_another_session(nonce).during(CheckName::Link)
    }

    /// Why the board may not be as the host made it in this session, although it is sound and `check` found something.
    pub(super) fn doubt(&mut self, check: CheckName) -> Option<Doubt> {
        let repeated = self.board.repeated_changes();
        if repeated > 0 {
            return Some(Doubt::RequestsTwice { requests: repeated });
        }
        // Without an answer nothing tells what the link did before, whatever keeps it away.
        let Ok(status) = self.board.status_although_stopped() else {
            return Some(Doubt::PacketsUncounted {});
        };
        if is_contradictory(&status) {
            // Such a board is wrong whatever the link did.
            return None;
        }
        let (counted, sent) = (u64::from(status.packets), self.board.packets_since_clear());
        let counters_alone = check == CheckName::Counters;
        let is_doubtful = counted > sent || counters_alone && counted != sent;
        is_doubtful.then_some(Doubt::PacketsMiscounted { counted, sent })
    }
}
