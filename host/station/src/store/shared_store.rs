//! One store for several lanes, which use it one at a time.

use std::sync::{Arc, Mutex, PoisonError};

use super::Store;

/// The store of a station, in as many hands as it has lanes.
#[derive(Clone, Debug)]
pub struct SharedStore(Arc<Mutex<Store>>);

impl SharedStore {
    /// Shares `store`.
    #[must_use]
    pub fn new(store: Store) -> Self {
        Self(Arc::new(Mutex::new(store)))
    }

    /// What `act` returns of the store, which nobody else has meanwhile.
    pub fn with<T>(&self, act: impl FnOnce(&mut Store) -> T) -> T {
        // Whoever panicked has left a transaction that was taken back, and the store as it was.
        act(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}
