//! Whether a unit that has passed already is tested again.

use halfrow::Verdict;

use super::database::{Database, DatabaseError, values};
use super::{Folder, StoreError, statements as sql};
use crate::clock;
use crate::plan::{Again, Plan};

/// Why a unit is not tested again.
#[derive(Debug, thiserror::Error)]
pub enum AgainError {
    /// The unit has passed already, and the plan does not let it be tested again.
    #[error("{serial} passed already under this plan, at {when}; put it with the boards that passed")]
    Refused {
        /// The serial number.
        serial: String,
        /// When it passed, in this computer's local time with the offset from UTC.
        when: String,
    },
    /// The unit has passed already, and nobody has yet confirmed that it is to be tested again.
    #[error("{serial} passed already under this plan, at {when}; {how} to test it again")]
    Asked {
        /// The serial number.
        serial: String,
        /// When it passed, as above.
        when: String,
        /// What to do to have it tested all the same.
        how: &'static str,
    },
}

impl AgainError {
    /// The unit of this serial number passed at this time.
    pub(super) fn refused(serial: &str, passed_ms: i64) -> Self {
        Self::Refused { serial: serial.to_owned(), when: when(passed_ms) }
    }
}

impl Folder {
    /// Why the unit of this serial number is not simply tested again: its last judgement under this very plan is PASS.
    /// `how` says how to have it tested all the same. Units that check shifts are always tested.
    ///
    /// # Errors
    /// [`StoreError`] when the database cannot be read.
    pub fn again(
        &self,
        plan: &Plan,
        serial: &str,
        how: &'static str,
    ) -> Result<Option<AgainError>, StoreError> {
        if plan.again == Again::Allow || plan.production.is_reference(serial) {
            return Ok(None);
        }
        let passed = self.read("to tell whether a unit passed", |from| passed(from, plan, serial))?;
        Ok(passed.map(|ms| match plan.again {
            Again::Ask => AgainError::Asked { serial: serial.to_owned(), when: when(ms), how },
            Again::Refuse | Again::Allow => AgainError::refused(serial, ms),
        }))
    }
}

/// When the unit of this serial number passed, in milliseconds since 1970, UTC, if that is its last judgement under this very
/// plan.
pub(super) fn passed(
    from: &mut dyn Database,
    plan: &Plan,
    serial: &str,
) -> Result<Option<i64>, DatabaseError> {
    let of = values![&plan.product, serial, &plan.sha256];
    let last: Option<(Verdict, i64)> = from.first(sql::PASSED, of, |row| Ok((row.get(0)?, row.get(1)?)))?;
    Ok(last.filter(|(verdict, _)| *verdict == Verdict::Pass).map(|(_, ms)| ms))
}

fn when(ms: i64) -> String {
    clock::local(ms).strftime("%Y-%m-%dT%H:%M:%S%:z").to_string()
}
