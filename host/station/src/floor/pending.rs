//! A serial number that waits for the next board that is plugged in.

use std::time::Duration;

use super::{Accepted, Effect, Floor, ScanError, ScanOutcome};
use crate::said::{Said, Saying};

/// How long a serial number waits for a lane.
const WAIT: Duration = Duration::from_secs(60);

/// A serial number that waits for a lane.
#[derive(Clone, Debug)]
pub(super) struct Pending {
    pub(super) serial: String,
    /// Who scanned it.
    operator: String,
    since: Duration,
    /// The lanes into which boards came at the last look.
    came: Vec<usize>,
}

impl Pending {
    fn is_fresh(&self, now: Duration) -> bool {
        now.saturating_sub(self.since) <= WAIT
    }
}

impl Floor {
    /// The serial number that waits for a lane at the time `now`.
    #[must_use]
    pub fn pending(&self, now: Duration) -> Option<&str> {
        self.pending.as_ref().filter(|pending| pending.is_fresh(now)).map(|pending| pending.serial.as_str())
    }

    /// Takes which boards came or went, all seen at one look at the time `now`; returns what is to be done in each of these
    /// lanes. A serial number that waits belongs to the next board that is plugged in: it goes to that board's lane, or to none.
    /// Of boards that came together nobody knows which was first. They may be seen at two looks, so the number goes to its
    /// lane one look later.
    pub fn looked(&mut self, changes: &[(usize, bool)], now: Duration) -> Vec<(usize, Option<Effect>)> {
        let (mut effects, mut came) = (Vec::new(), Vec::new());
        for &(place, is_present) in changes {
            let Some(lane) = self.lanes.get_mut(place) else { continue };
            let is_new = is_present && !lane.is_present();
            let effect = lane.present(is_present);
            // A board that starts a run by itself has its serial number already.
            if is_new && effect.is_none() {
                came.push(place);
            }
            effects.push((place, effect));
        }
        if let Some(mut pending) = self.pending.take() {
            let is_second_look = !pending.came.is_empty();
            pending.came.append(&mut came);
            if is_second_look {
                effects.extend(self.plugged(pending).map(|(lane, begun)| (lane, Some(begun))));
            } else if pending.is_fresh(now) {
                self.pending = Some(pending);
            }
        }
        effects
    }

    /// Gives the only lane into which a board came the serial number that waited. If that cannot be, the lanes say why.
    fn plugged(&mut self, Pending { serial, operator, came, .. }: Pending) -> Option<(usize, Effect)> {
        let given = match came[..] {
            [lane] => self.give(lane, &serial, &operator).map(|answer| (lane, answer.effect)),
            _ => {
                let lanes = came.iter().map(|&lane| self.name(lane)).collect::<Vec<_>>().join(", ");
                Err(ScanError::Together { lanes })
            }
        };
        match given {
            // Some lanes are started by plugging the board in.
            Ok((lane, effect)) => {
                let begun = effect.or_else(|| self.lanes.get_mut(lane)?.present(true));
                Some((lane, begun?))
            }
            Err(refused) => {
                let why = Said::of(&refused);
                for lane in came {
                    let missed = Saying::NotGiven { serial: serial.clone(), why: why.clone() };
                    self.lanes.get_mut(lane)?.miss(missed.into());
                }
                None
            }
        }
    }

    /// Refuses a serial number that no lane takes by its plans. Each lane has plans of its own: two that would both take it may be in
    /// different lanes, and a board comes into one.
    fn refuse_for_all(&self, serial: &str, operator: &str) -> Result<(), ScanError> {
        let here = |accepted: &Accepted| self.refuse_elsewhere(usize::MAX, accepted);
        let by_lanes = self.plans_of.iter().filter_map(|plans| self.read(plans, serial, operator).ok());
        let any = by_lanes.map(|accepted| here(&accepted)).reduce(Result::or);
        any.unwrap_or_else(|| here(&self.read(&self.plans_of.concat(), serial, operator)?))
    }

    /// Keeps the serial number for the next lane into which a board is plugged.
    pub(super) fn keep(
        &mut self,
        serial: String,
        operator: &str,
        now: Duration,
    ) -> Result<ScanOutcome, ScanError> {
        self.refuse_for_all(&serial, operator)?;
        let said = match self.pending(now).map(str::to_owned) {
            Some(other) => Saying::WaitsInstead { serial: serial.clone(), other },
            None => Saying::WaitsForPlug { serial: serial.clone() },
        };
        self.pending = Some(Pending { serial, operator: operator.to_owned(), since: now, came: Vec::new() });
        Ok(ScanOutcome { lane: None, effect: None, said: said.into() })
    }
}
