//! The plant as a sink.

use super::{Sink, Undelivered};
use crate::clock::HeardClock;
use crate::said::Said;
use crate::store::{Folder, Introduction, Parcel, Plant, PlantAddress, PlantError, SINK_OF_PLANT};

/// A plant, which is connected to when there is something to send.
#[derive(Debug)]
pub struct PlantSink {
    address: PlantAddress,
    station: Introduction,
    /// What the station keeps, and which of it the plant has.
    kept: Folder,
    plant: Option<Plant>,
    /// The plant's clock, heard when the plant was last told of this station; `None` if it has to be told first.
    clock: Option<HeardClock>,
}

impl PlantSink {
    /// The plant at `address`, which is told of `station`, whose folder is `kept`.
    #[must_use]
    pub fn new(address: PlantAddress, station: Introduction, kept: Folder) -> Self {
        Self { address, station, kept, plant: None, clock: None }
    }

    /// The plant, which has been told of this station, and still has what it had.
    fn plant(&mut self) -> Result<&mut Plant, PlantError> {
        let plant = match self.plant.take() {
            Some(plant) if self.clock.is_some() => plant,
            kept => {
                let mut plant = kept.map_or_else(|| Plant::connect(&self.address), Ok)?;
                let clock = plant.see(&self.station)?;
                if let Some(run) = self.kept.newest_sent(SINK_OF_PLANT)? {
                    plant.refuse_loss_of(&run)?;
                }
                self.clock = Some(clock);
                plant
            }
        };
        Ok(self.plant.insert(plant))
    }
}

impl Sink for PlantSink {
    fn name(&self) -> &str {
        SINK_OF_PLANT
    }

    fn take(&mut self, parcel: &Parcel) -> Result<(), Undelivered> {
        // A plant that cannot be used takes nothing else, either.
        let away = |error: PlantError| Undelivered::Away(Said::of(&error));
        let plant = self.plant().map_err(away)?;
        plant.take(parcel).map_err(|error| {
            if error.is_away() || error.is_of_other_version() {
                self.plant = None;
                return away(error);
            }
            let said = Said::of(&error);
            match error {
                PlantError::NotYet { .. } => Undelivered::Early(said),
                error if error.is_final() => Undelivered::Refused(said),
                _ => Undelivered::NotNow(said),
            }
        })
    }

    fn beat(&mut self, unsent: u32, dead: u32) -> Result<Option<HeardClock>, Said> {
        (self.station.unsent, self.station.dead, self.clock) = (unsent, dead, None);
        self.plant().map_err(|error| Said::of(&error))?;
        Ok(self.clock)
    }

    fn rest(&mut self) {
        self.plant = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::store::LastTold;

    /// The plant shows both next to the station's name, and the second one calls for a person.
    #[test]
    fn a_plant_hears_how_much_waits_and_how_much_of_that_for_a_person() {
        let introduction = Introduction {
            name: "12".to_owned(),
            origin: "here".to_owned(),
            program: "0".to_owned(),
            plans: String::new(),
            unsent: 0,
            dead: 0,
            told: LastTold::default(),
        };
        // Nothing answers there.
        let address = PlantAddress::new("postgres://halfrow@127.0.0.1:1/plant", None, None).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let mut sink = PlantSink::new(address, introduction, Folder::new(folder.path()));
        sink.beat(7, 2).unwrap_err();
        assert_eq!((sink.station.unsent, sink.station.dead), (7, 2));
    }
}
