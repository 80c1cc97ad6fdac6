//! The audit of a plant: what people did there.

use super::super::StoreError;
use super::super::audit::Deed;
use super::super::database::{Database, DatabaseError};
use super::Plant;
use crate::clock;

impl Plant {
    /// Enters a deed in the audit.
    ///
    /// # Errors
    /// [`StoreError`] when the plant does not take it.
    pub(crate) fn note(&mut self, deed: Deed<'_>) -> Result<(), StoreError> {
        self.audited("a line of the audit", deed, |_| Ok(1)).map(drop)
    }

    /// Carries out `change`, and enters the deed in the audit if it changed any row. Returns whether it did. `doing` says what the plant
    /// refuses otherwise.
    pub(super) fn audited(
        &mut self,
        doing: &'static str,
        deed: Deed<'_>,
        change: impl FnOnce(&mut dyn Database) -> Result<u64, DatabaseError>,
    ) -> Result<bool, StoreError> {
        let line = deed.at(clock::now_ms())?;
        self.change(doing, |to| Ok(line.enter_if_done(to, &[], change)? > 0))
    }
}
