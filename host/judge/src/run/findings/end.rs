//! Why a run ended.

use std::error::Error;

use halfrow_protocol::message::RowPlace;

use crate::board::{BoardError, Shown};
use crate::result::{CheckName, Finding, Outcome, PlacedRow, Problem, Suspect};
use crate::run::NoThread;
use crate::verdict::Cause;

/// Why a run ended before its last step, or with a wrong board.
#[derive(Clone, Debug)]
pub(crate) enum End {
    /// The board is wrong. No link can have caused it, whatever it did, if that is `beyond_links`.
    Failed { check: CheckName, finding: Finding, suspects: Vec<Suspect>, beyond_links: bool },
    /// It could not be judged.
    Error { check: CheckName, cause: Cause, finding: Finding, shown: Option<Shown> },
}

impl End {
    /// The run could not go on because the board could not be driven. If a row came back with a place that was never sent, the board
    /// is wrong: it came whole, under the number of a row that was.
    pub(crate) fn board(check: CheckName, error: &BoardError) -> Self {
        let rules = check == CheckName::Rules;
        let placed = |place: &RowPlace| PlacedRow { row: place.row, frame: place.frame, rules };
        let finding = match error {
            BoardError::WrongPlace { place } => {
                return Self::failed(check, Finding::RowMisplaced(placed(place)));
            }
            BoardError::RowMissing { place, .. } => Finding::RowStayedAway(placed(place)),
            _ => Problem::of(error).into(),
        };
        Self::Error { check, cause: error.cause(), finding, shown: error.shown() }
    }

    /// The run could not go on because of something at the station.
    pub(crate) fn station(check: CheckName, error: &(dyn Error + 'static)) -> Self {
        Self::error(check, Cause::Station, Problem::of(error))
    }

    pub(crate) fn error(check: CheckName, cause: Cause, finding: impl Into<Finding>) -> Self {
        Self::Error { check, cause, finding: finding.into(), shown: None }
    }

    pub(crate) fn failed(check: CheckName, finding: Finding) -> Self {
        Self::suspecting(check, finding, Vec::new())
    }

    /// The board is wrong, perhaps because of one of `suspects`.
    pub(crate) fn suspecting(check: CheckName, finding: Finding, suspects: Vec<Suspect>) -> Self {
        Self::Failed { check, finding, suspects, beyond_links: false }
    }

    /// The same, which no link can have caused if the board is wrong.
    pub(crate) fn beyond_links(mut self) -> Self {
        if let Self::Failed { beyond_links, .. } = &mut self {
            *beyond_links = true;
        }
        self
    }

    /// The same with what was found `within` another finding, if the board is wrong.
    pub(crate) fn failed_as(self, within: impl FnOnce(Box<Finding>) -> Finding) -> Self {
        match self {
            Self::Failed { check, finding, suspects, beyond_links } => {
                Self::Failed { check, finding: within(Box::new(finding)), suspects, beyond_links }
            }
            Self::Error { .. } => self,
        }
    }

    /// The check that ended the run.
    pub(crate) fn check(&self) -> CheckName {
        match self {
            Self::Failed { check, .. } | Self::Error { check, .. } => *check,
        }
    }

    /// That check's outcome.
    pub(crate) fn outcome(&self) -> Outcome {
        match self {
            Self::Failed { .. } => Outcome::Failed,
            Self::Error { .. } => Outcome::Error,
        }
    }

    /// What it found.
    pub(crate) fn finding(&self) -> &Finding {
        match self {
            Self::Failed { finding, .. } | Self::Error { finding, .. } => finding,
        }
    }

    pub(crate) fn is_failed(&self) -> bool {
        matches!(self, Self::Failed { .. })
    }

    /// Whether no link can have caused it, whatever it did.
    pub(crate) fn is_beyond_links(&self) -> bool {
        matches!(self, Self::Failed { beyond_links: true, .. })
    }

    fn shown(&self) -> Option<Shown> {
        match self {
            Self::Failed { .. } => None,
            Self::Error { shown, .. } => *shown,
        }
    }

    /// Whether the board gave an answer that no sound board gives after what the run asked of it.
    pub(crate) fn is_answer(&self) -> bool {
        self.shown().is_some_and(Shown::is_answer)
    }

    /// Whether the board refused a row of the run because it was beyond the window.
    pub(crate) fn is_without_credit(&self) -> bool {
        self.shown() == Some(Shown::NoCredit)
    }

    /// Whether the board refused a row or a burst because it had no configuration or no tables.
    pub(crate) fn is_not_ready(&self) -> bool {
        self.shown() == Some(Shown::NotReady)
    }

    pub(crate) fn is_unreachable(&self) -> bool {
        matches!(self.shown(), Some(Shown::Outage | Shown::Unreachable))
    }

    /// Whether the board went away and may come back.
    pub(crate) fn is_outage(&self) -> bool {
        self.shown() == Some(Shown::Outage)
    }
}

/// The result of something that a check needs.
pub(crate) trait During<T> {
    /// Ends the run in `check` if it failed.
    fn during(self, check: CheckName) -> Result<T, End>;
}

impl<T> During<T> for Result<T, BoardError> {
    fn during(self, check: CheckName) -> Result<T, End> {
        self.map_err(|error| End::board(check, &error))
    }
}

impl<T> During<T> for Result<T, NoThread> {
    fn during(self, check: CheckName) -> Result<T, End> {
        self.map_err(|error| End::station(check, &error))
    }
}
