//! A station in a thread, made of the library: its store, its outbox and its claims are real, but its boards answer at once.

use std::sync::atomic::Ordering;
use std::thread;
use std::time::{Duration, Instant};

use halfrow_station::record::{JobClaim, RunCause};
use halfrow_station::run;
use halfrow_station::store::{Claim, PlantLink, Worker};
use halfrow_station::work::{Held, Holding};
use tempfile::TempDir;

use super::Trial;
use super::shelf::Session;
use crate::common::now_ms;
use crate::history::generated::Draw;
use crate::history::made::{End, Made, Run};
use crate::jobs::worker;
use crate::plant::sent::send_as;

/// How long a client pauses that has nothing to do, or whose plant is away.
const PAUSE: Duration = Duration::from_millis(100);
/// The number of exchanges with a board in a run, and the time after each.
const EXCHANGES: u32 = 4;
const EXCHANGE: Duration = Duration::from_millis(5);
/// How long to wait until the plant has a run.
const SENT: Duration = Duration::from_secs(20);

/// What happens to a client while it has a job.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fate {
    Well,
    /// It is killed before it begins a run.
    KilledAtOnce,
    /// It is killed while it judges.
    KilledInRun,
    /// It is killed after the result is stored, but before it is sent.
    KilledUnsent,
    /// It stops while it judges, for longer than its lease lasts.
    Stalled,
}

impl Fate {
    /// Of a hundred jobs, a client is killed at once in four, in the run in five, unsent in four, and stops in seven.
    fn drawn(draw: &mut Draw) -> Self {
        match draw.below(100) {
            0..4 => Self::KilledAtOnce,
            4..9 => Self::KilledInRun,
            9..13 => Self::KilledUnsent,
            13..20 => Self::Stalled,
            _ => Self::Well,
        }
    }
}

/// Takes jobs until the trial is over. Returns the client's folder.
pub(super) fn work(trial: &Trial, number: u32) -> TempDir {
    // Leaked, since the station's name in a made run is `'static`.
    let name: &'static str = Box::leak(format!("client {number}").into_boxed_str());
    let mut client = Client {
        trial,
        worker: worker(name),
        name,
        plant: PlantLink::new(trial.address()),
        made: Some(Made::new()),
        draw: Draw(u64::from(number)),
        runs: number * 100_000,
    };
    while !trial.is_over() {
        match client.plant.ask(|plant| plant.claim(&client.worker)) {
            Ok(Some(claim)) => client.take(&claim),
            Ok(None) => thread::sleep(PAUSE),
            Err(error) => {
                assert!(error.is_away(), "{error:?}");
                thread::sleep(PAUSE);
            }
        }
    }
    while client.send(Duration::ZERO, &|| false) > 0 {}
    client.made.unwrap().closed()
}

struct Client<'a> {
    trial: &'a Trial,
    name: &'static str,
    worker: Worker,
    plant: PlantLink,
    /// Its store; none only inside [`Client::with`].
    made: Option<Made>,
    draw: Draw,
    runs: u32,
}

impl Client<'_> {
    fn take(&mut self, claim: &Claim) {
        let fate = Fate::drawn(&mut self.draw);
        if fate == Fate::KilledAtOnce {
            return self.killed(claim);
        }
        // A client that is killed or stops renews nothing, and gives nothing back.
        let holding =
            (fate == Fate::Well).then(|| Holding::begin(self.plant.clone(), Held::Job(claim.clone())));
        self.judge(claim, fate);
        match fate {
            Fate::KilledInRun | Fate::KilledUnsent => self.killed(claim),
            _ => drop(self.send(SENT, &|| holding.as_ref().is_some_and(Holding::is_lost))),
        }
    }

    /// Judges the board, and stores the result.
    fn judge(&mut self, claim: &Claim, fate: Fate) {
        let session = self.trial.shelf.begin(&claim.lease.board);
        self.runs += 1;
        let fence = JobClaim { id: claim.job.clone(), fence: claim.fence };
        let run = Run {
            station: self.name,
            lane: claim.lease.board.clone(),
            started_ms: now_ms(),
            // In a control, runs do not name their claim.
            job: self.trial.shape.is_fenced.then_some(fence),
            ..Run::of(claim.serial(), End::Open)
        };
        let made = self.made.as_mut().unwrap();
        made.count_from(self.runs);
        let (head, plan) = made.begin(&run);
        let Some(end) = self.exchanged(claim, &session, fate) else { return };
        let id = head.id.clone();
        self.made.as_mut().unwrap().finish(&Run { end, ..run }, head, plan);
        if end == End::Pass {
            session.judged(&id);
            if !self.trial.shape.is_fenced {
                self.trial.believed(&claim.job, &id);
            }
        }
    }

    /// Talks to the board; returns how the run ends, or none if the client is killed.
    fn exchanged(&self, claim: &Claim, session: &Session<'_>, fate: Fate) -> Option<End> {
        for number in 0..EXCHANGES {
            match (number, fate) {
                (1, Fate::KilledInRun) => return None,
                (2, Fate::Stalled) => self.stand_still(claim),
                _ => {}
            }
            if session.exchange().is_err() {
                return Some(End::Error(RunCause::Link));
            }
            thread::sleep(EXCHANGE);
        }
        Some(End::Pass)
    }

    fn stand_still(&self, claim: &Claim) {
        self.trial.happened.stalls.fetch_add(1, Ordering::Relaxed);
        match self.trial.shape.stall {
            Some(stall) => thread::sleep(stall),
            None => {
                self.trial.run_out(&claim.job, &claim.lease.board);
                thread::sleep(5 * PAUSE);
            }
        }
    }

    /// The client is gone, and starts again with what it had stored.
    fn killed(&mut self, claim: &Claim) {
        self.trial.happened.kills.fetch_add(1, Ordering::Relaxed);
        self.plant = PlantLink::new(self.trial.address());
        self.worker.holder = format!("{} {}", self.name, self.runs);
        self.with(|made| {
            let mut made = Made::at(made.closed());
            run::recover(&mut made.store).unwrap();
            made
        });
        if self.trial.shape.stall.is_none() {
            self.trial.run_out(&claim.job, &claim.lease.board);
        }
    }

    /// Sends until the plant has everything, the time `long` is over, or the job `is_lost`. Returns how many entries are left.
    fn send(&mut self, long: Duration, is_lost: &dyn Fn() -> bool) -> u32 {
        let (address, name, begun) = (self.trial.address(), self.name, Instant::now());
        loop {
            self.with(|made| send_as(name, made, address.clone()).0);
            let unsent = self.made.as_ref().unwrap().now().unsent().unwrap();
            let left = unsent.iter().map(|of| of.entries).sum();
            if left == 0 || begun.elapsed() >= long || is_lost() {
                return left;
            }
            thread::sleep(PAUSE);
        }
    }

    fn with(&mut self, act: impl FnOnce(Made) -> Made) {
        self.made = self.made.take().map(act);
    }
}
