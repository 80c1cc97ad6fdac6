//! Whether a run is dated consistently with those of other stations: a plant tells which of two judgements of a unit is the
//! later one by when they began.

use super::{SINK_OF_PLANT, Store, StoreError};
use crate::clock::HeardClock;
use crate::ids;
use crate::record::RunHead;

/// How far a date may be off: less than a board needs to get from one station to another.
pub(super) const TOLERATED_MS: i64 = 5 * 60_000;
const MINUTE_MS: u64 = 60_000;

impl Store {
    /// Notes the plant's clock, as it was heard.
    pub fn heard_plant(&mut self, clock: HeardClock) {
        self.plant_clock = Some(clock);
    }

    /// Refuses a run that a plant would take for earlier or later than it is. The dates of a station that sends nothing to a
    /// plant do not matter: its runs are in order among themselves.
    pub(super) fn refuse_misdated(&self, run: &RunHead) -> Result<(), StoreError> {
        if !self.sinks.iter().any(|sink| sink == SINK_OF_PLANT) {
            return Ok(());
        }
        let plant_ms = self.plant_clock.and_then(|plant| plant.now_ms());
        let apart_ms = plant_ms.map_or(0, |plant_ms| run.started_ms.saturating_sub(plant_ms));
        if apart_ms.abs() > TOLERATED_MS {
            // To the nearest minute: the two clocks are not read at the same moment.
            let minutes = (apart_ms.unsigned_abs() + MINUTE_MS / 2) / MINUTE_MS;
            return Err(StoreError::ClockApart { minutes });
        }
        let ahead_ms = ids::made_ms(&run.id).saturating_sub(run.started_ms);
        if ahead_ms > TOLERATED_MS {
            return Err(StoreError::DatedAhead { minutes: ahead_ms.unsigned_abs().div_ceil(MINUTE_MS) });
        }
        Ok(())
    }
}
