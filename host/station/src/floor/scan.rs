//! What a scanner reads: the station's own barcodes, and serial numbers.

use super::words::Event;
use crate::plan::mock::BARCODE;
use crate::plan::serial::RESERVED;
use crate::said::Saying;

/// What was scanned.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Scan {
    /// `HR:LANE:NAME`: the next scan is for this lane.
    Lane(String),
    /// `HR:START`, `HR:ABORT`, `HR:OUT`, `HR:IN`: something is to be done with the lane.
    Act(Act),
    /// `HR:MOCK`: the mock board with a drawn fault is to be judged in the place of a unit that is known to be bad.
    Mock,
    /// Anything else, as it is.
    Serial(String),
}

/// What a barcode or a button does with a lane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Act {
    /// Start the run whose serial number waits.
    Start,
    /// End the run, or forget the serial number that waits.
    Abort,
    /// Take the lane out of service.
    Out,
    /// Put it back.
    In,
}

impl Act {
    /// All of them, each with the end of its barcode.
    pub const ALL: [(&'static str, Self); 4] =
        [("START", Self::Start), ("ABORT", Self::Abort), ("OUT", Self::Out), ("IN", Self::In)];

    /// What a lane is asked to do when `operator` scans or presses it.
    pub(super) fn event(self, operator: &str) -> Event {
        match self {
            Self::Start => Event::Start { operator: operator.to_owned() },
            Self::Abort => Event::Abort,
            Self::Out => Event::Out { why: Saying::OutByPerson.into() },
            Self::In => Event::In,
        }
    }

    /// Its barcode.
    #[must_use]
    pub fn barcode(self) -> String {
        let word = Self::ALL.into_iter().find(|(_, act)| *act == self).map_or("", |(word, _)| word);
        format!("{RESERVED}{word}")
    }
}

/// The barcode begins like the station's own, but is none of them.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "`{text}` is no barcode of the station; scan HR:LANE:NAME, HR:START, HR:ABORT, HR:OUT, HR:IN or HR:MOCK"
)]
pub struct UnknownBarcode {
    /// What was scanned.
    pub text: String,
}

impl Scan {
    /// What `text` is. Nothing is cut off or turned into capitals.
    ///
    /// # Errors
    /// [`UnknownBarcode`]
    pub fn read(text: &str) -> Result<Self, UnknownBarcode> {
        let Some(own) = text.strip_prefix(RESERVED) else { return Ok(Self::Serial(text.to_owned())) };
        if let Some(lane) = own.strip_prefix("LANE:").filter(|lane| !lane.is_empty()) {
            return Ok(Self::Lane(lane.to_owned()));
        }
        if text == BARCODE {
            return Ok(Self::Mock);
        }
        let act = Act::ALL.into_iter().find(|(word, _)| *word == own);
        act.map(|(_, act)| Self::Act(act)).ok_or_else(|| UnknownBarcode { text: text.to_owned() })
    }

    /// Whether `text` is one of the station's own barcodes, which is nobody's badge.
    pub(crate) fn is_own(text: &str) -> bool {
        matches!(Self::read(text), Ok(Self::Lane(_) | Self::Act(_) | Self::Mock))
    }
}
