//! Jobs: what any free station is to judge. A job and its board are claimed together or not at all, and held until a time by
//! the plant's clock. A job is done when a PASS or FAIL of its last claim has come to the plant.

use std::collections::BTreeSet;

use clap::ValueEnum;
use halfrow::Verdict;
use serde::Serialize;
use serde_json::json;
use strum::{Display, EnumString, VariantArray};

use super::super::database::{Database, DatabaseError, FromValue, Row, Value, values};
use super::super::{AgainError, By, Deed, Snapshot, StoreError, retest_policy, statements as sql};
use super::boards::{LEASE_MS, Lease, hold, shorten};
use super::{Plant, arrived};
use crate::ids;
use crate::plan::{Again, Plan};

/// How it stands with a job; in the order in which a job comes to them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ValueEnum, Display, EnumString, VariantArray)]
#[serde(rename_all = "lowercase")]
#[strum(serialize_all = "lowercase")]
pub enum JobState {
    /// No station has it.
    Waiting,
    /// A station has it.
    Claimed,
    /// It was judged.
    Done,
    /// It came to nothing and waits for a person.
    Dead,
    /// A person cancelled it.
    Cancelled,
}

impl JobState {
    /// Those in which something is still to be done.
    pub(crate) const UNSETTLED: [Self; 3] = [Self::Waiting, Self::Claimed, Self::Dead];
}

impl FromValue for JobState {
    const EXPECTED: &'static str = "waiting, claimed, done, dead or cancelled";

    fn from_value(value: Value<'_>) -> Option<Self> {
        if let Value::Text(text) = value { text.parse().ok() } else { None }
    }
}

/// Which board a job is about.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Wanted {
    /// The board that is this unit.
    Serial(String),
    /// Any board of this kind.
    Kind(String),
}

/// A job that is to be added.
#[derive(Clone, Debug)]
pub struct NewJob<'a> {
    /// The plan.
    pub plan: &'a Plan,
    /// What it is to judge.
    pub wanted: &'a Wanted,
    /// What a station must have.
    pub needs: &'a [String],
    /// Jobs of a higher priority come first.
    pub priority: i64,
    /// Who wants it.
    pub operator: &'a str,
}

/// A job and its state.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Job {
    /// Its id, a UUID of version 7.
    pub id: String,
    /// The name of its plan.
    pub plan: String,
    /// The version of its plan.
    pub version: String,
    /// The product.
    pub product: String,
    /// The unit; empty if any board of the kind will do.
    pub serial: String,
    /// The kind of board; empty if it is one unit.
    pub kind: String,
    /// What a station must have, separated by blanks.
    pub needs: String,
    /// Jobs of a higher priority come first.
    pub priority: i64,
    /// How it stands with it.
    pub state: JobState,
    /// Who has it, or had it last.
    pub holder: Option<String>,
    /// How often it was claimed since it was added, or since a person had it tried again or cancelled it.
    pub attempts: u32,
    /// The run that counts.
    pub run: Option<String>,
    /// That run's verdict.
    pub verdict: Option<Verdict>,
    /// When it was added, in milliseconds since 1970, UTC.
    pub created_ms: i64,
    /// Who wants it.
    pub operator: String,
    /// Why it was given up, or has no result yet.
    pub said: Option<String>,
}

/// A station that takes jobs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Worker {
    /// Who it is: the station's name and an id that no other process has.
    pub holder: String,
    /// The station.
    pub station: String,
    /// The hashes of its plans.
    pub plans: Vec<String>,
    /// The hashes of those by which a unit that passed is not judged again unless somebody means this very unit.
    pub once: Vec<String>,
    /// Its plans with the units that check shifts by them, each pair as one text. No job for any board of a kind is for those.
    pub references: Vec<String>,
    /// What it has that jobs may need.
    pub has: Vec<String>,
    /// What it cannot judge: plans with boards, each pair as one text.
    pub unfit: Vec<String>,
}

/// A job that a worker has, with its board.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Claim {
    /// The job.
    pub job: String,
    /// The number of the claim, higher than that of every earlier claim of the job.
    pub fence: i64,
    /// The hash of the plan.
    pub plan_sha256: String,
    /// The board.
    pub lease: Lease,
}

impl Claim {
    /// The serial number of the board.
    #[must_use]
    pub fn serial(&self) -> &str {
        &self.lease.serial
    }

    /// The plan with the board, as it is shared.
    pub(crate) fn pairing(&self) -> String {
        format!("{} {} {}", self.plan_sha256, self.lease.target, self.lease.serial)
    }
}

