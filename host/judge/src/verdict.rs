//! The verdict of a run, and its cause.

use std::fmt;

use serde::{Deserialize, Deserializer, Serialize, Serializer, de};

use crate::link::Class;

/// The judgement on a board.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub enum Verdict {
    /// Everything was judged, and all of it was right.
    Pass,
    /// The board was judged, and it is wrong: the link, the station and the call were in order.
    Fail,
    /// The board could not be judged, because of the link, the station or the call.
    Error,
}

impl Verdict {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Pass, Self::Fail, Self::Error];

    /// Its name: stable, upper case.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Pass => "PASS",
            Self::Fail => "FAIL",
            Self::Error => "ERROR",
        }
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// Why a run ended as it did, in classes that call for different actions. In JSON it is its [`Cause::name`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Cause {
    /// PASS: all that was judged is equal.
    Equal,
    /// FAIL: the board is wrong.
    Different,
    /// ERROR: the link, the station or this computer.
    Station,
    /// ERROR: somebody else has the board, or the link to it.
    Busy,
    /// ERROR: the board's identity, datapath or protocol version was refused.
    Refused,
    /// ERROR: nothing was judged.
    NothingJudged,
    /// ERROR: somebody ended the run.
    Stopped(StoppedBy),
}

/// Who ended a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum StoppedBy {
    /// The person who watches it.
    Person,
    /// The system, or whatever supervises the program.
    System,
    /// Nobody: the terminal or connection that it was watched from went away.
    Disconnection,
    /// The program that calls this library.
    Caller,
}

/// The cause of a run whose board cannot be opened.
impl From<Class> for Cause {
    fn from(class: Class) -> Self {
        match class {
            Class::Call | Class::Station => Self::Station,
            Class::Busy => Self::Busy,
        }
    }
}

impl Cause {
    /// All causes.
    pub const ALL: [Self; 10] = [
        Self::Equal,
        Self::Different,
        Self::Station,
        Self::Busy,
        Self::Refused,
        Self::NothingJudged,
        Self::Stopped(StoppedBy::Person),
        Self::Stopped(StoppedBy::System),
        Self::Stopped(StoppedBy::Disconnection),
        Self::Stopped(StoppedBy::Caller),
    ];

    /// The verdict that follows from it.
    #[must_use]
    pub const fn verdict(self) -> Verdict {
        match self {
            Self::Equal => Verdict::Pass,
            Self::Different => Verdict::Fail,
            Self::Station | Self::Busy | Self::Refused | Self::NothingJudged | Self::Stopped(_) => {
                Verdict::Error
            }
        }
    }

    /// Its name: stable, lower case.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Equal => "equal",
            Self::Different => "different",
            Self::Station => "station",
            Self::Busy => "busy",
            Self::Refused => "refused",
            Self::NothingJudged => "nothing-judged",
            Self::Stopped(StoppedBy::Person) => "stopped-by-person",
            Self::Stopped(StoppedBy::System) => "stopped-by-system",
            Self::Stopped(StoppedBy::Disconnection) => "stopped-by-disconnection",
            Self::Stopped(StoppedBy::Caller) => "stopped-by-caller",
        }
    }
}

impl fmt::Display for Cause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl fmt::Display for StoppedBy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Person => "stopped by hand",
            Self::System => "stopped by the system",
            Self::Disconnection => "stopped because the terminal or connection is gone",
            Self::Caller => "stopped by the program that started it",
        })
    }
}

impl Serialize for Cause {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

impl<'de> Deserialize<'de> for Cause {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let name = String::deserialize(deserializer)?;
        let known = Self::ALL.into_iter().find(|cause| cause.name() == name);
        known.ok_or_else(|| de::Error::custom(format!("`{name}` is no cause; take one of {}", names())))
    }
}

fn names() -> String {
    Cause::ALL.map(Cause::name).join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cause_is_read_back_from_its_name_and_nothing_else_is() {
        for cause in Cause::ALL {
            let written = serde_json::to_string(&cause).unwrap();
            assert_eq!(serde_json::from_str::<Cause>(&written).unwrap(), cause);
        }
        let refused = serde_json::from_str::<Cause>("\"dunno\"").unwrap_err().to_string();
        assert!(refused.contains("`dunno` is no cause") && refused.contains("nothing-judged"), "{refused}");
    }
}
