//! The audit: what people did, kept whatever came of it.

use std::sync::Arc;

use super::database::{Database, DatabaseError, values};
use super::{Kind, Store, StoreError, outbox, statements as sql};
use crate::clock;
use crate::ids;

/// A line of the audit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line<'a> {
    pub(super) id: &'a str,
    pub(super) at_ms: i64,
    pub(super) operator: &'a str,
    pub(super) act: &'a str,
    pub(super) subject: &'a str,
    pub(super) detail: &'a str,
}

impl Line<'_> {
    /// Enters the line, and an entry of the outbox for every sink.
    pub(super) fn enter(self, to: &mut dyn Database, sinks: &[String]) -> Result<(), DatabaseError> {
        let Self { id, at_ms, operator, act, subject, detail } = self;
        to.execute(sql::ADD_AUDIT, values![id, at_ms, operator, act, subject, detail])?;
        outbox::enter(to, sinks, Kind::Audit, id)
    }

    /// Carries out `change`, and enters the line if it changed any row. Returns how many rows it changed.
    pub(super) fn enter_if_done(
        self,
        to: &mut dyn Database,
        sinks: &[String],
        change: impl FnOnce(&mut dyn Database) -> Result<u64, DatabaseError>,
    ) -> Result<u64, DatabaseError> {
        let changed = change(to)?;
        if changed > 0 {
            self.enter(to, sinks)?;
        }
        Ok(changed)
    }
}

impl Store {
    /// Enters in the audit that `operator` does `act` with `subject`; `detail` says how.
    ///
    /// # Errors
    /// [`StoreError`] when the database does not take it.
    pub fn note(&mut self, operator: &str, act: &str, subject: &str, detail: &str) -> Result<(), StoreError> {
        self.audited("a line of the audit", [operator, act, subject, detail], |_| Ok(1)).map(drop)
    }

    /// Carries out `change`, and enters it in the audit if it changed any row. Returns how many rows it changed.
    pub(super) fn audited(
        &mut self,
        doing: &'static str,
        [operator, act, subject, detail]: [&str; 4],
        change: impl FnOnce(&mut dyn Database) -> Result<u64, DatabaseError>,
    ) -> Result<u64, StoreError> {
        let at_ms = clock::now_ms();
        let id = ids::new(at_ms)?.to_string();
        let sinks = Arc::clone(&self.sinks);
        let line = Line { id: &id, at_ms, operator, act, subject, detail };
        self.change(doing, |to| line.enter_if_done(to, &sinks, change))
    }
}
