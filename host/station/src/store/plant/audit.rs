//! The audit of a plant: what people did there.

use super::super::StoreError;
use super::super::audit::Line;
use super::super::database::{Database, DatabaseError};
use super::Plant;
use crate::clock;
use crate::ids;

impl Plant {
    /// Enters in the audit that `operator` does `act` with `subject`; `detail` says how.
    ///
    /// # Errors
    /// [`StoreError`] when the plant does not take it.
    pub(crate) fn note(
        &mut self,
        operator: &str,
        act: &str,
        subject: &str,
        detail: &str,
    ) -> Result<(), StoreError> {
        self.audited("a line of the audit", operator, act, subject, detail, |_| Ok(1)).map(drop)
    }

    /// Carries out `change`, and enters it in the audit if it changed any row. Returns whether it did. `doing` says what the plant
    /// refuses otherwise.
    pub(super) fn audited(
        &mut self,
        doing: &'static str,
        operator: &str,
        act: &str,
        subject: &str,
        detail: &str,
        change: impl FnOnce(&mut dyn Database) -> Result<u64, DatabaseError>,
    ) -> Result<bool, StoreError> {
        let at_ms = clock::now_ms();
        let id = ids::new(at_ms)?.to_string();
        let line = Line { id: &id, at_ms, operator, act, subject, detail };
        self.carry_out(doing, |database| {
            database.transaction(|to| Ok(line.enter_if_done(to, &[], change)? > 0))
        })
    }
}
