//! A plant: its tables follow from the records that it keeps, in whatever order they arrived.

use std::collections::BTreeSet;

use halfrow::Verdict;
use halfrow::result::sha256;

use super::compare::compare;
use super::{Checked, Fault, is_as_hashed};
use crate::progress::{Progress, Told};
use crate::record::Record;
use crate::store::{KeptRun, Rebinding, Rebuilt, Snapshot, StoreError, TABLES};

/// Tables of a station that are empty at a plant, each with its key.
const EMPTY: [(&str, &str); 2] = [("outbox", "sink, kind, subject"), ("origin", "id")];

/// The table in which a plant keeps whatever arrived first.
const BINDING: &str = "binding";

/// Checks everything that a plant keeps, as it was when the snapshot `plant` was taken; `told` is called with the
/// number of runs read so far. Nothing is changed; stations may send meanwhile.
///
/// # Errors
/// [`StoreError`] when the plant cannot be read at all.
pub fn check_plant(plant: &Snapshot, told: Told<'_>) -> Result<Checked, StoreError> {
    let mut look = Look { plant, rebuilt: Rebuilt::of_plant()?, runs: 0, unread: 0, faults: Vec::new() };
    look.at_runs(told)?;
    let rebindings = plant.rebindings()?;
    look.at_rebindings(&rebindings);
    for plan in plant.plans_of_jobs()? {
        look.rebuilt.add_plan_of_job(&plan)?;
    }
    let mut faults = Vec::new();
    for (table, key) in TABLES.into_iter().chain(EMPTY) {
        compare(table, plant.table(table, key), look.rebuilt.table(table, key), &mut faults)?;
    }
    let excuse = Excuse {
        ended: rebindings.iter().map(|change| change.at_ms.to_string()).collect(),
        pruned_before: plant.pruned_before()?,
    };
    for fault in faults {
        if !look.excuses(&fault, &excuse)? {
            look.faults.push(fault);
        }
    }
    look.at_what_names_runs()?;
    let open = plant.open_runs()?.len();
    let Look { runs, unread, faults, .. } = look;
    Ok(Checked { runs, open, evidence: runs, pruned: 0, unread, superseded: Vec::new(), faults })
}

/// Why a plant may differ from what its records say.
struct Excuse {
    /// When people bound a unit anew, in milliseconds since 1970, UTC.
    ended: BTreeSet<String>,
    /// Steps and measurements may be gone for runs whose ids sort before this.
    pruned_before: String,
}

struct Look<'a> {
    plant: &'a Snapshot,
    rebuilt: Rebuilt,
    runs: usize,
    unread: usize,
    faults: Vec<Fault>,
}

impl Look<'_> {
    /// Goes through all runs in the order in which they began.
    fn at_runs(&mut self, told: Told<'_>) -> Result<(), StoreError> {
        let mut after = String::new();
        loop {
            let page = self.plant.kept_runs(&after)?;
            let Some(last) = page.last() else { return Ok(()) };
            after.clone_from(&last.run);
            for kept in &page {
                self.runs += 1;
                match self.record(kept) {
                    Ok(record) => self.at_run(kept, record)?,
                    Err(fault) => {
                        self.unread += 1;
                        self.faults.push(fault);
                    }
                }
            }
            told(Progress { what: "runs read", done: self.runs, of: None });
        }
    }

    /// The record of a run, if it is as it was sent.
    fn record(&mut self, KeptRun { run, sha256: hash, text, .. }: &KeptRun) -> Result<Record, Fault> {
        let text = text.as_ref().filter(|text| sha256([text.as_bytes()]) == *hash);
        let text = text.ok_or_else(|| Fault::Unkept { run: run.clone(), sha256: hash.clone() })?;
        let record = Record::parse(text.as_bytes());
        let record = record.map_err(|source| Fault::Record { run: run.clone(), source })?;
        if !is_as_hashed(&record.plan) {
            self.faults.push(Fault::Plan { run: run.clone() });
        }
        Ok(record)
    }

    fn at_run(&mut self, kept: &KeptRun, mut record: Record) -> Result<(), StoreError> {
        // A unit has the id of the first run that arrived, not of the first that began.
        let known = match self.rebuilt.unit_of(&record.run)? {
            None => self.plant.unit_of(&record.run.product, &record.run.serial)?,
            known => known,
        };
        if let Some(unit) = known {
            record.run.unit_id = unit;
        }
        let counts = self.counts(kept, &record)?;
        if let Err(error) = self.rebuilt.add_kept(&record, &kept.sha256, counts) {
            self.faults.push(Fault::Contradiction { run: kept.run.clone(), source: Box::new(error) });
        }
        Ok(())
    }

    /// Whether no other run of its job counts. Among runs without a judgement only the plant knows which one had the job.
    fn counts(&self, kept: &KeptRun, record: &Record) -> Result<bool, StoreError> {
        let Some(job) = &record.run.job else { return Ok(true) };
        if record.conclusion.verdict == Verdict::Error {
            return Ok(kept.nth > 0);
        }
        let done_by = self.plant.run_of_job(&job.id)?;
        Ok(done_by.is_none_or(|run| run.as_ref() == Some(&kept.run)))
    }

    fn at_rebindings(&mut self, rebindings: &[Rebinding]) {
        for change in rebindings {
            if let Err(error) = self.rebuilt.add_bound(change) {
                self.faults.push(Fault::Audit { id: change.id.clone(), source: Box::new(error) });
            }
        }
    }

    /// Whether a plant may differ here: rows of old runs were removed, and the binding that arrived first stands in
    /// the way of others until a person binds anew.
    fn excuses(&mut self, fault: &Fault, excuse: &Excuse) -> Result<bool, StoreError> {
        match fault {
            Fault::Missing { table: "step" | "measurement", key } => Ok(*key < excuse.pruned_before),
            Fault::Differs { table: BINDING, key, column, stored, .. } if column == "to_ms" => {
                let begins = |ms: &i64| ms.to_string() == *stored;
                Ok(excuse.ended.contains(stored) || self.others_begin(key)?.iter().any(begins))
            }
            Fault::Missing { table: BINDING, key } => Ok(!self.others_begin(key)?.is_empty()),
            _ => Ok(false),
        }
    }

    /// When the plant's other bindings of the same device or unit as the binding `key` begin.
    fn others_begin(&mut self, key: &str) -> Result<Vec<i64>, StoreError> {
        let Some((device, unit)) = self.rebuilt.bound(key)? else { return Ok(Vec::new()) };
        self.plant.others_begin(key, &device, &unit)
    }

    /// Checks records, waivers, jobs and mismatches against the runs that they name.
    fn at_what_names_runs(&mut self) -> Result<(), StoreError> {
        let surplus = |table| move |key| Fault::Surplus { table, key };
        self.faults.extend(self.plant.unnamed_records()?.into_iter().map(surplus("record")));
        self.faults.extend(self.plant.other_mismatches()?.into_iter().map(surplus("mismatch")));
        let waivers = self.plant.contradicted_waivers()?.into_iter();
        self.faults.extend(waivers.map(|run| Fault::Waiver { run }));
        let jobs = self.plant.jobs_without_runs()?.into_iter();
        self.faults.extend(jobs.map(|job| Fault::Job { job }));
        Ok(())
    }
}
