//! Everything once more, when a FAIL may come from a packet that was late.
//!
//! A link that delivers a copy of an old request behind newer ones can leave a sound board with old tables, counters or
//! settings. In a session of its own no copy of an earlier session means anything.

use super::findings::End;
use super::judge::Seen;
use super::steps::Run;
use crate::board::OpenOptions;
use crate::verdict::Exit;

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
            tracing::warn!("{}; looking again, since {doubt}", failed.check().detail);
            self.progress.step("looking again, in a session of its own");
            let nonce = self.way_back.options.nonce.wrapping_add(NONCE + look);
            let options = OpenOptions { nonce, ..self.way_back.options.clone() };
            self.board.greet_again(&options).map_err(|error| End::board("link", &error))?;
            (self.findings.seen, self.findings.rows_counted) = (Seen::default(), 0);
            match self.all_but_identity() {
                Err(again @ End::Failed { .. }) => failed = again,
                Err(error) => return Err(error),
                Ok(()) => {
                    return Err(unclear(
                        &failed,
                        &format!(
                            "that may have come from the link, since {doubt}: done again in a session of its own, everything was right"
                        ),
                    ));
                }
            }
        }
        match self.doubt(&failed) {
            None => Err(failed),
            Some(doubt) => Err(unclear(&failed, &format!("and {doubt}, so that it may come from the link"))),
        }
    }

    /// Why the board may not be as the host made it in this session, although it is sound.
    fn doubt(&mut self, failed: &End) -> Option<String> {
        let repeated = self.board.repeated_changes();
        if repeated > 0 {
            return Some(format!("{repeated} requests that change the board may have come to it twice"));
        }
        let status = self.board.status(false).ok()?;
        let (counted, sent) = (u64::from(status.packets), self.board.packets_since_clear());
        let counters_alone = failed.check().name == "counters";
        let is_doubtful = counted > sent || counters_alone && counted != sent;
        is_doubtful.then(|| format!("the board counts {counted} packets, and {sent} were sent to it"))
    }
}

fn unclear(failed: &End, why: &str) -> End {
    let check = failed.check();
    let headline = format!("{}; {why}; check the link, and run again", check.detail);
    End::error(check.name, Exit::Error, headline)
}
