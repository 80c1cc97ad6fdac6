//! Exit codes, which scripts rely on. Only here do classes of errors and causes of results become numbers.

use std::error::Error;

use serde::Serialize;

use crate::link::Class;
use crate::result::asked_of_system;
use crate::verdict::{Cause, StoppedBy, Verdict};

/// How a command ended.
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
    const ALL: [Self; 10] = [
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

    /// The one with this exit code, if any.
    #[must_use]
    pub fn of(code: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|exit| exit.code() == code)
    }

    /// The one of a call that is refused because of `error`: a call that was right may meet a full disk, a fault of a device, or a
    /// process that has too many files open.
    #[must_use]
    pub fn of_refusal(error: &(dyn Error + 'static)) -> Self {
        if asked_of_system(error).is_some() { Self::Error } else { Self::Usage }
    }

    /// The process's exit code.
    #[must_use]
    pub const fn code(self) -> u8 {
        self as u8
    }

    /// The verdict that the code carries; none after a usage error.
    #[must_use]
    pub fn verdict(self) -> Option<Verdict> {
        self.cause().map(Cause::verdict)
    }

    /// The cause of a result with this code; none after a usage error. A code does not tell a caller who stops a run from a person
    /// who does.
    #[must_use]
    pub fn cause(self) -> Option<Cause> {
        Cause::ALL.into_iter().find(|&cause| Self::from(cause) == self)
    }

    /// Who stopped the program, if this exit code is that of a signal.
    #[must_use]
    pub fn stopped_by(code: usize) -> Option<StoppedBy> {
        match Self::of(u8::try_from(code).ok()?)?.cause()? {
            Cause::Stopped(by) => Some(by),
            _ => None,
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

impl Serialize for Exit {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_u8(self.code())
    }
}

#[cfg(test)]
mod tests {
    use std::io;

    use super::*;
    use crate::call::FilesError;

    #[test]
    fn a_code_carries_the_verdict_of_its_cause_and_a_signal_is_known_by_it() {
        for cause in Cause::ALL {
            let exit = Exit::from(cause);
            assert_eq!(exit.verdict(), Some(cause.verdict()), "{cause}");
            assert_eq!(Exit::of(exit.code()), Some(exit), "{cause}");
        }
        let signals = [129, 130, 143, 0, 3].map(Exit::stopped_by);
        let (gone, person, system) = (StoppedBy::Disconnection, StoppedBy::Person, StoppedBy::System);
        assert_eq!(signals, [Some(gone), Some(person), Some(system), None, None]);
    }

    /// The numbers are those of errno(3) on Linux.
    #[test]
    fn what_the_system_refuses_a_right_call_is_no_wrong_call() {
        let refused = |number: i32| {
            let source = io::Error::from_raw_os_error(number);
            let path = "out".into();
            Exit::of_refusal(&FilesError::FolderClosed { path, option: "output", source })
        };
        for (name, number) in [("EIO", 5), ("ENFILE", 23), ("EMFILE", 24), ("ENOSPC", 28), ("EDQUOT", 122)] {
            assert_eq!(refused(number), Exit::Error, "{name}");
        }
        for (name, number) in [("EPERM", 1), ("ENOENT", 2), ("EACCES", 13), ("EBUSY", 16), ("EROFS", 30)] {
            assert_eq!(refused(number), Exit::Usage, "{name}");
        }
        let exists = FilesError::Exists { path: "out".into(), option: "output" };
        assert_eq!(Exit::of_refusal(&exists), Exit::Usage);
    }
}
