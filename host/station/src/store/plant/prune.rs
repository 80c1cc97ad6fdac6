//! Rows of old runs that serve only to be searched: the records have all of their content.

use super::super::database::values;
use super::super::{By, Snapshot, StoreError, statements as sql};
use super::Plant;
use crate::clock::DAY_MS;
use crate::ids;
use crate::progress::{Progress, Told};

/// The name of this act in the audit. A station's own act, which removes evidence, has another one.
const PRUNE: &str = "prune rows";

impl Plant {
    /// Removes the steps and measurements of all runs that began more than so many days ago, by the plant's clock: whoever calls
    /// this may have a wrong one. Calls `told` with the number of rows removed so far; returns that of all. The audit has the
    /// removal before it begins. Runs, records, and all that is counted stay. After an interruption, call it again.
    ///
    /// # Errors
    /// [`StoreError`] when the plant does not take it.
    pub fn prune(&mut self, days: u32, by: By<'_>, told: Told<'_>) -> Result<u64, StoreError> {
        let bound = ids::first_of(self.now_ms()?.saturating_sub(DAY_MS * i64::from(days)));
        self.audited("to be pruned", by.does(PRUNE, &bound), |_| Ok(1))?;
        let (mut after, mut removed) = (String::new(), 0);
        loop {
            let last: Option<String> = self.carry_out("to tell old runs", |database| {
                database.one(sql::NEXT_RUNS, values![&after, &bound], |row| row.get(0))
            })?;
            let Some(last) = last else { return Ok(removed) };
            removed += self.change("to be pruned", |to| {
                let steps = to.execute(sql::PRUNE_STEPS, values![&after, &last])?;
                Ok(steps + to.execute(sql::PRUNE_MEASUREMENTS, values![&after, &last])?)
            })?;
            told(Progress {
                what: "rows removed",
                done: usize::try_from(removed).unwrap_or(usize::MAX),
                of: None,
            });
            after = last;
        }
    }
}

impl Snapshot {
    /// The id below which the steps and measurements of runs may be gone; empty if all are there.
    ///
    /// # Errors
    /// [`StoreError`] when the database cannot be read.
    pub(crate) fn pruned_before(&self) -> Result<String, StoreError> {
        let found =
            self.rows("to tell what was removed", sql::PRUNED_ROWS, values![PRUNE], |row| row.get(0))?;
        Ok(found.into_iter().next().flatten().unwrap_or_default())
    }
}
