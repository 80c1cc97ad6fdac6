//! The lanes of a station side by side, and which of them gets a scan. Pure data: events in, effects out.
//!
//! 1. The lane whose barcode was scanned before, for one scan, if it comes soon.
//! 2. The only lane there is.
//! 3. With the order scan-then-plug: the next lane into which a board is plugged, within a minute. Boards that come
//!    together get none.
//!
//! Never silently the first free one.

mod lane;
mod pending;
mod scan;
mod words;

use std::time::Duration;

pub use lane::Lane;
pub use scan::{Act, Scan, UnknownBarcode};
pub use words::{Accepted, Effect, Event, Owes, Refusal, Shown, Starts, Word};

use pending::Pending;

use crate::plan::serial::{SerialError, SerialRule};
use crate::said::{Said, Saying};

/// How long a lane that was chosen waits for a scan. Later somebody else may scan, for the board in another lane.
pub(crate) const CHOSEN: Duration = Duration::from_secs(15);

/// What a plan says about serial numbers.
#[derive(Clone, Debug)]
pub struct Rule {
    /// The product.
    pub product: String,
    /// Which serial numbers it has.
    pub serial: SerialRule,
}

/// A lane's place on the floor.
#[derive(Clone, Debug)]
pub struct Place {
    /// Its name.
    pub name: String,
    /// How its runs are started.
    pub starts: Starts,
    /// Its plans, as indices into the station's list.
    pub plans: Vec<usize>,
}

/// What a scan led to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ScanOutcome {
    /// The lane, by its index, if it went to one.
    pub lane: Option<usize>,
    /// What is to be done there.
    pub effect: Option<Effect>,
    /// What was understood, for people.
    pub said: Said,
}

/// A scan that is refused. Nothing has changed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ScanError {
    /// It is none of the station's barcodes.
    #[error(transparent)]
    Barcode(#[from] UnknownBarcode),
    /// The scan lacks what the scanner adds to every label.
    #[error("the scan came without what the scanner adds to every label; scan the label again")]
    Incomplete,
    /// The scan is so old that another board may be in the lane by now.
    #[error("this came too late, and another board may be there by now; do it again")]
    Late,
    /// The station has no lane of this name.
    #[error("there is no lane {lane}; the lanes are {known}")]
    NoLane {
        /// What was scanned.
        lane: String,
        /// What there is.
        known: String,
    },
    /// The station has several lanes, and no lane was named before this scan.
    #[error("there are {lanes} lanes; scan the barcode of one first, HR:LANE:NAME")]
    WhichLane {
        /// How many.
        lanes: usize,
    },
    /// The lane that was named before this scan was named too long ago.
    #[error(
        "lane {lane} was chosen more than {seconds} s ago, and is not any more; choose a lane again, and scan again"
    )]
    ChoiceOver {
        /// The lane.
        lane: String,
        /// How long a choice lasts.
        seconds: u64,
    },
    /// Boards came into several lanes at once, and a serial number that waited may belong to any of them.
    #[error(
        "boards came into the lanes {lanes} at the same time, and it may be any of them; choose the board's lane"
    )]
    Together {
        /// The lanes.
        lanes: String,
    },
    /// It is no serial number.
    #[error(transparent)]
    Serial(#[from] SerialError),
    /// The serial number belongs to two plans of different products.
    #[error(
        "`{serial}` is a serial number of {first} and of {second}; have an engineer make their patterns differ"
    )]
    Ambiguous {
        /// What was scanned.
        serial: String,
        /// One product.
        first: String,
        /// Another.
        second: String,
    },
    /// The serial number is already in another lane.
    #[error("{serial} is in lane {lane} already; scan the label of the board that you hold")]
    Elsewhere {
        /// The serial number.
        serial: String,
        /// Where it is.
        lane: String,
    },
    /// The lane cannot do it now.
    #[error(transparent)]
    Lane(#[from] Refusal),
}

impl ScanError {
    /// That the station has no lane of this name, but the `known` ones.
    pub(crate) fn no_lane<'a>(lane: &str, known: impl Iterator<Item = &'a str>) -> Self {
        Self::NoLane { lane: lane.to_owned(), known: known.collect::<Vec<_>>().join(", ") }
    }

    /// That this lane is not chosen any more.
    pub(crate) fn choice_over(lane: &str) -> Self {
        Self::ChoiceOver { lane: lane.to_owned(), seconds: CHOSEN.as_secs() }
    }
}

/// The lanes of a station.
#[derive(Clone, Debug)]
pub struct Floor {
    lanes: Vec<Lane>,
    plans_of: Vec<Vec<usize>>,
    rules: Vec<Rule>,
    scan_then_plug: bool,
    /// The lane that the next scan is for, and since when.
    armed: Option<(usize, Duration)>,
    pending: Option<Pending>,
}

