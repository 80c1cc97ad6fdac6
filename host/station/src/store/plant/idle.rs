//! Connections to a plant that nobody uses at the moment.

use std::mem;

use parking_lot::Mutex;

use super::super::StoreError;
use super::{Plant, PlantAddress};

/// How many are kept.
const KEPT: usize = 4;

/// The address of a plant, and connections to it that can be used again.
#[derive(Debug)]
pub(super) struct Idle {
    pub(super) address: PlantAddress,
    kept: Mutex<Vec<Plant>>,
}

impl Idle {
    /// Those to the plant at `address`, of which there is none yet.
    pub(super) fn new(address: PlantAddress) -> Self {
        Self { address, kept: Mutex::default() }
    }

    /// A connection that was kept, if there is one. It may have ended meanwhile.
    pub(super) fn take(&self) -> Option<Plant> {
        self.kept.lock().pop()
    }

    /// A new connection.
    ///
    /// # Errors
    /// [`StoreError`] when the plant is not there, or its tables are older or newer.
    pub(super) fn connect(&self) -> Result<Plant, StoreError> {
        Plant::connect(&self.address)
    }

    /// Keeps a connection that works, unless there are enough.
    pub(super) fn keep(&self, plant: Plant) {
        let mut kept = self.kept.lock();
        if kept.len() < KEPT {
            kept.push(plant);
        }
    }

    /// Drops all that are kept, because one has failed: whatever ended that has probably ended them, too, and each would fail whoever
    /// takes it.
    pub(super) fn clear(&self) {
        let ended = mem::take(&mut *self.kept.lock());
        drop(ended);
    }
}
