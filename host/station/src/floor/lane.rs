//! A lane's states: events go in, effects come out, and nothing else is touched.
//!
//! ```text
//!  EMPTY ─ board ─► READY ─ serial number ─► RUNNING ─► SAVING ─► PASS | FAIL | ERROR ─ next serial number ─► …
//!    └ serial number ─► WAITING ─ board or button ─┘        │                 └ next board, or of the mock ─► READY
//!                                                           └ UNSAVED ─ the disk is well ─► ERROR
//!  OUT: taken out of service by a person, or because its process cannot be killed; or it owes a check, and shows no verdict
//! ```

use std::mem::discriminant;

use crate::plan::mock::is_mock;
use crate::said::{Said, Saying};

use super::scan::Act;
use super::words::{Accepted, Effect, Event, Owes, Refusal, Shown, Starts, Word};

#[derive(Clone, Debug, PartialEq, Eq)]
enum Phase {
    Out { why: Said },
    Idle,
    Running { of: Accepted, run: Option<String> },
    Saving { of: Accepted, run: Option<String> },
    Ended,
    Unsaved { of: Accepted, run: Option<String>, why: Said, awaits_plant: bool },
}

/// A lane.
#[derive(Clone, Debug)]
pub struct Lane {
    name: String,
    starts: Starts,
    phase: Phase,
    is_present: bool,
    waiting: Option<Accepted>,
    shown: Option<Shown>,
    last: Option<Shown>,
    /// Whether another board came before the result of the run was settled.
    has_other: bool,
    note: Option<Said>,
    /// Why it did not take the serial number that waited for the board now in it.
    missed: Option<Said>,
    owes: Option<Owes>,
    /// Whether its process cannot be killed.
    is_stuck: bool,
}

impl Lane {
    /// A lane without a board.
    #[must_use]
    pub fn new(name: impl Into<String>, starts: Starts) -> Self {
        Self {
            name: name.into(),
            starts,
            phase: Phase::Idle,
            is_present: false,
            waiting: None,
            shown: None,
            last: None,
            has_other: false,
            note: None,
            missed: None,
            owes: None,
            is_stuck: false,
        }
    }

    /// Its name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its state in one word.
    #[must_use]
    pub fn word(&self) -> Word {
        match (&self.phase, &self.shown) {
            (Phase::Out { .. }, _) => Word::Out,
            (Phase::Running { .. }, _) => Word::Running,
            (Phase::Saving { .. }, _) => Word::Saving,
            (Phase::Unsaved { .. }, _) => Word::Unsaved,
            // Whatever the lane owes by now, people act on the board whose verdict is shown.
            (Phase::Ended, Some(shown)) => shown.verdict.into(),
            _ if self.waiting.is_some() => Word::Waiting,
            _ if self.owes.is_some() => Word::Out,
            _ if self.is_present => Word::Ready,
            _ => Word::Empty,
        }
    }

    /// Whether its result is saved, but not yet at the plant, which must have it.
    #[must_use]
    pub(crate) fn awaits_plant(&self) -> bool {
        matches!(self.phase, Phase::Unsaved { awaits_plant: true, .. })
    }

    /// Whether a board is in it.
    #[must_use]
    pub(crate) fn is_present(&self) -> bool {
        self.is_present
    }

    /// The serial number that it tests, that waits, or whose verdict is shown.
    #[must_use]
    pub fn serial(&self) -> Option<&str> {
        let under_test = self.under_test().map(|of| of.serial.as_str());
        under_test.or_else(|| self.shown.as_ref().map(|shown| shown.serial.as_str()))
    }

    /// The board that it has in hand: being tested, not saved yet, or waited for.
    #[must_use]
    pub(crate) fn under_test(&self) -> Option<&Accepted> {
        match &self.phase {
            Phase::Running { of, .. } | Phase::Saving { of, .. } | Phase::Unsaved { of, .. } => Some(of),
            _ => self.waiting.as_ref(),
        }
    }

    /// Whether it has something in hand that is neither the run nor the serial number `of`. A page that was drawn before the run was
    /// in the store shows only its serial number.
    pub(super) fn has_other_than(&self, of: &str) -> bool {
        self.under_test().is_some_and(|has| has.serial != of && self.run() != Some(of))
    }

    /// The plan and the serial number of the mock board, if that is what the lane has to test now.
    ///
    /// # Errors
    /// [`Refusal`] when the lane is not free, or does not owe its shift a mock board.
    pub(crate) fn owed_mock(&self) -> Result<(usize, String), Refusal> {
        self.free()?;
        let lane = self.name.clone();
        match &self.owes {
            Some(Owes { plan, serial: Some(serial), .. }) if is_mock(serial) => Ok((*plan, serial.clone())),
            Some(owes) => Err(Refusal::Owes { lane, why: owes.why.clone() }),
            None => Err(Refusal::NoMock { lane }),
        }
    }

