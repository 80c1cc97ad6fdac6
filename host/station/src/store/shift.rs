//! Whether a lane was checked in this shift, by a unit that is known to be good and one that is known to be bad.

use halfrow::Verdict;
use rusqlite::{OptionalExtension as _, params};

use super::{Folder, StoreError, statements as sql};
use crate::plan::Plan;
use crate::said::Said;
use crate::said::Saying;

/// What a lane is to do before its production counts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Owed {
    /// The unit that is to be tested.
    pub serial: String,
    /// Why.
    pub why: Said,
}

impl Folder {
    /// What this lane of this station still owes to the shift at `now_ms` before boards are judged by `plan`: that the
    /// last judgement of the good unit is PASS, and then that of the bad one FAIL. An ERROR checks nothing.
    ///
    /// # Errors
    /// [`StoreError`] when the database cannot be read.
    pub fn owed(
        &self,
        station: &str,
        lane: &str,
        plan: &Plan,
        now_ms: i64,
    ) -> Result<Option<Owed>, StoreError> {
        let Some(shift) = &plan.shift else { return Ok(None) };
        let lasts = i64::try_from(shift.lasts.as_millis()).unwrap_or(i64::MAX);
        let reader = self.reader()?;
        for (serial, expected) in [(&shift.good, Verdict::Pass), (&shift.bad, Verdict::Fail)] {
            let since = now_ms.saturating_sub(lasts);
            let of = params![station, lane, plan.sha256, plan.product, serial, since];
            let last: Option<String> = reader
                .query_row(sql::LAST_JUDGEMENT, of, |row| row.get(0))
                .optional()
                .map_err(|source| StoreError::Database {
                    path: self.database(),
                    doing: "to tell who checked a shift",
                    source,
                })?;
            let of = serial.clone();
            let why = match (last, expected) {
                (Some(verdict), _) if verdict == expected.to_string() => continue,
                (Some(verdict), Verdict::Pass) => Saying::GoodUnitWrong { serial: of, verdict },
                (Some(verdict), _) => Saying::BadUnitWrong { serial: of, verdict },
                (None, Verdict::Pass) => Saying::GoodUnitDue { serial: of },
                (None, _) => Saying::BadUnitDue { serial: of },
            };
            return Ok(Some(Owed { serial: serial.clone(), why: why.into() }));
        }
        Ok(None)
    }
}
