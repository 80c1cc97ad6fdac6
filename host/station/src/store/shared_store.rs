//! One store for several lanes, which use it one at a time.

use std::sync::Arc;

use parking_lot::Mutex;

use super::{Folder, Store};

/// The store of a station, shared by its lanes.
#[derive(Clone, Debug)]
pub struct SharedStore {
    folder: Folder,
    store: Arc<Mutex<Store>>,
}

impl SharedStore {
    /// Shares `store`.
    #[must_use]
    pub fn new(store: Store) -> Self {
        Self { folder: store.folder().clone(), store: Arc::new(Mutex::new(store)) }
    }

    /// Its folder, for which nobody waits.
    #[must_use]
    pub fn folder(&self) -> &Folder {
        &self.folder
    }

    /// Runs `act` on the store, which nobody else has meanwhile, and returns its result.
    pub fn with<T>(&self, act: impl FnOnce(&mut Store) -> T) -> T {
        // A panic rolled its transaction back, and left the store as it was.
        act(&mut self.store.lock())
    }
}
