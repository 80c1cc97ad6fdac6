//! What a plant keeps, read back, and its tables as they come out when they are made anew from its records.

use super::super::bindings::BY_RUN;
use super::super::database::{DatabaseError, values};
use super::super::{Rebinding, Rebuilt, Snapshot, StoreError, rows, statements as sql};
use super::arrived;
use crate::record::{PlanRecord, Record, RunHead};

/// A run that a plant keeps.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct KeptRun {
    /// Its id.
    pub run: String,
    /// Its unit.
    pub unit_id: String,
    /// Which judgement of the unit it is, counted from 1; 0 for one that does not count.
    pub nth: i64,
    /// The hash of its record.
    pub sha256: String,
    /// Its record, if it is there.
    pub text: Option<String>,
}

/// A plan that a job brought.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PlanOfJob {
    plan: PlanRecord,
    product: String,
    first_used_ms: i64,
}

impl Snapshot {
    /// The next runs of a plant after the one with the id `after`, in the order in which they began; none after the last.
    ///
    /// # Errors
    /// [`StoreError`] when the database cannot be read.
    pub(crate) fn kept_runs(&self, after: &str) -> Result<Vec<KeptRun>, StoreError> {
        self.rows("to tell its runs", sql::KEPT_RUNS, values![after], |row| {
            let (run, unit_id, nth) = (row.get(0)?, row.get(1)?, row.get(2)?);
            Ok(KeptRun { run, unit_id, nth, sha256: row.get(3)?, text: row.get(4)? })
        })
    }

    /// The id of a unit.
    ///
    /// # Errors
    /// Like [`Self::kept_runs`].
    pub(crate) fn unit_of(&self, product: &str, serial: &str) -> Result<Option<String>, StoreError> {
        let found = self.rows("to tell a unit", sql::UNIT_OF, values![product, serial], |row| row.get(0))?;
        Ok(found.into_iter().next())
    }

    /// The run by which a job is done: `Some(None)` for a job that is not done, `None` for one that does not exist.
    ///
    /// # Errors
    /// [`StoreError`] when the plant cannot be asked.
    pub fn run_of_job(&self, job: &str) -> Result<Option<Option<String>>, StoreError> {
        let found = self.rows("to tell a job", sql::RUN_OF_JOB, values![job], |row| row.get(0))?;
        Ok(found.into_iter().next())
    }

    /// When all bindings of this device or this unit begin, except the one with this id, in milliseconds since 1970, UTC.
    ///
    /// # Errors
    /// Like [`Self::kept_runs`].
    pub(crate) fn others_begin(&self, id: &str, device: &str, unit: &str) -> Result<Vec<i64>, StoreError> {
        let text = "SELECT from_ms FROM binding WHERE id <> $1 AND (device = $2 OR unit_id = $3)";
        self.rows("to tell what is bound", text, values![id, device, unit], |row| row.get(0))
    }

    /// The hashes of records that no run names.
    ///
    /// # Errors
    /// Like [`Self::kept_runs`].
    pub(crate) fn unnamed_records(&self) -> Result<Vec<String>, StoreError> {
        self.rows("to tell its records", sql::UNNAMED_RECORDS, &[], |row| row.get(0))
    }

    /// Jobs that are said to be done and have no run.
    ///
    /// # Errors
    /// Like [`Self::kept_runs`].
    pub(crate) fn jobs_without_runs(&self) -> Result<Vec<String>, StoreError> {
        self.rows("to tell its jobs", sql::JOBS_WITHOUT_RUNS, &[], |row| row.get(0))
    }

    /// The runs of which a plant's waiver and audit tell different things; either may come before the other.
    ///
    /// # Errors
    /// Like [`Self::kept_runs`].
    pub(crate) fn contradicted_waivers(&self) -> Result<Vec<String>, StoreError> {
        self.rows("to tell its waivers", sql::CONTRADICTED_WAIVERS, &[], |row| row.get(0))
    }

    /// The runs of mismatches that contradict their run.
    ///
    /// # Errors
    /// Like [`Self::kept_runs`].
    pub(crate) fn other_mismatches(&self) -> Result<Vec<String>, StoreError> {
        self.rows("to tell what is bound", sql::OTHER_MISMATCHES, &[], |row| row.get(0))
    }

