//! The plant as a sink.

use super::{Sink, Undelivered};
use crate::said::Said;
use crate::store::{Parcel, Plant, PlantAddress, PlantError};

/// A plant, which is connected to when there is something to send.
#[derive(Debug)]
pub struct PlantSink {
    address: PlantAddress,
    plant: Option<Plant>,
}

impl PlantSink {
    /// Its name in the outbox. A plant that moves to another address keeps it.
    pub const NAME: &'static str = "plant";

    /// The plant at `address`.
    #[must_use]
    pub fn new(address: PlantAddress) -> Self {
        Self { address, plant: None }
    }
}

impl Sink for PlantSink {
    fn name(&self) -> &str {
        Self::NAME
    }

    fn take(&mut self, parcel: &Parcel) -> Result<(), Undelivered> {
        // A plant that cannot be used takes nothing else, either.
        let away = |error: PlantError| Undelivered::Away(Said::of(&error));
        let plant = match &mut self.plant {
            Some(plant) => plant,
            none => none.insert(Plant::connect(&self.address).map_err(away)?),
        };
        plant.take(parcel).map_err(|error| {
            if error.is_away() {
                self.plant = None;
                return away(error);
            }
            let said = Said::of(&error);
            match error {
                PlantError::OtherContent { .. } => Undelivered::Refused(said),
                _ => Undelivered::NotNow(said),
            }
        })
    }

    fn rest(&mut self) {
        self.plant = None;
    }
}
