//! What happens to a lane, what is to be done then, and what is said about it.

use halfrow::Verdict;
use halfrow::target::BoardKind;
use serde::Serialize;
use strum::{AsRefStr, VariantArray};

use crate::plan::mock::is_mock;
use crate::said::Said;

/// How runs of a lane are started.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Starts {
    /// By the serial number of the board that is in it.
    pub scan: bool,
    /// By a button, once the serial number is there.
    pub button: bool,
    /// By plugging the board in, once the serial number is there.
    pub presence: bool,
}

/// A serial number that a plan of the lane takes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Accepted {
    /// The plan, as an index into the station's list.
    pub plan: usize,
    /// The product.
    pub product: String,
    /// The serial number.
    pub serial: String,
    /// Who scanned it, or started its run by the button: the record names them.
    pub operator: String,
}

/// A verdict that is saved, and may be shown. There is none without the hash of its record.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Shown {
    /// The run.
    pub run: String,
    /// The serial number.
    pub serial: String,
    /// The verdict.
    pub verdict: Verdict,
    /// The hash of the record, as it was read back.
    pub record_sha256: String,
    /// Why, in one sentence.
    pub headline: String,
    /// What to do next.
    pub remedy: Option<String>,
    /// The headline with its code, where the record has one.
    pub finding: Option<Said>,
    /// When it was saved, in milliseconds since 1970, UTC.
    pub saved_ms: i64,
    /// What kind of board was judged, such as `hardware` or `mock`, if it said so.
    pub board_kind: Option<String>,
    /// Whether it could be checked that the board has this serial number.
    pub is_identity_checked: bool,
}

impl Shown {
    /// Whether no real board was judged, as far as is known.
    #[must_use]
    pub(crate) fn is_of_no_hardware(&self) -> bool {
        self.board_kind.as_ref().is_some_and(|kind| *kind != BoardKind::Hardware.to_string())
    }

    /// Whether it is a verdict on the mock that checks a shift, and so on no board in a lane.
    #[must_use]
    pub(crate) fn is_on_mock(&self) -> bool {
        self.verdict != Verdict::Error && is_mock(&self.serial)
    }
}

/// A lane's state, as people see it; in lower case for other programs, and in the style sheet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, AsRefStr, VariantArray)]
#[serde(rename_all = "UPPERCASE")]
#[strum(serialize_all = "lowercase")]
pub enum Word {
    /// No board.
    Empty,
    /// A board, and no serial number.
    Ready,
    /// A serial number that waits for its board, or for the button.
    Waiting,
    /// A run is under way.
    Running,
    /// It is over, and its result is being saved.
    Saving,
    /// The last run's verdict, until the next serial number or the next board.
    Pass,
    /// As above.
    Fail,
    /// As above.
    Error,
    /// The last run's result could not be saved: there is none.
    Unsaved,
    /// Out of service, or its shift is to be checked first and it shows no verdict.
    Out,
}

impl From<Verdict> for Word {
    fn from(verdict: Verdict) -> Self {
        match verdict {
            Verdict::Pass => Self::Pass,
            Verdict::Fail => Self::Fail,
            Verdict::Error => Self::Error,
        }
    }
}

impl Word {
    /// Whether it is a verdict on the board in the lane, or on the one that was there last.
    #[must_use]
    pub(crate) const fn is_verdict(self) -> bool {
        matches!(self, Self::Pass | Self::Fail | Self::Error)
    }
}

/// What happens to a lane.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Event {
    /// A serial number for it.
    Given(Accepted),
    /// The button was pressed.
    Start {
        /// Who pressed it.
        operator: String,
    },
    /// Somebody wants the run to end, or the serial number to be forgotten.
    Abort,
    /// Somebody takes it out of service.
    Out {
        /// Why.
        why: Said,
    },
    /// Somebody puts it back.
    In,
    /// Its run is in the store.
    Begun {
        /// The run.
        run: String,
    },
    /// Its run could not even be entered; the board was not touched.
    NotBegun {
        /// Why.
        why: Said,
    },
    /// Its run's process has ended.
    Saving,
    /// Its run's verdict is saved.
    Ended(Shown),
    /// Its run's result is not saved.
    Unsaved {
        /// Why.
        why: Said,
    },
    /// Its run's result is saved, but not at the plant, which must have it.
    NotAtPlant {
        /// Why.
        why: Said,
    },
    /// Its process cannot be killed, and may still have the board: it is out of service as soon as its result is settled.
    Stuck,
    /// What it is to do before its production counts, if anything.
    Owes(Option<Owes>),
}

/// A unit that a lane is to test before any other.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Owes {
    /// The plan, as an index into the station's list.
    pub plan: usize,
    /// The serial number of the unit; `None` when it cannot be found out.
    pub serial: Option<String>,
    /// Why.
    pub why: Said,
}

impl Owes {
    /// Whether this is the unit.
    #[must_use]
    pub fn is(&self, of: &Accepted) -> bool {
        (self.plan, self.serial.as_deref()) == (of.plan, Some(of.serial.as_str()))
    }
}

/// What is to be done.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Effect {
    /// Begin a run.
    Begin(Accepted),
    /// Tell the run to end.
    Stop,
    /// Try to save what is not saved.
    Recover {
        /// The run.
        run: String,
    },
    /// Light lamps, print labels.
    Hooks(Shown),
}

/// Something that a lane cannot do now.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Refusal {
    /// The lane is out of service.
    #[error("lane {lane} is out of service: {why}; put it back with HR:IN, or take another lane")]
    Out {
        /// The lane.
        lane: String,
        /// Why.
        why: Said,
    },
    /// The lane is out of service because it was not checked in this shift.
    #[error("lane {lane} is out of service: {why}")]
    Owes {
        /// The lane.
        lane: String,
        /// What is to be done.
        why: Said,
    },
    /// The lane does not need a check by a mock board now.
    #[error("lane {lane} needs no check by a mock board now; scan the label of the board in it")]
    NoMock {
        /// The lane.
        lane: String,
    },
    /// A run is under way in the lane.
    #[error("lane {lane} is testing {serial}; wait until it is done, or abort it")]
    Busy {
        /// The lane.
        lane: String,
        /// What it tests.
        serial: String,
    },
    /// The result of the lane's last run is not saved.
    #[error(
        "lane {lane} holds {serial}, whose result is not saved; keep this board apart, and call an engineer"
    )]
    Unsaved {
        /// The lane.
        lane: String,
        /// What it tested.
        serial: String,
    },
    /// There is no board in the lane.
    #[error("there is no board in lane {lane}; plug it in, and scan it again")]
    NoBoard {
        /// The lane.
        lane: String,
    },
    /// The lane has no serial number to start a run with.
    #[error("lane {lane} has no serial number; scan the board's label")]
    NoSerial {
        /// The lane.
        lane: String,
    },
    /// The lane is not started by a button.
    #[error("lane {lane} is not started by a button; see `start` in the station's settings")]
    NoButton {
        /// The lane.
        lane: String,
    },
    /// No run is under way in the lane.
    #[error("nothing is under way in lane {lane}")]
    NothingToAbort {
        /// The lane.
        lane: String,
    },
    /// The lane is already in service.
    #[error("lane {lane} is in service already")]
    InService {
        /// The lane.
        lane: String,
    },
}
