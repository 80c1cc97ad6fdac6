//! Exit codes, which scripts rely on: those of `halfrow verify`.

use halfrow::verdict::{Cause, StoppedBy};

/// How a command ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Exit {
    /// PASS, or the command did what it was asked.
    Pass = 0,
    /// FAIL.
    Fail = 1,
    /// The call or its input was wrong; there is no verdict, and no run.
    Usage = 2,
    /// ERROR, or a result that could not be saved.
    Error = 3,
    /// ERROR: somebody else has the board, or the station.
    Busy = 4,
    /// ERROR: nothing was judged.
    NothingJudged = 5,
    /// ERROR: the board's identity, datapath or protocol version was refused.
    Refused = 6,
    /// ERROR: stopped since the terminal or connection was gone (SIGHUP).
    HungUp = 129,
    /// ERROR: stopped by Ctrl-C.
    Interrupted = 130,
    /// ERROR: stopped by SIGTERM.
    Terminated = 143,
}

impl Exit {
    /// The process's exit code.
    #[must_use]
    pub const fn code(self) -> u8 {
        self as u8
    }
}

impl From<Cause> for Exit {
    fn from(cause: Cause) -> Self {
        match cause {
            Cause::Equal => Self::Pass,
            Cause::Different => Self::Fail,
            Cause::Station => Self::Error,
            Cause::Busy => Self::Busy,
            Cause::Refused => Self::Refused,
            Cause::NothingJudged => Self::NothingJudged,
            Cause::Stopped(StoppedBy::Person | StoppedBy::Caller) => Self::Interrupted,
            Cause::Stopped(StoppedBy::System) => Self::Terminated,
            Cause::Stopped(StoppedBy::Disconnection) => Self::HungUp,
        }
    }
}

#[cfg(test)]
mod tests {
    /// The lines that give a name its number, or a cause its name.
    fn table(source: &str) -> Vec<&str> {
        let lines = source.lines().map(str::trim);
        lines
            .filter(|line| line.contains(" = ") && line.ends_with(',') || line.starts_with("Cause::"))
            .collect()
    }

    /// The two programs stand in two packages, neither of which may depend on the other.
    #[test]
    fn the_codes_are_those_of_the_program_halfrow() {
        let (ours, theirs) = (include_str!("exit.rs"), include_str!("../../cli/src/exit.rs"));
        assert_eq!(table(ours), table(theirs));
        assert_eq!(table(theirs).len(), 19);
    }
}