    /// Its run that is under way or not saved.
    #[must_use]
    pub fn run(&self) -> Option<&str> {
        match &self.phase {
            Phase::Running { run, .. } | Phase::Saving { run, .. } | Phase::Unsaved { run, .. } => {
                run.as_deref()
            }
            _ => None,
        }
    }

    /// Its last verdict, which stays until the next serial number, or until another board is plugged in.
    #[must_use]
    pub fn shown(&self) -> Option<&Shown> {
        self.shown.as_ref()
    }

    /// The verdict of the board before, once another one was plugged in, or that on the mock, until the next serial number.
    #[must_use]
    pub fn last(&self) -> Option<&Shown> {
        self.last.as_ref()
    }

    /// What else there is to say: why it did not take a number, why it is out of service, what it is to test first,
    /// why nothing was saved, or why no run was begun.
    #[must_use]
    pub fn note(&self) -> Option<&Said> {
        match &self.phase {
            _ if self.missed.is_some() => self.missed.as_ref(),
            Phase::Out { why } | Phase::Unsaved { why, .. } => Some(why),
            Phase::Idle | Phase::Ended if self.owes.is_some() => self.owes.as_ref().map(|owes| &owes.why),
            _ => self.note.as_ref(),
        }
    }

    /// Why its last scan came to nothing, where [`Self::note`] says what it is to test first.
    #[must_use]
    pub fn refused(&self) -> Option<&Said> {
        let owes_note = matches!(self.phase, Phase::Idle | Phase::Ended) && self.owes.is_some();
        self.note.as_ref().filter(|_| owes_note && self.missed.is_none())
    }

    /// Keeps the reason why it did not take the serial number of the board that came, as long as that board stays
    /// without one and the lane has nothing new to say.
    pub(super) fn miss(&mut self, why: Said) {
        self.missed = Some(why);
    }

    /// What a barcode or a button can do with it now.
    #[must_use]
    pub fn can(&self) -> Vec<Act> {
        let is_taken = |act: &Act| self.clone().take(act.event("")).is_ok();
        Act::ALL.into_iter().map(|(_, act)| act).filter(is_taken).collect()
    }

    /// Takes an event.
    ///
    /// # Errors
    /// [`Refusal`] when it cannot be now; nothing has changed then.
    pub fn take(&mut self, event: Event) -> Result<Option<Effect>, Refusal> {
        match event {
            Event::Given(accepted) => self.given(accepted),
            Event::Start { operator } => self.start(operator),
            Event::Abort => self.abort(),
            Event::Out { why } => self.free().map(|()| {
                (self.waiting, self.missed) = (None, None);
                self.phase = Phase::Out { why };
                None
            }),
            Event::In => self.back(),
            Event::Owes(owes) => {
                // What waits was accepted before, and would start without being checked again.
                let is_owed = |of: &Accepted| owes.as_ref().is_none_or(|owes| owes.is(of));
                self.waiting = self.waiting.take().filter(is_owed);
                self.owes = owes;
                Ok(None)
            }
            report => Ok(self.reported(report)),
        }
    }

    /// Whether it can take on something new.
    ///
    /// # Errors
    /// [`Refusal`] why not.
    pub fn free(&self) -> Result<(), Refusal> {
        let lane = self.name.clone();
        match &self.phase {
            Phase::Idle | Phase::Ended => Ok(()),
            Phase::Out { why } => Err(Refusal::Out { lane, why: why.clone() }),
            Phase::Running { of, .. } | Phase::Saving { of, .. } => {
                Err(Refusal::Busy { lane, serial: of.serial.clone() })
            }
            Phase::Unsaved { of, .. } => Err(Refusal::Unsaved { lane, serial: of.serial.clone() }),
        }
    }

    fn begin(&mut self, of: Accepted) -> Effect {
        (self.waiting, self.note, self.missed) = (None, None, None);
        (self.shown, self.last, self.has_other) = (None, None, false);
        self.phase = Phase::Running { of: of.clone(), run: None };
        Effect::Begin(of)
    }

    /// Takes that a board came, or went away.
    pub(super) fn present(&mut self, is_present: bool) -> Option<Effect> {
        if is_present && !self.is_present {
            self.came();
        }
        self.is_present = is_present;
        if !is_present {
            self.missed = None;
        }
        if !is_present && !self.starts.presence {
            // The serial number belonged to the board that is gone.
            self.waiting = None;
        }
        let starts = is_present && self.starts.presence && self.phase == Phase::Idle;
        let waiting = if starts { self.waiting.take() } else { None };
        waiting.map(|of| self.begin(of))
    }

