//! Connections to a plant, kept as long as they work.

use std::sync::Arc;

use super::super::StoreError;
use super::idle::Idle;
use super::{Plant, PlantAddress};

/// A plant that is connected to when it is asked something, and anew after an error. A clone has the same connections.
#[derive(Clone, Debug)]
pub struct PlantLink(Arc<Idle>);

impl PlantLink {
    /// A link to the plant at `address`.
    #[must_use]
    pub fn new(address: PlantAddress) -> Self {
        Self(Arc::new(Idle::new(address)))
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
        let mut plant = match self.0.take() {
            Some(plant) => plant,
            None => self.0.connect()?,
        };
        let answer = question(&mut plant).inspect_err(|_| self.0.clear())?;
        self.0.keep(plant);
        Ok(answer)
    }
}