impl Plant {
    /// Adds `count` jobs. Returns their ids, in the order in which they are taken.
    ///
    /// # Errors
    /// [`StoreError`] when the plant does not take them.
    pub fn add_jobs(&mut self, job: &NewJob<'_>, count: u32) -> Result<Vec<String>, StoreError> {
        let NewJob { plan, wanted, needs, priority, operator } = job;
        // By their own clocks, jobs of a computer whose clock is slow would come before all that wait.
        let at_ms = self.now_ms()?;
        let mut added = Vec::new();
        for _ in 0..count {
            added.push(ids::new(at_ms)?.to_string());
        }
        added.sort();
        let (serial, kind) = match wanted {
            Wanted::Serial(serial) => (serial.as_str(), ""),
            Wanted::Kind(kind) => ("", kind.as_str()),
        };
        let needs = needs.join(" ");
        let subject = added.first().cloned().unwrap_or_default();
        let detail = format!("{count} of {} {} for {} {serial}{kind}", plan.name, plan.version, plan.product);
        let deed = Deed { operator, act: "add job", subject: &subject, detail: &detail };
        self.audited("to add jobs", deed, |to| {
            arrived::plan(to, plan, at_ms)?;
            added.iter().try_fold(0, |done, id| {
                let of = values![id, &plan.sha256, &plan.product, serial, kind, &needs, *priority, *operator];
                Ok(done + to.execute(sql::ADD_JOB, of)?)
            })
        })?;
        Ok(added)
    }

    /// Cancels the job; whoever has it loses it. Returns false if there is none, or it is done or was cancelled before.
    ///
    /// # Errors
    /// Like [`Self::add_jobs`].
    pub fn cancel_job(&mut self, id: &str, by: By<'_>) -> Result<bool, StoreError> {
        self.audited("to cancel a job", by.does("cancel job", id), |to| {
            to.execute(sql::CANCEL_JOB, values![&**by.reason, id])
        })
    }

    /// Has a job that was given up judged after all. Returns whether it was given up.
    ///
    /// # Errors
    /// Like [`Self::add_jobs`].
    pub fn retry_job(&mut self, id: &str, by: By<'_>) -> Result<bool, StoreError> {
        self.audited("to retry a job", by.does("retry job", id), |to| to.execute(sql::RETRY_JOB, values![id]))
    }

    /// Gives `worker` the first job that it can judge, with a board; none if there is none for now.
    ///
    /// # Errors
    /// Like [`Self::add_jobs`].
    pub fn claim(&mut self, worker: &Worker) -> Result<Option<Claim>, StoreError> {
        self.change("to give a job", |to| claimed(to, worker))
    }

    /// Renews the leases of a job and its board. Returns whether both are still held.
    ///
    /// # Errors
    /// Like [`Self::add_jobs`].
    pub fn renew_claim(&mut self, claim: &Claim) -> Result<bool, StoreError> {
        let Claim { job, fence, lease, .. } = claim;
        let renewed = self.carry_out("to let a job be held", |to| {
            to.execute(sql::RENEW_JOB, values![LEASE_MS, job, &lease.holder, *fence])
        })?;
        Ok(renewed == 1 && self.renew(lease)?)
    }

    /// Gives back a job that was not begun, and its board; `said` is why, where that is of interest to whoever looks at the job.
    ///
    /// # Errors
    /// Like [`Self::add_jobs`].
    pub fn decline(&mut self, claim: &Claim, said: Option<&str>) -> Result<(), StoreError> {
        self.give_back_job(claim, said)?;
        self.give_back(&claim.lease)
    }

    /// The same without its board.
    pub(crate) fn give_back_job(&mut self, claim: &Claim, said: Option<&str>) -> Result<(), StoreError> {
        let Claim { job, fence, lease, .. } = claim;
        self.carry_out("to take a job back", |to| {
            to.execute(sql::RETURN_JOB, values![said, job, &lease.holder, *fence])
        })
        .map(drop)
    }

    /// Gives back a job that came to no run, for this reason. A job that was claimed five times is dead.
    ///
    /// # Errors
    /// Like [`Self::add_jobs`].
    pub fn fail(&mut self, claim: &Claim, said: &str) -> Result<(), StoreError> {
        let Claim { job, fence, .. } = claim;
        self.carry_out("to take a job back", |to| {
            to.execute(sql::JOB_BACK, values![said, *fence, 0_i64, job])
        })
        .map(drop)
    }

    /// Why no job may have the unit of this serial number judged: it passed, and the plan does not let it be judged again. A plan
    /// that only asks does, because somebody added the job.
    ///
    /// # Errors
    /// Like [`Self::add_jobs`].
    pub fn refuses(&mut self, plan: &Plan, serial: &str) -> Result<Option<AgainError>, StoreError> {
        if plan.again != Again::Refuse || plan.production.is_reference(serial) {
            return Ok(None);
        }
        let passed = self
            .carry_out("to tell whether a unit passed", |from| retest_policy::passed(from, plan, serial))?;
        Ok(passed.map(|passed| AgainError::refused(serial, &passed)))
    }

    /// Ends a job whose unit must not be judged, for this reason.
    ///
    /// # Errors
    /// Like [`Self::add_jobs`].
    pub fn refuse(&mut self, claim: &Claim, said: &str) -> Result<(), StoreError> {
        let Claim { job, fence, .. } = claim;
        self.carry_out("to end a job", |to| to.execute(sql::REFUSE_JOB, values![said, job, *fence])).map(drop)
    }