impl Floor {
    /// With these lanes, and the rules of all plans. `scan_then_plug` allows the third way in the head of this module.
    #[must_use]
    pub fn new(places: Vec<Place>, rules: Vec<Rule>, scan_then_plug: bool) -> Self {
        let lanes = places.iter().map(|place| Lane::new(&place.name, place.starts)).collect();
        let plans_of = places.into_iter().map(|place| place.plans).collect();
        Self { lanes, plans_of, rules, scan_then_plug, armed: None, pending: None }
    }

    /// The lanes, in their order.
    #[must_use]
    pub fn lanes(&self) -> &[Lane] {
        &self.lanes
    }

    /// Takes what `operator` scanned at the time `now`, by any clock that only goes forward.
    ///
    /// # Errors
    /// [`ScanError`] when it is refused; nothing has changed then, but that a choice whose time is over is forgotten.
    pub fn scan(&mut self, text: &str, operator: &str, now: Duration) -> Result<ScanOutcome, ScanError> {
        let scan = Scan::read(text)?;
        if matches!(scan, Scan::Lane(_)) {
            return self.scanned(scan, None, operator, now);
        }
        let armed = self.chosen(now)?;
        let answer = self.scanned(scan, armed, operator, now)?;
        self.armed = None;
        Ok(answer)
    }

    /// The lane that was chosen before. A scan that comes too late for it is for no other lane, either.
    fn chosen(&mut self, now: Duration) -> Result<Option<usize>, ScanError> {
        let has_several = self.lanes.len() > 1;
        let over = self.armed.take_if(|(_, since)| has_several && now.saturating_sub(*since) > CHOSEN);
        match over {
            Some((lane, _)) => Err(ScanError::choice_over(self.name(lane))),
            None => Ok(self.armed.map(|(lane, _)| lane)),
        }
    }

    /// Takes what `operator` scanned for this lane, whichever lane's barcode somebody else scanned before.
    ///
    /// # Errors
    /// Like [`Self::scan`].
    pub fn scan_for(
        &mut self,
        lane: usize,
        text: &str,
        operator: &str,
        now: Duration,
    ) -> Result<ScanOutcome, ScanError> {
        self.scanned(Scan::read(text)?, Some(lane), operator, now)
    }

    /// Takes what was scanned for the lane `armed`, if one was named.
    fn scanned(
        &mut self,
        scan: Scan,
        armed: Option<usize>,
        operator: &str,
        now: Duration,
    ) -> Result<ScanOutcome, ScanError> {
        match scan {
            Scan::Lane(name) => {
                let lane = self.named(&name)?;
                self.armed = Some((lane, now));
                Ok(ScanOutcome { lane: Some(lane), effect: None, said: Saying::Armed { lane: name }.into() })
            }
            Scan::Act(act) => self.act(self.meant(armed)?, act, operator),
            Scan::Mock => self.mock(self.meant(armed)?, operator),
            Scan::Serial(serial) => match self.meant(armed) {
                Ok(lane) => self.give(lane, &serial, operator),
                Err(_) if self.scan_then_plug => self.keep(serial, operator, now),
                Err(error) => Err(error),
            },
        }
    }

    /// Does with a lane what `operator` asked for, whatever it has in hand.
    ///
    /// # Errors
    /// [`ScanError::Lane`] when it cannot be done now.
    pub fn act(&mut self, lane: usize, act: Act, operator: &str) -> Result<ScanOutcome, ScanError> {
        let name = self.name(lane).to_owned();
        let waiting = self.lane(lane)?.serial().unwrap_or_default().to_owned();
        let effect = self.lane(lane)?.take(act.event(operator))?;
        let said = match act {
            Act::Start => Saying::Starts { lane: name },
            Act::Abort if effect.is_none() => Saying::Forgotten { lane: name, serial: waiting },
            Act::Abort => Saying::ToldToEnd { lane: name },
            Act::Out => Saying::TakenOut { lane: name },
            Act::In => Saying::PutBack { lane: name },
        };
        Ok(ScanOutcome { lane: Some(lane), effect, said: said.into() })
    }

    /// Does with a lane what `operator` asked for with a button of a page that showed this run or serial number `of` in it.
    ///
    /// # Errors
    /// Like [`Self::act`], and [`ScanError::Late`] when an abort would end anything else.
    pub fn press(
        &mut self,
        lane: usize,
        act: Act,
        of: &str,
        operator: &str,
    ) -> Result<ScanOutcome, ScanError> {
        if act == Act::Abort && self.lane(lane)?.has_other_than(of) {
            return Err(ScanError::Late);
        }
        self.act(lane, act, operator)
    }

