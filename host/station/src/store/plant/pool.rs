//! Connections to a plant, which pages reuse one after the other.

use std::sync::Arc;

use parking_lot::Mutex;

use super::super::{Deed, Snapshot, StoreError};
use super::{Plant, PlantAddress};

/// How many connections are kept while nobody looks.
const KEPT: usize = 4;

/// Connections to the plant. A clone has the same ones.
#[derive(Clone, Debug)]
pub(crate) struct PlantPool(Arc<Parts>);

#[derive(Debug)]
struct Parts {
    address: PlantAddress,
    idle: Mutex<Vec<Plant>>,
}

impl PlantPool {
    /// Connections to the plant at `address`, which are made when somebody looks.
    #[must_use]
    pub(crate) fn new(address: PlantAddress) -> Self {
        Self(Arc::new(Parts { address, idle: Mutex::default() }))
    }

    /// What `look` finds at one moment.
    ///
    /// # Errors
    /// [`StoreError`] when the plant is not there, or cannot be read.
    pub(crate) fn look<T>(
        &self,
        look: impl FnOnce(&Snapshot) -> Result<T, StoreError>,
    ) -> Result<T, StoreError> {
        let now = self.snapshot()?;
        let found = look(&now);
        if let Some(plant) = now.end() {
            let mut idle = self.0.idle.lock();
            if idle.len() < KEPT {
                idle.push(plant);
            }
        }
        found
    }

    /// Enters a deed in the plant's audit.
    ///
    /// # Errors
    /// Like [`Self::look`].
    pub(crate) fn note(&self, deed: Deed<'_>) -> Result<(), StoreError> {
        Plant::connect(&self.0.address)?.note(deed)
    }

    /// A snapshot by a connection that was kept, or by a new one if there is none or it has ended meanwhile.
    fn snapshot(&self) -> Result<Snapshot, StoreError> {
        let kept = self.0.idle.lock().pop();
        match kept.map(Snapshot::of_plant) {
            Some(Ok(now)) => Ok(now),
            _ => Snapshot::of_plant(Plant::connect(&self.0.address)?),
        }
    }
}
