//! Connections to a plant, which pages reuse one after the other.

use std::sync::Arc;

use super::super::{Deed, Snapshot, StoreError};
use super::PlantAddress;
use super::idle::Idle;

/// Connections to the plant. A clone has the same ones.
#[derive(Clone, Debug)]
pub(crate) struct PlantPool(Arc<Idle>);

impl PlantPool {
    /// Connections to the plant at `address`, which are made when somebody looks.
    #[must_use]
    pub(crate) fn new(address: PlantAddress) -> Self {
        Self(Arc::new(Idle::new(address)))
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
            self.0.keep(plant);
        }
        found
    }

    /// Enters a deed in the plant's audit.
    ///
    /// # Errors
    /// Like [`Self::look`].
    pub(crate) fn note(&self, deed: Deed<'_>) -> Result<(), StoreError> {
        self.0.connect()?.note(deed)
    }

    /// A snapshot by a connection that was kept, or by a new one if there is none or it has ended meanwhile.
    fn snapshot(&self) -> Result<Snapshot, StoreError> {
        match self.0.take().map(Snapshot::of_plant) {
            Some(Ok(now)) => return Ok(now),
            Some(Err(_)) => self.0.clear(),
            None => {}
        }
        Snapshot::of_plant(self.0.connect()?)
    }
}
