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
    /// The unit has passed, and counts as passed only when the plant has that result, which it does not have yet.
    #[error(
        "{serial} passed under this plan, at {when}, but the plant does not have that result yet; keep this board apart, and scan \
         it again once nothing waits for the plant"
    )]
    NotAtPlant {
        /// The serial number.
        serial: String,
        /// When it passed, as above.
        when: String,
    },
}

/// A PASS that is the last judgement of its unit.
pub(super) struct Passed {
    run: String,
    /// When it ended, in milliseconds since 1970, UTC.
    at_ms: i64,
}

impl AgainError {
    /// The unit of this serial number passed like this.
    pub(super) fn refused(serial: &str, passed: &Passed) -> Self {
        Self::Refused { serial: serial.to_owned(), when: when(passed.at_ms) }
    }
}

impl Folder {
    /// Why the unit of this serial number is not simply tested again: its last judgement under this very plan is PASS.
    /// `how` says how to have it tested all the same; nothing helps where the plant must have that PASS, and does not. Units that
    /// check shifts are always tested.
    ///
    /// # Errors
    /// [`StoreError`] when the database cannot be read.
    pub fn again(
        &self,
        plan: &Plan,
        serial: &str,
        how: &'static str,
        is_green_at_plant: bool,
    ) -> Result<Option<AgainError>, StoreError> {
        if plan.again == Again::Allow || plan.production.is_reference(serial) {
            return Ok(None);
        }
        let passed = self.read("to tell whether a unit passed", |from| passed(from, plan, serial))?;
        let Some(Passed { run, at_ms: passed_ms }) = passed else { return Ok(None) };
        let (serial, when) = (serial.to_owned(), when(passed_ms));
        Ok(Some(if is_green_at_plant && !self.at_plant(&run)?.is_done {
            AgainError::NotAtPlant { serial, when }
        } else if plan.again == Again::Ask {
            AgainError::Asked { serial, when, how }
        } else {
            AgainError::Refused { serial, when }
        }))
    }
}

/// The PASS of the unit of this serial number, if that is its last judgement under this very plan.
pub(super) fn passed(
    from: &mut dyn Database,
    plan: &Plan,
    serial: &str,
) -> Result<Option<Passed>, DatabaseError> {
    let of = values![&plan.product, serial, &plan.sha256];
    let last = from.first(sql::PASSED, of, |row| {
        Ok((row.get::<Verdict>(0)?, Passed { run: row.get(1)?, at_ms: row.get(2)? }))
    })?;
    Ok(last.filter(|(verdict, _)| *verdict == Verdict::Pass).map(|(_, passed)| passed))
}

fn when(ms: i64) -> String {
    clock::local(ms).strftime("%Y-%m-%dT%H:%M:%S%:z").to_string()
}
