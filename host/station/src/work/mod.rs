//! A station that takes jobs of its plant, as many at once as its settings say, each on a board that several computers share.
//!
//! ```text
//!  claim: job and board, together ─► run, like any run ─► kept here ─► outbox ─► plant: the job is done, by this very run
//!      └ held: renewed every ten seconds ────────────────────────────────────────┘
//!        └ lost: the run is ended; its result is kept and does not count
//! ```

mod aside;
mod error;
mod held;

use std::path::PathBuf;
use std::thread;
use std::time::{Duration, Instant};

use halfrow::target::Target;
use halfrow::verdict::StoppedBy;
use rand::{RngExt as _, rng};

pub use aside::SetAside;
pub use error::WorkError;
pub use held::{Held, Holding, Lost};

use crate::clock;
use crate::labgrid::LaneBoard;
use crate::outbox::{Sent, awaited};
use crate::plan::{Plan, PlanName};
use crate::record::{JobClaim, Record};
use crate::run::{self, Order, RunError, Saved, Stage, Watch, recover_run};
use crate::said::Said;
use crate::settings::{PlanFile, Settings};
use crate::store::{
    By, Claim, InLane, Introduction, PlantError, PlantLink, Reason, SharedStore, StoreError, Worker,
};

/// The operator in records and in the plant's audit.
const OPERATOR: &str = "job";
/// About how long to wait before asking for a job again, in milliseconds.
const IDLE_MS: u64 = 1_000;
/// The same while the plant is away, or the station's own store fails.
const AWAY_MS: u64 = 5_000;
/// The time between two checks whether a wait is over.
const LOOK: Duration = Duration::from_millis(50);

/// The result of a job.
#[derive(Debug)]
pub struct JobResult {
    /// The job.
    pub claim: Claim,
    /// Its run.
    pub saved: Saved,
    /// Whether the plant had it at the last check.
    pub is_sent: bool,
    /// Why the plant, which is there, does not take it, if it does not.
    pub refused: Option<String>,
    /// Whether it counts there: not if it is superseded, or of a unit that checks shifts. None until the plant has it and says so.
    pub counts: Option<bool>,
    /// Whether its job was cancelled or claimed again before it came to the plant. None until the plant has it and says so.
    pub is_superseded: Option<bool>,
    /// Why a board is not out that a process which cannot be killed may still have, if one may.
    pub not_out: Option<StoreError>,
}

/// A station that takes jobs.
#[derive(Debug)]
pub struct Work<'a> {
    /// The station's settings.
    pub settings: &'a Settings,
    /// The plant.
    pub plant: PlantLink,
    /// The station's store, whose outbox is at work.
    pub store: SharedStore,
    /// The program whose command `lane` is started.
    pub program: PathBuf,
    /// Its identity at the plant.
    pub worker: Worker,
    /// What it takes no jobs of.
    pub aside: SetAside,
}

