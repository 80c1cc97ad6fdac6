//! Connections to a plant, kept as long as they work.

use std::mem;
use std::sync::Arc;

use parking_lot::Mutex;

use super::super::{Deed, Snapshot, StoreError};
use super::{Plant, PlantAddress};

/// How many connections that nobody uses at the moment are kept.
const KEPT: usize = 4;

/// A plant that is connected to when it is asked something, and anew after an error. A clone has the same connections.
#[derive(Clone, Debug)]
pub struct PlantLink(Arc<Connections>);

#[derive(Debug)]
struct Connections {
    address: PlantAddress,
    /// Those that nobody uses at the moment. They may have ended meanwhile.
    kept: Mutex<Vec<Plant>>,
}

impl PlantLink {
    /// A link to the plant at `address`.
    #[must_use]
    pub fn new(address: PlantAddress) -> Self {
        Self(Arc::new(Connections { address, kept: Mutex::default() }))
    }

    /// A link of its own to the same plant, for short questions that have to be answered in time: it waits only seconds for an
    /// answer.
    #[must_use]
    pub(crate) fn hasty(&self) -> Self {
        Self::new(self.0.address.hasty())
    }

    /// The plant's answer to `question`, which waits for no other question.
    ///
    /// # Errors
    /// Those of the question, and [`StoreError`] when the plant is not there, or refuses. The next question goes over a new
    /// connection.
    pub fn ask<T, E: From<StoreError>>(
        &self,
        question: impl FnOnce(&mut Plant) -> Result<T, E>,
    ) -> Result<T, E> {
        // A question that panicked has taken the connection with it.
        let mut plant = match self.take() {
            Some(plant) => plant,
            None => self.connect()?,
        };
        let answer = question(&mut plant).inspect_err(|_| self.clear())?;
        self.keep(plant);
        Ok(answer)
    }

    /// What `look` finds at one moment. A connection that has ended is replaced first.
    ///
    /// # Errors
    /// [`StoreError`] when the plant is not there, or cannot be read.
    pub(crate) fn look<T>(
        &self,
        look: impl FnOnce(&Snapshot) -> Result<T, StoreError>,
    ) -> Result<T, StoreError> {
        let now = self.snapshot()?;
        let found = look(&now);
        match now.end() {
            Some(plant) => self.keep(plant),
            None => self.clear(),
        }
        found
    }

    /// Enters a deed in the plant's audit, over a new connection: what cannot be entered is not done, and one that was kept may
    /// have ended.
    ///
    /// # Errors
    /// Like [`Self::look`].
    pub(crate) fn note(&self, deed: Deed<'_>) -> Result<(), StoreError> {
        self.connect()?.note(deed)
    }

    fn snapshot(&self) -> Result<Snapshot, StoreError> {
        match self.take().map(Snapshot::of_plant) {
            Some(Ok(now)) => return Ok(now),
            Some(Err(_)) => self.clear(),
            None => {}
        }
        Snapshot::of_plant(self.connect()?)
    }

    fn take(&self) -> Option<Plant> {
        self.0.kept.lock().pop()
    }

    fn connect(&self) -> Result<Plant, StoreError> {
        Plant::connect(&self.0.address)
    }

    /// Keeps a connection that works, unless there are enough.
    fn keep(&self, plant: Plant) {
        let mut kept = self.0.kept.lock();
        if kept.len() < KEPT {
            kept.push(plant);
        }
    }

    /// Drops all that are kept, because one has failed: whatever ended that has probably ended them, too, and each would fail whoever
    /// takes it.
    fn clear(&self) {
        let ended = mem::take(&mut *self.0.kept.lock());
        drop(ended);
    }
}