    /// Whether a run counts; none if it is not there.
    ///
    /// # Errors
    /// Like [`Self::add_jobs`].
    pub fn counts(&mut self, run: &str) -> Result<Option<bool>, StoreError> {
        let nth = self.carry_out("to tell whether a run counts", |database| {
            database.first(sql::NTH_OF, values![run], |row| row.get::<i64>(0))
        })?;
        Ok(nth.map(|nth| nth > 0))
    }

    /// Whether the job was cancelled or claimed again after this claim, or ended by another run than this one.
    ///
    /// # Errors
    /// Like [`Self::add_jobs`].
    pub fn is_superseded(&mut self, claim: &Claim, run: &str) -> Result<bool, StoreError> {
        let of = values![&claim.job, claim.fence, run];
        let found = self.carry_out("to tell whether a run is superseded", |database| {
            database.first(sql::SUPERSEDING_JOB, of, |_| Ok(()))
        })?;
        Ok(found.is_some())
    }
}

/// Claims a job and its board, or neither: the rows are locked until the transaction ends.
fn claimed(to: &mut dyn Database, worker: &Worker) -> Result<Option<Claim>, DatabaseError> {
    let Worker { holder, station, plans, once, references, has, unfit } = worker;
    shorten(to)?;
    to.execute(sql::EXHAUSTED_JOBS, &[])?;
    let [once, plans, has] = [once, plans, has].map(|words| words.join(" "));
    let [references, unfit] = [serde_json::to_string(references)?, serde_json::to_string(unfit)?];
    let of = values![station, &once, &references, &plans, &unfit, &has];
    let id: Option<String> = to.first(sql::CLAIMABLE_JOB, of, |row| row.get(0))?;
    let Some(id) = id else { return Ok(None) };
    let of = values![&id, station, &once, &references, &unfit];
    let board: Option<String> = to.first(sql::BOARD_OF_JOB, of, |row| row.get(0))?;
    // Somebody else was quicker.
    let Some(board) = board else { return Ok(None) };
    let lease = hold(to, &board, holder)?;
    to.one(sql::CLAIM_JOB, values![holder, LEASE_MS, &id], |row| {
        Ok(Some(Claim {
            job: row.get(0)?,
            fence: row.get(1)?,
            plan_sha256: row.get(2)?,
            lease: lease.clone(),
        }))
    })
}

/// The jobs in these states, the newest first: at most `most`, following the job with the id `after` unless that is
/// empty.
///
/// # Errors
/// [`StoreError`] when the plant cannot be read.
pub fn jobs(of: &Snapshot, states: &[JobState], after: &str, most: u32) -> Result<Vec<Job>, StoreError> {
    let states: Vec<_> = states.iter().map(JobState::to_string).collect();
    of.rows("to tell its jobs", sql::JOBS, values![&states.join(" "), after, most], job)
}

/// The jobs that are waiting, or claimed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct JobsInState {
    pub(crate) state: JobState,
    pub(crate) jobs: u32,
    /// How long ago the oldest of them was added, in milliseconds, by the plant's clock.
    pub(crate) oldest_ms: i64,
}

/// The jobs that are to be judged, by their states; a state without jobs is left out.
///
/// # Errors
/// [`StoreError`] when the plant cannot be read.
pub(crate) fn open_jobs(of: &Snapshot) -> Result<Vec<JobsInState>, StoreError> {
    of.rows("to count its jobs", sql::OPEN_JOBS, &[], |row| {
        Ok(JobsInState { state: row.get(0)?, jobs: row.get(1)?, oldest_ms: row.get(2)? })
    })
}

/// How many jobs are in each state; a state without jobs is left out. This reads every job.
///
/// # Errors
/// [`StoreError`] when the plant cannot be read.
pub(crate) fn counted_jobs(of: &Snapshot) -> Result<Vec<(JobState, u32)>, StoreError> {
    of.rows("to count its jobs", sql::COUNTED_JOBS, &[], |row| Ok((row.get(0)?, row.get(1)?)))
}

/// Which of these serial numbers any unit has that was tested.
///
/// # Errors
/// [`StoreError`] when the plant cannot be read.
pub(crate) fn seen_units(of: &Snapshot, serials: &[&str]) -> Result<BTreeSet<String>, StoreError> {
    let serials = json!(serials).to_string();
    let seen = of.rows("to tell its units", sql::SEEN_UNITS, values![&serials], |row| row.get(0))?;
    Ok(seen.into_iter().collect())
}

fn job(row: &Row<'_>) -> Result<Job, DatabaseError> {
    Ok(Job {
        id: row.get(0)?,
        plan: row.get(1)?,
        version: row.get(2)?,
        product: row.get(3)?,
        serial: row.get(4)?,
        kind: row.get(5)?,
        needs: row.get(6)?,
        priority: row.get(7)?,
        state: row.get(8)?,
        holder: row.get(9)?,
        attempts: row.get(10)?,
        run: row.get(11)?,
        verdict: row.get(12)?,
        created_ms: row.get(13)?,
        operator: row.get(14)?,
        said: row.get(15)?,
    })
}
