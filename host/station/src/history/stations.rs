//! The stations of a plant, as it last heard from them.

use serde::Serialize;

use crate::store::{SILENT_MS, Snapshot, StoreError, statements};

/// A station.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Station {
    /// Its name.
    pub name: String,
    /// Its program's version.
    pub program: String,
    /// Its plans: product, name and version of each.
    pub plans: Vec<String>,
    /// Entries that the plant does not have yet, as the station last said.
    pub unsent: u32,
    /// Those of them that wait for a person.
    pub dead: u32,
    /// When it was last heard from, in milliseconds since 1970, UTC, by the plant's clock.
    pub seen_ms: i64,
    /// When the latest run that came from it began, by its own clock.
    pub last_ms: Option<i64>,
    /// Whether it was heard from within the last two minutes.
    pub is_there: bool,
}

/// Every station that was ever heard from, by name.
///
/// # Errors
/// [`StoreError`] when the plant cannot be read.
pub fn stations(of: &Snapshot) -> Result<Vec<Station>, StoreError> {
    of.rows("to tell its stations", statements::STATIONS, &[], |row| {
        let (seen_ms, now_ms): (i64, i64) = (row.get(5)?, row.get(7)?);
        Ok(Station {
            name: row.get(0)?,
            program: row.get(1)?,
            plans: row.text(2)?.lines().map(str::to_owned).collect(),
            unsent: row.get(3)?,
            dead: row.get(4)?,
            seen_ms,
            last_ms: row.get(6)?,
            is_there: now_ms.saturating_sub(seen_ms) < SILENT_MS,
        })
    })
}

/// The plans, as [`Station::plans`] has them, of which runs were judged by several of one version: stations judge differently
/// under one name.
///
/// # Errors
/// [`StoreError`] when the plant cannot be read.
pub(crate) fn ambiguous(of: &Snapshot) -> Result<Vec<String>, StoreError> {
    of.rows("to tell its plans", statements::PLANS_OF_ONE_VERSION, &[], |row| row.get(0))
}
