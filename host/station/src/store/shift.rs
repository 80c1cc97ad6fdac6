//! Whether a lane was checked in this shift, by a unit that is known to be good and by what is known to be bad.

use halfrow::Verdict;

use super::clock_agreement::TOLERATED_MS;
use super::database::{DatabaseError, Row, values};
use super::{Folder, StoreError, statements as sql};
use crate::plan::mock::BARCODE;
use crate::plan::{Bad, Plan, Production, Shift};
use crate::said::{Said, Saying};

/// A plan in a lane.
#[derive(Clone, Copy, Debug)]
pub struct InLane<'a> {
    /// The station.
    pub station: &'a str,
    /// The lane.
    pub lane: &'a str,
    /// The plan's hash.
    pub plan_sha256: &'a str,
    /// Its product.
    pub product: &'a str,
    /// What it demands of production.
    pub production: &'a Production,
}

impl<'a> InLane<'a> {
    /// This plan in this lane of this station.
    #[must_use]
    pub fn of(station: &'a str, lane: &'a str, plan: &'a Plan) -> Self {
        let Plan { sha256, product, production, .. } = plan;
        Self { station, lane, plan_sha256: sha256, product, production }
    }
}

/// What a lane is to do before its production counts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Owed {
    /// The unit that is to be tested.
    pub serial: String,
    /// Why.
    pub why: Said,
}

/// Whether a lane was checked in its shift.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Checked {
    /// What it is to do; nothing if it was checked.
    pub owed: Option<Owed>,
    /// The last moment at which this holds without another run in the lane, in milliseconds since 1970, UTC. After it, a
    /// judgement that is dated too far ahead now may count.
    pub until_ms: i64,
}

/// The last judgement of a unit.
struct LastVerdict {
    run: String,
    verdict: Verdict,
    started_ms: i64,
    target: String,
}

impl LastVerdict {
    /// Whether it is of a shift that lasts so many milliseconds, at `now_ms`, and the last moment at which this holds.
    fn counts(&self, now_ms: i64, lasts: i64) -> (bool, i64) {
        // Nobody knows when a judgement that is dated further ahead was made.
        let from = self.started_ms.saturating_sub(TOLERATED_MS);
        let until = self.started_ms.saturating_add(lasts);
        if now_ms < from {
            (false, from.saturating_sub(1))
        } else if now_ms <= until {
            (true, until)
        } else {
            (false, i64::MAX)
        }
    }
}

impl Folder {
    /// Whether a run of this serial number that begins at `now_ms` can count as production: it is of a product, and its lane was
    /// checked in this shift.
    ///
    /// # Errors
    /// Like [`Self::owed`].
    pub fn counts(&self, place: &InLane<'_>, serial: &str, now_ms: i64) -> Result<bool, StoreError> {
        Ok(place.production.counts(serial) && self.owed(place, now_ms)?.owed.is_none())
    }

    /// What a lane still owes to the shift at `now_ms` before boards are judged by its plan: the last judgement of the good unit
    /// must be PASS, and that of the bad unit, or of the mock in its place, FAIL and after it. An ERROR checks nothing.
    ///
    /// # Errors
    /// [`StoreError`] when the database cannot be read.
    pub fn owed(&self, place: &InLane<'_>, now_ms: i64) -> Result<Checked, StoreError> {
        let InLane { station, lane, plan_sha256, product, production } = *place;
        let mut until_ms = i64::MAX;
        let Some(shift) = &production.shift else { return Ok(Checked { owed: None, until_ms }) };
        let lasts = i64::try_from(shift.lasts.as_millis()).unwrap_or(i64::MAX);
        let units = [(shift.good.clone(), Verdict::Pass), (shift.bad.serial(lane), Verdict::Fail)];
        let mut before = String::new();
        for (serial, expected) in units {
            let of = values![station, lane, plan_sha256, product, &serial];
            let last =
                self.read("to tell who checked a shift", |from| from.first(sql::LAST_JUDGEMENT, of, judged))?;
            let last = last.filter(|last| {
                // What was judged against the lane holds until the next judgement, whatever the clock said then.
                if last.verdict != expected {
                    return true;
                }
                let (counts, until) = last.counts(now_ms, lasts);
                until_ms = until_ms.min(until);
                // After a repair the good unit passes again, and an earlier FAIL of the bad one says nothing of the lane as
                // it is now.
                counts && last.run > before
            });
            match last {
                Some(last) if last.verdict == expected => before = last.run,
                last => {
                    let why = why(shift, expected, last);
                    return Ok(Checked { owed: Some(Owed { serial, why }), until_ms });
                }
            }
        }
        Ok(Checked { owed: None, until_ms })
    }
}

fn judged(row: &Row<'_>) -> Result<LastVerdict, DatabaseError> {
    Ok(LastVerdict { run: row.get(0)?, verdict: row.get(1)?, started_ms: row.get(2)?, target: row.get(3)? })
}

/// Why a lane waits for a judgement that must be `expected`: the `last` one is another, or there is none.
fn why(shift: &Shift, expected: Verdict, last: Option<LastVerdict>) -> Said {
    let (serial, is_good) = match (expected, &shift.bad) {
        (Verdict::Pass, _) => (shift.good.clone(), true),
        (_, Bad::Unit(serial)) => (serial.clone(), false),
        (_, Bad::Mock) => {
            let barcode = BARCODE.to_owned();
            return match last {
                None => Saying::MockDue { barcode },
                Some(LastVerdict { verdict, target, .. }) => {
                    Saying::MockWrong { target, verdict: verdict.to_string(), barcode }
                }
            }
            .into();
        }
    };
    match (last, is_good) {
        (Some(LastVerdict { verdict, .. }), true) => {
            Saying::GoodUnitWrong { serial, verdict: verdict.to_string() }
        }
        (Some(LastVerdict { verdict, .. }), false) => {
            Saying::BadUnitWrong { serial, verdict: verdict.to_string() }
        }
        (None, true) => Saying::GoodUnitDue { serial },
        (None, false) => Saying::BadUnitDue { serial },
    }
    .into()
}