    /// Takes what happened to a lane. Boards that come and go are [`Self::looked`] at.
    pub fn happened(&mut self, lane: usize, event: Event) -> Option<Effect> {
        self.lanes.get_mut(lane)?.take(event).ok()?
    }

    /// The lane that a scan is for, if `armed` was named before.
    fn meant(&self, armed: Option<usize>) -> Result<usize, ScanError> {
        let only = (self.lanes.len() == 1).then_some(0);
        armed.or(only).ok_or(ScanError::WhichLane { lanes: self.lanes.len() })
    }

    fn named(&self, name: &str) -> Result<usize, ScanError> {
        let found = self.lanes.iter().position(|lane| lane.name() == name);
        found.ok_or_else(|| ScanError::no_lane(name, self.lanes.iter().map(Lane::name)))
    }

    fn name(&self, lane: usize) -> &str {
        self.lanes.get(lane).map_or("", Lane::name)
    }

    fn lane(&mut self, lane: usize) -> Result<&mut Lane, ScanError> {
        let lanes = self.lanes.len();
        self.lanes.get_mut(lane).ok_or(ScanError::WhichLane { lanes })
    }

    /// Gives a lane the serial number that `operator` scanned.
    fn give(&mut self, lane: usize, serial: &str, operator: &str) -> Result<ScanOutcome, ScanError> {
        let plans = self.plans_of.get(lane).map_or(&[][..], Vec::as_slice);
        let accepted = self.read(plans, serial, operator)?;
        self.refuse_elsewhere(lane, &accepted)?;
        let effect = self.lane(lane)?.take(Event::Given(accepted))?;
        // Its board is found, so the next one that is plugged in is another.
        self.pending.take_if(|pending| pending.serial == serial);
        let (serial, name) = (serial.to_owned(), self.name(lane).to_owned());
        let said = match effect {
            Some(_) => Saying::Tested { serial, lane: name },
            None => Saying::Waits { serial, lane: name },
        };
        Ok(ScanOutcome { lane: Some(lane), effect, said: said.into() })
    }

    /// Has a lane judge the mock board that it owes its shift.
    fn mock(&mut self, lane: usize, operator: &str) -> Result<ScanOutcome, ScanError> {
        let (plan, serial) = self.lane(lane)?.owed_mock()?;
        let product = self.rules.get(plan).map_or_else(String::new, |rule| rule.product.clone());
        let accepted = Accepted { plan, product, serial, operator: operator.to_owned() };
        let effect = self.lane(lane)?.take(Event::Given(accepted))?;
        let said = Saying::MockJudged { lane: self.name(lane).to_owned() };
        Ok(ScanOutcome { lane: Some(lane), effect, said: said.into() })
    }

    /// Reads the serial number by the one of these plans that takes it.
    fn read(&self, plans: &[usize], serial: &str, operator: &str) -> Result<Accepted, ScanError> {
        let (mut accepted, mut refused) = (None::<Accepted>, None);
        for (plan, rule) in plans.iter().filter_map(|&plan| Some((plan, self.rules.get(plan)?))) {
            match (rule.serial.read(serial), &accepted) {
                (Ok(_), Some(first)) => {
                    let (first, second) = (first.product.clone(), rule.product.clone());
                    return Err(ScanError::Ambiguous { serial: serial.to_owned(), first, second });
                }
                (Ok(read), None) => {
                    let (product, operator) = (rule.product.clone(), operator.to_owned());
                    accepted = Some(Accepted { plan, product, serial: read.text, operator });
                }
                // A wrong check digit says more than the pattern of another product.
                (Err(error @ SerialError::CheckDigit { .. }), _) => refused = Some(error),
                (Err(error), _) => refused = refused.or(Some(error)),
            }
        }
        accepted.ok_or_else(|| refused.unwrap_or(SerialError::Empty).into())
    }

    /// Refuses a board that another lane has in hand.
    fn refuse_elsewhere(&self, lane: usize, accepted: &Accepted) -> Result<(), ScanError> {
        let is_same =
            |other: &Accepted| (&other.product, &other.serial) == (&accepted.product, &accepted.serial);
        let has = |(place, other): &(usize, &Lane)| *place != lane && other.under_test().is_some_and(is_same);
        match self.lanes.iter().enumerate().find(has) {
            None => Ok(()),
            Some((_, other)) => {
                let (serial, lane) = (accepted.serial.clone(), other.name().to_owned());
                Err(ScanError::Elsewhere { serial, lane })
            }
        }
    }
}