impl Work<'_> {
    /// The first job that this station can judge now, if there is one.
    ///
    /// # Errors
    /// [`StoreError`] when the plant is not there.
    pub fn claim(&self) -> Result<Option<Claim>, StoreError> {
        let worker = self.aside.without(&self.worker);
        self.plant.ask(|plant| plant.claim(&worker))
    }

    /// Waits for the next job that this station can judge, also while the plant is away or refuses for a while; none when `stop`
    /// ends the wait.
    ///
    /// # Errors
    /// [`StoreError`] when its tables are older or newer.
    pub fn next(&self, stop: &dyn Fn() -> Option<StoppedBy>) -> Result<Option<Claim>, StoreError> {
        while stop().is_none() {
            let about_ms = match self.claim() {
                Ok(None) => IDLE_MS,
                Err(error) if error.may_pass() => {
                    tracing::warn!("there is no job for now: {}", Said::of(&error).with_codes());
                    AWAY_MS
                }
                found => return found,
            };
            rest(about_ms, stop);
        }
        Ok(None)
    }

    /// Gives back a job that was not begun. This costs the job no attempt.
    pub fn decline(&self, claim: &Claim) {
        free_later(&claim.job, self.plant.ask(|plant| plant.decline(claim, None)));
    }

    /// Judges the board of a claim, keeps the result, and waits until the plant has it or does not take it, or the claim is lost.
    /// A plant that is away and must hear that the board is out is tried until `next_stop`.
    ///
    /// # Errors
    /// [`WorkError`] when there is no run. Then others may take the job, at the latest when the claim has run out.
    pub fn judge(
        &self,
        claim: Claim,
        stop: &dyn Fn() -> Option<StoppedBy>,
        next_stop: &dyn Fn() -> Option<StoppedBy>,
        heard: &mut dyn FnMut(Stage<'_>),
    ) -> Result<JobResult, WorkError> {
        let holding = Holding::begin(self.plant.clone(), Held::Job(claim.clone()));
        let mut watched = JobWatch { holding: &holding, stop, heard, is_stuck: false };
        let ended = self.run(&claim, &mut watched);
        let is_stuck = watched.is_stuck;
        let not_out = if is_stuck { self.take_out(&claim.lease.board, next_stop).err() } else { None };
        if let Some(error) = &not_out {
            tracing::error!(
                "the board {} is not out, and a process that cannot be killed may still have it; restart this computer: {}",
                claim.lease.board,
                Said::of(error)
            );
        }
        let saved = match ended {
            Ok(saved) => saved,
            Err(error) => {
                self.give_back(&claim, &error);
                return Err(error);
            }
        };
        let run = &saved.record.run.id;
        let sent = self.sent(run, &|| holding.is_lost() || stop().is_some());
        // The plant ends a job as it takes its run, which the outbox may not have noted yet.
        let is_over = matches!(holding.lost(), Some(Lost::Taken { .. }));
        let counts = if is_over || matches!(sent, Sent::Yes) { self.counts(run) } else { None };
        let is_superseded = self.is_superseded(&claim, &saved.record, counts);
        let is_sent = counts.is_some() || matches!(sent, Sent::Yes);
        let refused = if let Sent::Refused(said) = sent { Some(said.to_string()) } else { None };
        let ended = &saved.record.conclusion;
        if !is_sent && ended.is_from_outside() && stop().is_some() {
            free_later(
                &claim.job,
                self.plant.ask(|plant| plant.give_back_job(&claim, Some(&ended.headline))),
            );
        }
        // Another host uses it, and would turn the next run away as well.
        if ended.is_busy() {
            holding.run_out();
        } else {
            holding.end();
        }
        Ok(JobResult { claim, is_sent, refused, counts, is_superseded, not_out, saved })
    }

    /// Gives back a job that came to no run. One whose unit must not be judged ends here; one whose board cannot be judged goes to
    /// another board.
    fn give_back(&self, claim: &Claim, error: &WorkError) {
        if error.is_not_begun() {
            return self.decline(claim);
        }
        if error.is_of_board() {
            self.aside.put_board(claim);
        }
        let said = Said::of(error).to_string();
        let back = self.plant.ask(|plant| match error {
            WorkError::Again(_) => plant.refuse(claim, &said),
            _ if error.is_of_board() => plant.decline(claim, Some(&said)),
            _ => plant.fail(claim, &said),
        });
        free_later(&claim.job, back);
    }

    /// Waits until another job may get further than the one that ended with `error`. What could not be saved is closed first,
    /// because nothing else can begin on its board before that.
    pub fn settle(&self, error: &WorkError, stop: &dyn Fn() -> Option<StoppedBy>) {
        if !error.is_of_store() {
            return;
        }
        rest(AWAY_MS, stop);
        let WorkError::Run(RunError::Unsaved { run, .. }) = error else { return };
        while stop().is_none() {
            match recover_run(&self.store, run) {
                Ok(_) => return,
                Err(error) => tracing::warn!("no job is taken meanwhile: {}", Said::of(&error)),
            }
            rest(AWAY_MS, stop);
        }
    }

    /// Takes out a board that a process which cannot be killed may still have, so that nobody gets it. Waits for a plant that is
    /// away until `stop` ends the wait.
    ///
    /// # Errors
    /// [`StoreError`] when the plant does not know it.
    pub(crate) fn take_out(
        &self,
        board: &str,
        stop: &dyn Fn() -> Option<StoppedBy>,
    ) -> Result<(), StoreError> {
        let station = &self.worker.station;
        let why = Reason::of_program(&format!(
            "a process of station {station} may still have it, and cannot be killed; restart that computer first"
        ));
        let by = By { operator: OPERATOR, reason: &why };
        loop {
            match self.plant.ask(|plant| plant.take_out(board, by)) {
                Err(error) if error.may_pass() && stop().is_none() => {
                    tracing::warn!(
                        "the board {board} is not out yet ({}): {}",
                        &*why,
                        Said::of(&error).with_codes()
                    );
                    rest(AWAY_MS, stop);
                }
                told => return told.map(drop),
            }
        }
    }

    fn run(&self, claim: &Claim, watched: &mut JobWatch<'_>) -> Result<Saved, WorkError> {
        let target: Target = claim.lease.target.parse().map_err(|source| WorkError::Target {
            board: claim.lease.board.clone(),
            target: claim.lease.target.clone(),
            source,
        })?;
        let board = LaneBoard::Own(target);
        let Settings { plans, silence, memory_mib, .. } = self.settings;
        let file = plans.iter().find(|file| file.plan.sha256 == claim.plan_sha256);
        let Some(PlanFile { path, plan }) = file else {
            return Err(WorkError::NoPlan { job: claim.job.clone(), sha256: claim.plan_sha256.clone() });
        };
        self.refuse_unit(claim, plan)?;
        let (station, lane) = (&self.worker.station, &claim.lease.board);
        let in_lane = InLane::of(station, lane, plan);
        let counts = self.store.folder().counts(&in_lane, claim.serial(), clock::now_ms());
        let job = JobClaim { id: claim.job.clone(), fence: claim.fence };
        let order = Order {
            plan,
            plan_file: path,
            serial: claim.serial(),
            board: &board,
            station,
            lane,
            operator: OPERATOR,
            program: &self.program,
            counts: counts.map_err(|error| RunError::NotBegun(Box::new(error)))?,
            job: Some(&job),
            silence: *silence,
            memory_mib: *memory_mib,
        };
        let ended = run::run(&self.store, &order, watched);
        match &ended {
            Err(RunError::PlanFile(why)) => self.aside.put(plan, why),
            _ => self.aside.take_back(plan),
        }
        Ok(ended?)
    }

    /// Refuses a unit that the plan does not judge, or that passed if the plan refuses such a one. The plant knows it, because a job is
    /// done and its board free only once its run is there.
    fn refuse_unit(&self, claim: &Claim, plan: &Plan) -> Result<(), WorkError> {
        if plan.select(claim.serial()).is_err() {
            let (board, serial) = (claim.lease.board.clone(), claim.serial().to_owned());
            return Err(WorkError::Serial { board, serial, plan: PlanName::from(plan).to_string() });
        }
        let refused = self.plant.ask(|plant| plant.refuses(plan, claim.serial()));
        match refused.map_err(|error| RunError::NotBegun(Box::new(error)))? {
            Some(error) => Err(error.into()),
            None => Ok(()),
        }
    }

    /// Tells the plant of this station, from which it takes nothing while another one has its name, and compares the clocks before
    /// the first run. Waits for a plant that is away if it `may_be_away`.
    ///
    /// # Errors
    /// [`PlantError`] when it is there and refuses.
    pub fn introduce(
        &self,
        station: &Introduction,
        may_be_away: bool,
        stop: &dyn Fn() -> Option<StoppedBy>,
    ) -> Result<(), PlantError> {
        while stop().is_none() {
            match self.plant.ask(|plant| plant.see(station)) {
                Err(error) if may_be_away && error.is_away() => {
                    tracing::warn!("no job is taken for now: {}", Said::of(&error).with_codes());
                    rest(AWAY_MS, stop);
                }
                heard => return heard.map(|clock| self.store.with(|store| store.heard_plant(clock))),
            }
        }
        Ok(())
    }

    /// Waits until the plant has a run that it did not take, or that run waits for a person.
    pub fn until_taken(&self, run: &str, stop: &dyn Fn() -> Option<StoppedBy>) {
        while stop().is_none() && matches!(self.sent(run, &|| true), Sent::NotYet) {
            rest(AWAY_MS, stop);
        }
    }

    /// The state of a run at the plant, as [`awaited`] says. If the store cannot say, it is not waited for: the run is
    /// saved, and sent when the outbox can.
    fn sent(&self, run: &str, is_over: &dyn Fn() -> bool) -> Sent {
        awaited(self.store.folder(), run, is_over).unwrap_or_else(|error| {
            tracing::warn!(
                "whether the plant has the run {run} is not known: {}",
                Said::of(&error).with_codes()
            );
            Sent::NotYet
        })
    }

    /// Whether a run that the plant has counts there.
    fn counts(&self, run: &str) -> Option<bool> {
        self.plant.ask(|plant| plant.counts(run)).ok()?
    }

    /// Whether the run of the claim is superseded, which `counts` tells except of a unit that checks shifts.
    fn is_superseded(&self, claim: &Claim, record: &Record, counts: Option<bool>) -> Option<bool> {
        let counts = counts?;
        if counts || !record.is_of_reference() {
            return Some(!counts);
        }
        self.plant.ask(|plant| plant.is_superseded(claim, &record.run.id)).ok()
    }
}