    /// A board is there again: no verdict is shown over it until it was judged itself.
    fn came(&mut self) {
        match &self.phase {
            // No run waits for its board to come back, so this one's result is that of the board before.
            Phase::Running { .. } | Phase::Saving { .. } | Phase::Unsaved { .. } => self.has_other = true,
            Phase::Idle | Phase::Ended | Phase::Out { .. } => {
                self.last = self.shown.take().or_else(|| self.last.take());
                if self.phase == Phase::Ended {
                    self.phase = Phase::Idle;
                }
            }
        }
    }

    fn given(&mut self, accepted: Accepted) -> Result<Option<Effect>, Refusal> {
        self.free()?;
        if let Some(owes) = self.owes.as_ref().filter(|owes| !owes.is(&accepted)) {
            return Err(Refusal::Owes { lane: self.name.clone(), why: owes.why.clone() });
        }
        // The mock needs no fixture.
        if self.starts.scan && self.is_present || is_mock(&accepted.serial) {
            return Ok(Some(self.begin(accepted)));
        }
        if !self.is_present && !self.starts.presence {
            return Err(Refusal::NoBoard { lane: self.name.clone() });
        }
        (self.waiting, self.note, self.missed) = (Some(accepted), None, None);
        (self.shown, self.last) = (None, None);
        self.phase = Phase::Idle;
        Ok(None)
    }

    fn start(&mut self, operator: String) -> Result<Option<Effect>, Refusal> {
        self.free()?;
        let lane = self.name.clone();
        if !self.starts.button {
            return Err(Refusal::NoButton { lane });
        }
        if !self.is_present {
            return Err(Refusal::NoBoard { lane });
        }
        let waiting = self.waiting.take().ok_or(Refusal::NoSerial { lane })?;
        Ok(Some(self.begin(Accepted { operator, ..waiting })))
    }

    fn abort(&mut self) -> Result<Option<Effect>, Refusal> {
        let nothing = Refusal::NothingToAbort { lane: self.name.clone() };
        match self.phase {
            Phase::Running { .. } => Ok(Some(Effect::Stop)),
            _ => self.waiting.take().map(|_| None).ok_or(nothing),
        }
    }

    fn back(&mut self) -> Result<Option<Effect>, Refusal> {
        if !matches!(self.phase, Phase::Out { .. }) {
            return Err(Refusal::InService { lane: self.name.clone() });
        }
        // Whoever puts it back has dealt with the process.
        self.is_stuck = false;
        self.phase = if self.shown.is_some() { Phase::Ended } else { Phase::Idle };
        Ok(None)
    }

    /// The phase after a verdict, which is shown over no other board. No board has the verdict on the mock, so no lamp
    /// and no label does, either.
    fn ended(&mut self, shown: Shown) -> (Phase, Option<Effect>) {
        let effect = (!shown.is_on_mock()).then(|| Effect::Hooks(shown.clone()));
        let (of, phase) = if self.has_other || shown.is_on_mock() {
            (&mut self.last, Phase::Idle)
        } else {
            (&mut self.shown, Phase::Ended)
        };
        *of = Some(shown);
        (phase, effect)
    }

    /// Takes what its run reports. A report that does not fit the phase is late, and changes nothing.
    fn reported(&mut self, event: Event) -> Option<Effect> {
        let before = discriminant(&self.phase);
        let awaits_plant = matches!(event, Event::NotAtPlant { .. });
        let phase = std::mem::replace(&mut self.phase, Phase::Idle);
        let (phase, effect) = match (phase, event) {
            (Phase::Running { of, .. }, Event::Begun { run }) => {
                (Phase::Running { of, run: Some(run) }, None)
            }
            (Phase::Running { of, run }, Event::Saving) => (Phase::Saving { of, run }, None),
            (Phase::Running { .. } | Phase::Saving { .. }, Event::NotBegun { why }) => {
                self.note = Some(why);
                (Phase::Idle, None)
            }
            (Phase::Running { .. } | Phase::Saving { .. } | Phase::Unsaved { .. }, Event::Ended(shown)) => {
                self.ended(shown)
            }
            (
                Phase::Running { of, run } | Phase::Saving { of, run } | Phase::Unsaved { of, run, .. },
                Event::Unsaved { why } | Event::NotAtPlant { why },
            ) => {
                let effect = run.clone().map(|run| Effect::Recover { run });
                (Phase::Unsaved { of, run, why, awaits_plant }, effect)
            }
            (phase, Event::Stuck) => {
                self.is_stuck = true;
                (phase, None)
            }
            (phase, _) => (phase, None),
        };
        // Its result is settled first.
        let is_settled = matches!(phase, Phase::Idle | Phase::Ended);
        self.phase =
            if is_settled && self.is_stuck { Phase::Out { why: Saying::Unkillable.into() } } else { phase };
        let has_reason = matches!(self.phase, Phase::Out { .. } | Phase::Unsaved { .. });
        if has_reason && discriminant(&self.phase) != before {
            self.missed = None;
        }
        effect
    }
}
