//! The checks of a run and their outcomes.

use std::fmt;

use serde::ser::SerializeStruct;
use serde::{Deserialize, Serialize, Serializer};

use super::Finding;

/// Every check of a run, in its order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CheckName {
    /// Checks that this computer and this program calculate correctly, before any board is judged.
    Judge,
    /// Reads from the board what it is, and checks that it can be judged.
    Identity,
    /// Sends bytes to the board and checks that they come back unchanged.
    Link,
    /// Sends the size of the frames and the tables to the board.
    Upload,
    /// Reads the tables back through the datapath's own ports and compares them.
    ReadBack,
    /// Compares every sample of every frame with the reference.
    Frames,
    /// Checks the latency of every row.
    Latency,
    /// Checks the tables once more after the last frame.
    TablesAfter,
    /// Compares the board's own counters with what was sent and received.
    Counters,
    /// Compares frames that the board makes on its own at the full pixel clock.
    AtSpeed,
    /// Tests the rules of the wire protocol: what the board must refuse, keep and end.
    Rules,
}

impl CheckName {
    /// All checks, in the order of a run.
    pub const ALL: [Self; 11] = [
        Self::Judge,
        Self::Identity,
        Self::Link,
        Self::Upload,
        Self::ReadBack,
        Self::Frames,
        Self::Latency,
        Self::TablesAfter,
        Self::Counters,
        Self::AtSpeed,
        Self::Rules,
    ];

    /// The name that people and JSON use.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Judge => "judge",
            Self::Identity => "identity",
            Self::Link => "link",
            Self::Upload => "upload",
            Self::ReadBack => "read-back",
            Self::Frames => "frames",
            Self::Latency => "latency",
            Self::TablesAfter => "tables-after",
            Self::Counters => "counters",
            Self::AtSpeed => "at-speed",
            Self::Rules => "rules",
        }
    }
}

impl fmt::Display for CheckName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// One thing that was checked.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Check {
    /// Which check it is.
    pub name: CheckName,
    /// How it came out.
    pub outcome: Outcome,
    /// What was found.
    pub finding: Finding,
    /// How long it took on the wall clock, in seconds, without the frames' own time.
    pub seconds: f64,
}

impl Check {
    /// What was found, in one sentence.
    #[must_use]
    pub fn detail(&self) -> String {
        self.finding.sentence()
    }
}

impl Serialize for Check {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut check = serializer.serialize_struct("Check", 5)?;
        check.serialize_field("name", &self.name)?;
        check.serialize_field("outcome", &self.outcome)?;
        check.serialize_field("detail", &self.detail())?;
        check.serialize_field("finding", &self.finding)?;
        check.serialize_field("seconds", &self.seconds)?;
        check.end()
    }
}

/// How a check came out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Outcome {
    /// As it should be.
    Passed,
    /// The board is wrong.
    Failed,
    /// It could not be checked.
    Error,
    /// It was not reached.
    Skipped,
}
