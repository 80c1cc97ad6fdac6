//! A connection to a plant, kept as long as it works.

use std::sync::Arc;

use parking_lot::Mutex;

use super::super::StoreError;
use super::{Plant, PlantAddress};

/// A plant that is connected to when it is asked something, and anew after an error. A clone has the same connection.
#[derive(Clone, Debug)]
pub struct PlantLink(Arc<Parts>);

#[derive(Debug)]
struct Parts {
    address: PlantAddress,
    plant: Mutex<Option<Plant>>,
}

impl PlantLink {
    /// A link to the plant at `address`.
    #[must_use]
    pub fn new(address: PlantAddress) -> Self {
        Self(Arc::new(Parts { address, plant: Mutex::default() }))
    }

    /// A link of its own to the same plant, for short questions that have to be answered in time: it waits for no other question,
    /// and only seconds for an answer.
    #[must_use]
    pub(crate) fn hasty(&self) -> Self {
        Self::new(self.0.address.hasty())
    }

    /// The plant's answer to `question`. Other questions wait meanwhile.
    ///
    /// # Errors
    /// Those of the question, and [`StoreError`] when the plant is not there, or refuses. The next question goes over a new
    /// connection.
    pub fn ask<T, E: From<StoreError>>(
        &self,
        question: impl FnOnce(&mut Plant) -> Result<T, E>,
    ) -> Result<T, E> {
        // A question that panicked has taken the connection with it.
        let mut kept = self.0.plant.lock();
        let mut plant = match kept.take() {
            Some(plant) => plant,
            None => Plant::connect(&self.0.address)?,
        };
        let answer = question(&mut plant)?;
        *kept = Some(plant);
        Ok(answer)
    }
}
