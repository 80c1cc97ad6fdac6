//! Plans of which a file is another one than at the start: their jobs are left to stations that have the plan as it was.

use std::collections::BTreeMap;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use crate::plan::Plan;
use crate::said::Saying;

/// How long no job of such a plan is taken before its files are looked at again.
const AGAIN: Duration = Duration::from_secs(5);

/// For each plan that was set aside, by its hash, until when.
#[derive(Debug, Default)]
pub struct Aside(Mutex<BTreeMap<String, Instant>>);

impl Aside {
    /// Whether jobs of the plan with this hash are taken.
    pub(super) fn lets(&self, sha256: &str) -> bool {
        self.plans().get(sha256).is_none_or(|until| *until <= Instant::now())
    }

    /// Takes note of a run that was not begun because a file of `plan` was changed: the plan is set aside. The log says that once.
    pub(super) fn put(&self, Plan { sha256, product, name, version, .. }: &Plan, why: &Saying) {
        let until = Instant::now() + AGAIN;
        if self.plans().insert(sha256.clone(), until).is_none() {
            tracing::warn!("no job of the plan {product}/{name} {version} is taken for now: {why}");
        }
    }

    /// Takes note of a run by `plan`. If it was set aside, the log says that it is not any more.
    pub(super) fn take_back(&self, Plan { sha256, product, name, version, .. }: &Plan) {
        if self.plans().remove(sha256).is_some() {
            tracing::warn!("jobs of the plan {product}/{name} {version} are taken again");
        }
    }

    fn plans(&self) -> MutexGuard<'_, BTreeMap<String, Instant>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
