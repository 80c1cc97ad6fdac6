//! What a run came to, and the exit code that says so to scripts.

use std::fmt;

use halfrow_link::Class;
use serde::{Deserialize, Deserializer, Serialize, de};

/// The judgement on a board.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub enum Verdict {
    /// Everything was judged and all was equal.
    Pass,
    /// The link was clean and the board's result differs.
    Fail,
    /// It could not be judged: the link, the station or the way it was called.
    Error,
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Pass => "PASS",
            Self::Fail => "FAIL",
            Self::Error => "ERROR",
        })
    }
}

/// How a command ended. Scripts rely on the codes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Exit {
    /// PASS, or the command did what it was asked.
    Pass = 0,
    /// FAIL.
    Fail = 1,
    /// The call or its input was wrong; there is no verdict.
    Usage = 2,
    /// ERROR.
    Error = 3,
    /// ERROR: another host holds the board.
    Busy = 4,
    /// ERROR: nothing was judged.
    NothingJudged = 5,
    /// ERROR: the board's identity, datapath or protocol version was refused.
    Refused = 6,
    /// ERROR: stopped because the terminal or connection was gone (SIGHUP).
    HungUp = 129,
    /// ERROR: stopped by Ctrl-C.
    Interrupted = 130,
    /// ERROR: stopped by SIGTERM.
    Terminated = 143,
}

impl Exit {
    /// All of them.
    pub const ALL: [Self; 10] = [
        Self::Pass,
        Self::Fail,
        Self::Usage,
        Self::Error,
        Self::Busy,
        Self::NothingJudged,
        Self::Refused,
        Self::HungUp,
        Self::Interrupted,
        Self::Terminated,
    ];

    /// The process's exit code.
    #[must_use]
    pub const fn code(self) -> u8 {
        self as u8
    }

    /// The exit of a run that a signal with this code stopped; none if none did.
    #[must_use]
    pub fn of_signal(code: usize) -> Option<Self> {
        let stops = [Self::HungUp, Self::Interrupted, Self::Terminated];
        stops.into_iter().find(|exit| usize::from(exit.code()) == code)
    }

    /// The verdict that the code carries; none after a usage error.
    #[must_use]
    pub const fn verdict(self) -> Option<Verdict> {
        match self {
            Self::Pass => Some(Verdict::Pass),
            Self::Fail => Some(Verdict::Fail),
            Self::Usage => None,
            _ => Some(Verdict::Error),
        }
    }
}

impl From<Class> for Exit {
    fn from(class: Class) -> Self {
        match class {
            Class::Call => Self::Usage,
            Class::Station => Self::Error,
            Class::Busy => Self::Busy,
        }
    }
}

impl Serialize for Exit {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_u8(self.code())
    }
}

impl<'de> Deserialize<'de> for Exit {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let code = u8::deserialize(deserializer)?;
        let known = Self::ALL.into_iter().find(|exit| exit.code() == code);
        known.ok_or_else(|| de::Error::custom(format!("{code} is no exit code of this program")))
    }
}
