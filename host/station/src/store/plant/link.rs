//! Connections to a plant, kept as long as they work.

use std::sync::Arc;

use parking_lot::Mutex;

use super::super::StoreError;
use super::{Plant, PlantAddress};

/// How many connections are kept while nobody asks.
const KEPT: usize = 4;

/// A plant that is connected to when it is asked something, and anew after an error. A clone has the same connections.
#[derive(Clone, Debug)]
pub struct PlantLink(Arc<Parts>);

#[derive(Debug)]
struct Parts {
    address: PlantAddress,
    idle: Mutex<Vec<Plant>>,
}

impl PlantLink {
    /// A link to the plant at `address`.
    #[must_use]
    pub fn new(address: PlantAddress) -> Self {
        Self(Arc::new(Parts { address, idle: Mutex::default() }))
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
    /// Those of the question, and [`StoreError`] when the plant is not there, or refuses. Its connection is used no more then.
    pub fn ask<T, E: From<StoreError>>(
        &self,
        question: impl FnOnce(&mut Plant) -> Result<T, E>,
    ) -> Result<T, E> {
        // A question that panicked has taken the connection with it.
        let kept = self.0.idle.lock().pop();
        let mut plant = match kept {
            Some(plant) => plant,
            None => Plant::connect(&self.0.address)?,
        };
        let answer = question(&mut plant)?;
        let mut idle = self.0.idle.lock();
        if idle.len() < KEPT {
            idle.push(plant);
        }
        Ok(answer)
    }
}