/// Waits for about this long, or until `stop` says so. The time is random so that stations which were started together do not ask
/// together.
fn rest(about_ms: u64, stop: &dyn Fn() -> Option<StoppedBy>) {
    let wait = rng().random_range(about_ms / 2..about_ms * 3 / 2);
    sleep_unless(Duration::from_millis(wait), &|| stop().is_some());
}

/// Warns that a job which could not be given `back` is free only later.
fn free_later(job: &str, back: Result<(), StoreError>) {
    if let Err(error) = back {
        tracing::warn!("the job {job} is free when its lease has run out: {}", Said::of(&error).with_codes());
    }
}

/// Ends a run when its job and board are lost.
struct JobWatch<'a> {
    holding: &'a Holding,
    stop: &'a dyn Fn() -> Option<StoppedBy>,
    heard: &'a mut dyn FnMut(Stage<'_>),
    /// Whether its lane's process could not be killed.
    is_stuck: bool,
}

impl Watch for JobWatch<'_> {
    fn stop(&self) -> Option<StoppedBy> {
        (self.stop)().or_else(|| self.holding.is_lost().then_some(StoppedBy::Caller))
    }

    fn why(&self) -> Option<Said> {
        self.holding.lost().filter(|_| (self.stop)().is_none()).map(|lost| Said::of(&lost))
    }

    fn hear(&mut self, stage: Stage<'_>) {
        self.is_stuck |= matches!(stage, Stage::Saving { is_stuck: true, .. });
        (self.heard)(stage);
    }
}

/// Waits this long, or until it `is_over`.
pub(crate) fn sleep_unless(wait: Duration, is_over: &dyn Fn() -> bool) {
    let until = Instant::now() + wait;
    while !is_over() && Instant::now() < until {
        thread::sleep(LOOK);
    }
}
