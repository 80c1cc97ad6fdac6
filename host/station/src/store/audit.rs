//! The audit: what people did, kept whatever came of it.

use std::sync::Arc;

use super::database::{Database, DatabaseError, values};
use super::{Kind, Reason, Store, StoreError, outbox, statements as sql};
use crate::clock;
use crate::ids::{self, NoRandomness};

/// Who does something, and why.
#[derive(Clone, Copy, Debug)]
pub struct By<'a> {
    /// Who.
    pub operator: &'a str,
    /// Why.
    pub reason: &'a Reason,
}

impl<'a> By<'a> {
    /// That they do `act` with `subject`, for their reason.
    pub(super) fn does(self, act: &'a str, subject: &'a str) -> Deed<'a> {
        let Self { operator, reason } = self;
        Deed { operator, act, subject, detail: reason }
    }
}

/// What somebody does, as the audit keeps it.
#[derive(Clone, Copy, Debug)]
pub struct Deed<'a> {
    /// Who does it.
    pub operator: &'a str,
    /// The act.
    pub act: &'a str,
    /// What it is done with.
    pub subject: &'a str,
    /// How, or why.
    pub detail: &'a str,
}

impl<'a> Deed<'a> {
    /// A new line of the audit, which says that this was done at `at_ms`.
    pub(super) fn at(self, at_ms: i64) -> Result<Line<'a>, NoRandomness> {
        Ok(Line { id: ids::new(at_ms)?.to_string(), at_ms, deed: self })
    }
}

/// A line of the audit.
#[derive(Debug)]
pub(super) struct Line<'a> {
    pub(super) id: String,
    pub(super) at_ms: i64,
    pub(super) deed: Deed<'a>,
}

impl Line<'_> {
    /// Enters the line, and an entry of the outbox for every sink.
    pub(super) fn enter(self, to: &mut dyn Database, sinks: &[String]) -> Result<(), DatabaseError> {
        let Self { id, at_ms, deed: Deed { operator, act, subject, detail } } = self;
        to.execute(sql::ADD_AUDIT, values![&id, at_ms, operator, act, subject, detail])?;
        outbox::enter(to, sinks, Kind::Audit, &id)
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
    /// Enters a deed in the audit.
    ///
    /// # Errors
    /// [`StoreError`] when the database does not take it.
    pub fn note(&mut self, deed: Deed<'_>) -> Result<(), StoreError> {
        self.audited("a line of the audit", deed, |_| Ok(1)).map(drop)
    }

    /// Carries out `change`, and enters the deed in the audit if it changed any row. Returns how many rows it changed.
    pub(super) fn audited(
        &mut self,
        doing: &'static str,
        deed: Deed<'_>,
        change: impl FnOnce(&mut dyn Database) -> Result<u64, DatabaseError>,
    ) -> Result<u64, StoreError> {
        let line = deed.at(clock::now_ms())?;
        let sinks = Arc::clone(&self.sinks);
        self.change(doing, |to| line.enter_if_done(to, &sinks, change))
    }
}
