//! Plans of which a file is another one than at the start: their jobs are left to stations that have the plan as it was.

use std::collections::BTreeMap;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use crate::plan::changed;
use crate::said::Saying;
use crate::settings::PlanFile;

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

    /// Looks at the files of a plan before a run, and sets it aside if one was changed. The log says that once, and once that it
    /// was put back.
    ///
    /// # Errors
    /// [`Saying::PlanFileOther`]
    pub(super) fn check(&self, PlanFile { path, plan }: &PlanFile) -> Result<(), Saying> {
        let changed = changed(path, &plan.files);
        let (product, name, version) = (&plan.product, &plan.name, &plan.version);
        let Some(file) = changed else {
            if self.plans().remove(&plan.sha256).is_some() {
                tracing::warn!("jobs of the plan {product}/{name} {version} are taken again");
            }
            return Ok(());
        };
        let why = Saying::PlanFileOther { file: file.to_owned() };
        let until = Instant::now() + AGAIN;
        if self.plans().insert(plan.sha256.clone(), until).is_none() {
            tracing::warn!("no job of the plan {product}/{name} {version} is taken for now: {why}");
        }
        Err(why)
    }

    fn plans(&self) -> MutexGuard<'_, BTreeMap<String, Instant>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
