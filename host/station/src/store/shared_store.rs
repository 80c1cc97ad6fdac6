//! One store for several lanes, which use it one at a time.

use std::sync::Arc;

use parking_lot::Mutex;

use super::Store;

/// The store of a station, shared by its lanes.
#[derive(Clone, Debug)]
pub struct SharedStore(Arc<Mutex<Store>>);

impl SharedStore {
    /// Shares `store`.
    #[must_use]
    pub fn new(store: Store) -> Self {
        Self(Arc::new(Mutex::new(store)))
    }

    /// Runs `act` on the store, which nobody else has meanwhile, and returns its result.
    pub fn with<T>(&self, act: impl FnOnce(&mut Store) -> T) -> T {
        // A panic rolled its transaction back, and left the store as it was.
        act(&mut self.0.lock())
    }
}
