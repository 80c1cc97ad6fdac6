//! What a person does about entries of the outbox. All of it is in the audit.

use super::super::database::{Value, values};
use super::super::{By, Deed, Store, StoreError, statements as sql};

/// The act in the audit.
const RELEASE: &str = "release";

impl Store {
    /// Has every sink where the entry of this id waits for a person try it again; the audit keeps who said so, and why. Returns
    /// how many entries there were.
    ///
    /// # Errors
    /// Like [`Self::sends_to`].
    pub fn release(&mut self, subject: &str, by: By<'_>) -> Result<u64, StoreError> {
        self.released(by.does(RELEASE, subject), sql::OUTBOX_RELEASED, values![subject, ""])
    }

    /// Like [`Self::release`], at this sink alone.
    ///
    /// # Errors
    /// Like [`Self::sends_to`].
    pub(crate) fn release_at(&mut self, sink: &str, subject: &str, by: By<'_>) -> Result<u64, StoreError> {
        let detail = format!("at {sink}: {}", &**by.reason);
        let deed = Deed { detail: &detail, ..by.does(RELEASE, subject) };
        self.released(deed, sql::OUTBOX_RELEASED, values![subject, sink])
    }

    /// Has this sink try again all entries that wait for a person; the audit keeps who said so, and why. Returns how many there
    /// were.
    ///
    /// # Errors
    /// Like [`Self::sends_to`].
    pub(crate) fn release_all(&mut self, sink: &str, by: By<'_>) -> Result<u64, StoreError> {
        self.released(by.does(RELEASE, sink), sql::OUTBOX_ALL_RELEASED, values![sink])
    }

    fn released(&mut self, deed: Deed<'_>, text: &str, of: &[Value<'_>]) -> Result<u64, StoreError> {
        self.audited("what is to be sent again", deed, |to| to.execute(text, of))
    }

    /// Sends nothing more to this sink, and forgets what it has; the audit keeps who said so, and why. Returns how many of its
    /// entries were unsent.
    ///
    /// # Errors
    /// Like [`Self::sends_to`].
    pub(crate) fn forget_sink(&mut self, sink: &str, by: By<'_>) -> Result<u64, StoreError> {
        let mut unsent = 0;
        self.audited("that a sink is no more", by.does("forget-sink", sink), |to| {
            unsent = to.execute(sql::FORGET_UNSENT, values![sink])?;
            Ok(unsent + to.execute(sql::FORGET_SINK, values![sink])?)
        })?;
        Ok(unsent)
    }

    /// Sends everything that was kept to this sink once more, because it has lost what it had; the audit keeps who said so, and
    /// why. Returns how many entries counted as sent.
    ///
    /// # Errors
    /// Like [`Self::sends_to`].
    pub(crate) fn send_again(&mut self, sink: &str, by: By<'_>) -> Result<u64, StoreError> {
        self.audited("that a sink has nothing", by.does("send-again", sink), |to| {
            to.execute(sql::OUTBOX_AGAIN, values![sink])
        })
    }
}
