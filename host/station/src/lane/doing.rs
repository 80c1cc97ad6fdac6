//! What the run of a lane does.

use std::fmt;

use halfrow::progress::{JudgedAtSpeed, Step};
use serde::{Serialize, Serializer};

use super::Message;
use crate::record::StepOutcome;

/// What a run does. Its text is for people, and may change.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Doing {
    /// The step of the plan, or the frame, of this name.
    Named(String),
    /// A step of the judge.
    Judging(Step),
    /// The board makes frames by itself.
    AtSpeed(JudgedAtSpeed),
    /// Rows come back: how many came so far, and how many are expected.
    Rows(u64, u64),
    /// A step of the plan has ended.
    Ended {
        /// Its name.
        step: String,
        /// How it ended.
        outcome: StepOutcome,
    },
    /// The board of this name was identified.
    Board(String),
    /// It waits for the place of labgrid of this name.
    Place(String),
}

impl Doing {
    /// What the lane does that reports `message`, if it says that.
    pub(crate) fn of(message: &Message) -> Option<Self> {
        match message {
            Message::Step { name, .. } | Message::Frame { name } => Some(Self::Named(name.clone())),
            Message::Judging { step } => Some(Self::Judging(*step)),
            Message::AtSpeed(judged) => Some(Self::AtSpeed(*judged)),
            Message::Rows { done, expected } => Some(Self::Rows(*done, *expected)),
            Message::Ended { step } => Some(Self::Ended { step: step.name.clone(), outcome: step.outcome }),
            Message::Identified { board } => Some(Self::Board(board.name.clone())),
            Message::Begun { .. } | Message::Done | Message::Refused { .. } => None,
        }
    }

    /// Rows that came back, and how many are expected, if it counts them.
    pub(crate) fn rows(&self) -> Option<(u64, u64)> {
        if let Self::Rows(done, expected) = self { Some((*done, *expected)) } else { None }
    }
}

impl fmt::Display for Doing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Named(name) => f.write_str(name),
            Self::Judging(step) => step.fmt(f),
            Self::AtSpeed(judged) => judged.fmt(f),
            Self::Rows(..) => f.write_str("rows"),
            Self::Ended { step, outcome } => write!(f, "{step} {outcome}"),
            Self::Board(name) => write!(f, "the board is {name}"),
            Self::Place(name) => write!(f, "waiting for the place {name}"),
        }
    }
}

/// Written as its text, with the rows.
impl Serialize for Doing {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct Told {
            what: String,
            rows: Option<(u64, u64)>,
        }
        Told { what: self.to_string(), rows: self.rows() }.serialize(serializer)
    }
}
