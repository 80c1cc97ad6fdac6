//! What a station takes no jobs of: plans of which a file is another one than at the start, whose jobs are left to stations that have
//! the plan as it was, and shared boards that cannot be judged as they are shared.

use std::collections::{BTreeMap, BTreeSet};
use std::time::{Duration, Instant};

use parking_lot::Mutex;

use crate::plan::Plan;
use crate::said::Saying;
use crate::store::{Claim, Worker};

/// How long no job of such a plan is taken before its files are looked at again.
const AGAIN: Duration = Duration::from_secs(5);

/// What was set aside.
#[derive(Debug, Default)]
pub struct SetAside {
    /// Until when, for each plan, by its hash.
    plans: Mutex<BTreeMap<String, Instant>>,
    /// [Pairings](Claim::pairing) of a plan with a board.
    boards: Mutex<BTreeSet<String>>,
}

impl SetAside {
    /// `worker`, without what is set aside.
    pub(super) fn without(&self, worker: &Worker) -> Worker {
        let plans = self.plans.lock();
        let lets = |sha256: &&String| plans.get(*sha256).is_none_or(|until| *until <= Instant::now());
        Worker {
            plans: worker.plans.iter().filter(lets).cloned().collect(),
            unfit: self.boards.lock().iter().cloned().collect(),
            ..worker.clone()
        }
    }

    /// Takes note of a run that was not begun because a file of `plan` was changed: the plan is set aside. The log says that once.
    pub(super) fn put(&self, Plan { sha256, product, name, version, .. }: &Plan, why: &Saying) {
        let until = Instant::now() + AGAIN;
        if self.plans.lock().insert(sha256.clone(), until).is_none() {
            tracing::warn!("no job of the plan {product}/{name} {version} is taken for now: {why}");
        }
    }

    /// Takes note of a run by `plan`. If it was set aside, the log says that it is not any more.
    pub(super) fn take_back(&self, Plan { sha256, product, name, version, .. }: &Plan) {
        if self.plans.lock().remove(sha256).is_some() {
            tracing::warn!("jobs of the plan {product}/{name} {version} are taken again");
        }
    }

    /// Sets the board of `claim` aside for jobs by its plan, until it is shared differently.
    pub(super) fn put_board(&self, claim: &Claim) {
        self.boards.lock().insert(claim.pairing());
    }
}