    /// The plans that jobs brought.
    ///
    /// # Errors
    /// Like [`Self::kept_runs`].
    pub(crate) fn plans_of_jobs(&self) -> Result<Vec<PlanOfJob>, StoreError> {
        self.rows("to tell its plans", sql::PLANS_OF_JOBS, &[], |row| {
            let [sha256, name, version, text] = [row.get(0)?, row.get(1)?, row.get(2)?, row.get(3)?];
            let plan = PlanRecord { sha256, name, version, text, files: None };
            Ok(PlanOfJob { plan, product: row.get(4)?, first_used_ms: row.get(5)? })
        })
    }
}

impl Rebuilt {
    /// Empty tables of a plant. What its stations bound may contradict each other.
    ///
    /// # Errors
    /// [`StoreError`] when there is no room for it.
    pub(crate) fn of_plant() -> Result<Self, StoreError> {
        let mut rebuilt = Self::new()?;
        rebuilt.change(|to| to.batch("DROP INDEX binding_device_now; DROP INDEX binding_unit_now"))?;
        Ok(rebuilt)
    }

    /// The id of a unit, if there is one by now.
    ///
    /// # Errors
    /// [`StoreError`] when it cannot be read.
    pub(crate) fn unit_of(
        &mut self,
        RunHead { product, serial, .. }: &RunHead,
    ) -> Result<Option<String>, StoreError> {
        self.change(|to| to.first(sql::UNIT_OF, values![product, serial], |row| row.get(0)))
    }

    /// Enters the run of this record, whose hash is `hash`, as a plant does; it `counts` unless another run of its job does. Runs
    /// must come in the order of their ids.
    ///
    /// # Errors
    /// [`StoreError`] when it contradicts the runs before.
    pub(crate) fn add_kept(&mut self, record: &Record, hash: &str, counts: bool) -> Result<(), StoreError> {
        let counts = counts && !self.is_reference(record);
        self.change(|to| {
            let unit = rows::unit(to, &record.run, &record.plan)?;
            arrived::entered(to, record, hash, &unit, counts)?;
            let Some(device) = record.binds() else { return Ok(()) };
            let (id, operator) = (&record.run.id, &record.run.operator);
            let bound = values![id, device, &unit, record.ended_ms, operator, BY_RUN];
            to.execute(sql::ADD_BINDING, bound).map(drop)
        })
    }

    /// Enters what a person bound, without ending what was bound before; nothing if the unit does not exist, because then the
    /// plant left it out, too.
    ///
    /// # Errors
    /// [`StoreError`] when it contradicts what is there.
    pub(crate) fn add_bound(&mut self, change: &Rebinding) -> Result<(), StoreError> {
        let Rebinding { id, at_ms, operator, unit_id, device, reason } = change;
        let Some(device) = device else { return Ok(()) };
        self.change(|to| {
            let known = to.first("SELECT 1 FROM unit WHERE id = $1", values![unit_id], |_| Ok(()))?;
            let bound = values![id, device, unit_id, *at_ms, operator, reason];
            known.map_or(Ok(()), |()| to.execute(sql::ADD_BINDING, bound).map(drop))
        })
    }

    /// The device and the unit of the binding with this id.
    ///
    /// # Errors
    /// [`StoreError`] when it cannot be read.
    pub(crate) fn bound(&mut self, id: &str) -> Result<Option<(String, String)>, StoreError> {
        let text = "SELECT device, unit_id FROM binding WHERE id = $1";
        self.change(|to| to.first(text, values![id], |row| Ok((row.get(0)?, row.get(1)?))))
    }

    /// Enters a plan that a job brought, after all runs. The time of its first use is taken as it is, unless a run is earlier.
    ///
    /// # Errors
    /// [`StoreError`] when it contradicts what is there.
    pub(crate) fn add_plan_of_job(&mut self, of: &PlanOfJob) -> Result<(), StoreError> {
        let PlanOfJob { plan: PlanRecord { sha256, name, version, text, .. }, product, first_used_ms } = of;
        self.change(|to| -> Result<(), DatabaseError> {
            to.execute(sql::ADD_PLAN, values![sha256, name, version, product, text, *first_used_ms])?;
            to.execute(sql::PLAN_EARLIER, values![*first_used_ms, sha256]).map(drop)
        })
    }
}
