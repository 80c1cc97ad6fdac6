//! Acts of people, which are kept whatever becomes of them.

use std::sync::Arc;

use super::database::values;
use super::{Kind, Store, StoreError, outbox, statements as sql};
use crate::clock;
use crate::ids;

impl Store {
    /// Enters in the audit that `operator` does `act` with `subject`; `detail` says how.
    ///
    /// # Errors
    /// [`StoreError`] when the database does not take it.
    pub fn note(&mut self, operator: &str, act: &str, subject: &str, detail: &str) -> Result<(), StoreError> {
        let at_ms = clock::now_ms();
        let id = ids::new(at_ms)?.to_string();
        let sinks = Arc::clone(&self.sinks);
        self.change("an audit", |to| {
            to.execute(sql::ADD_AUDIT, values![&id, at_ms, operator, act, subject, detail])?;
            outbox::enter(to, &sinks, Kind::Audit, &id)
        })
    }
}
