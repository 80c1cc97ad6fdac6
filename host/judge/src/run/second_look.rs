//! Everything once more, when a FAIL may come from a packet that was late.
//!
//! A link that delivers a copy of an old request behind newer ones can leave a sound board with old tables, counters or
//! settings. In a session of its own no copy of an earlier session means anything.

use super::findings::End;
use super::judge::Seen;
use super::steps::Run;
use crate::board::OpenOptions;
use crate::progress::Step;
use crate::result::{CheckName, Doubt, Finding};
use crate::verdict::Cause;

/// How often it is all done again until no request comes to the board twice.
const LOOKS: u32 = 3;
/// Keeps the nonces of these sessions from those of boards that came back.
const NONCE: u32 = 1 << 16;

impl Run<'_> {
    /// Does everything again that ended in `failed`, if an old copy of a request may have brought it about.
    pub(super) fn look_again(&mut self, failed: End) -> Result<(), End> {
        let mut failed = failed;
        for look in 1..=LOOKS {
            let Some(doubt) = self.doubt(&failed) else { return Err(failed) };
            let (_, _, found) = failed.check();
            tracing::warn!("{}; looking again, since {}", found.sentence(), doubt.sentence());
            self.progress.step(Step::LookAgain);
            let nonce = self.way_back.options.nonce.wrapping_add(NONCE + look);
            let options = OpenOptions { nonce, ..self.way_back.options.clone() };
            self.board.greet_again(&options).map_err(|error| End::board(CheckName::Link, &error))?;
            (self.findings.seen, self.findings.rows_counted) = (Seen::default(), 0);
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
        match self.doubt(&failed) {
            None => Err(failed),
            Some(doubt) => {
                let (check, _, found) = failed.check();
                let finding = Finding::WrongOverDoubtfulLink { found: Box::new(found.clone()), doubt };
                Err(End::error(check, Cause::Station, finding))
            }
        }
    }

    /// Why the board may not be as the host made it in this session, although it is sound.
    fn doubt(&mut self, failed: &End) -> Option<Doubt> {
        let repeated = self.board.repeated_changes();
        if repeated > 0 {
            return Some(Doubt::RequestsTwice { requests: repeated });
        }
        let status = self.board.status(false).ok()?;
        let (counted, sent) = (u64::from(status.packets), self.board.packets_since_clear());
        let counters_alone = failed.check().0 == CheckName::Counters;
        let is_doubtful = counted > sent || counters_alone && counted != sent;
        is_doubtful.then_some(Doubt::PacketsMiscounted { counted, sent })
    }
}
