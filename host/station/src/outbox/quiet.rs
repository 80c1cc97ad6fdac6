//! When there is nothing to look for.

use std::time::{Duration, Instant};

use crate::clock;
use crate::store::{SharedStore, StoreError};

/// How long nothing is looked for at most: the clock may be set meanwhile.
const LONGEST: Duration = Duration::from_secs(5);

/// A time in which nothing is due for a sink unless the store changes. All that waits would have to be read to find that again,
/// and it may be years of results.
#[derive(Debug)]
pub(super) struct Quiet {
    changes: u64,
    until: Instant,
}

impl Quiet {
    /// From now until the first entry for `sink` is due.
    ///
    /// # Errors
    /// [`StoreError`] when the database cannot be read.
    pub(super) fn of(store: &SharedStore, sink: &str) -> Result<Self, StoreError> {
        // What comes after this is a change, if it is too late to be found below.
        let (changes, now) = (store.with(|store| store.changes()), Instant::now());
        let next_ms = store.folder().next_due(sink)?;
        let wait = next_ms.map_or(LONGEST, |next_ms| {
            let wait_ms = next_ms.saturating_sub(clock::now_ms());
            Duration::from_millis(u64::try_from(wait_ms).unwrap_or(0)).min(LONGEST)
        });
        Ok(Self { changes, until: now + wait })
    }

    /// Whether it lasts.
    pub(super) fn lasts(&self, store: &SharedStore) -> bool {
        Instant::now() < self.until && store.with(|store| store.changes()) == self.changes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::said::Saying;
    use crate::store::{Deed, Folder, Store, Tried};

    fn note(store: &SharedStore) {
        let scan = Deed { operator: "weber", act: "scan", subject: "1", detail: "CA01" };
        store.with(|store| store.note(scan)).unwrap();
    }

    #[test]
    fn nothing_is_looked_for_until_the_first_entry_is_due_or_something_new_is_kept() {
        let place = tempfile::tempdir().unwrap();
        let mut store = Store::open(&Folder::new(place.path())).unwrap();
        store.sends_to(vec!["mes".to_owned()]).unwrap();
        let store = SharedStore::new(store);
        let empty = Quiet::of(&store, "mes").unwrap();
        assert!(empty.lasts(&store), "nothing waits");
        note(&store);
        assert!(!empty.lasts(&store), "something was kept");
        assert!(!Quiet::of(&store, "mes").unwrap().lasts(&store), "it is due");
        let entry = store.folder().due("mes", clock::now_ms(), i64::MAX).unwrap().remove(0);
        let tried = |wait_ms: i64| {
            let again = Tried::Again { next_ms: clock::now_ms() + wait_ms, said: Saying::PlanChanged.into() };
            store.with(|store| store.tried("mes", &[(entry.clone(), again)], clock::now_ms())).unwrap();
            Quiet::of(&store, "mes").unwrap()
        };
        let (begun, soon) = (Instant::now(), tried(2_000));
        assert!(soon.until > begun && soon.until <= Instant::now() + Duration::from_secs(2), "{soon:?}");
        let (begun, late) = (Instant::now(), tried(240_000));
        assert!(
            late.lasts(&store) && late.until >= begun + LONGEST && late.until <= Instant::now() + LONGEST
        );
    }
}
