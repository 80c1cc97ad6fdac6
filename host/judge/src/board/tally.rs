//! Counts of what goes over a link.

use std::ops::AddAssign;

use crate::link::LineErrors;

/// What went over a link.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Bytes written.
    pub bytes_out: u64,
    /// Bytes read.
    pub bytes_in: u64,
    /// Packets written.
    pub packets_out: u64,
    /// Packets read whole.
    pub packets_in: u64,
    /// Requests that were answered with what they asked for.
    pub answered: u64,
    /// Packets that came damaged since the session began.
    pub damaged_in: u64,
    /// Packets sent again.
    pub retries: u64,
    /// Of those, the ones that were answered as well: nothing had been lost, the first answer was late.
    pub late: u64,
    /// Packets that nobody waited for: second answers, rows that had already come, and packets of other sessions.
    pub strays: u64,
    /// Errors on the line that the link's chip has seen.
    pub line_errors: LineErrors,
}

impl Tally {
    /// Packets that had to be sent again, since something was lost.
    #[must_use]
    pub fn lost(&self) -> u64 {
        self.retries.saturating_sub(self.late)
    }
}

impl AddAssign for Tally {
    fn add_assign(&mut self, other: Self) {
        self.bytes_out += other.bytes_out;
        self.bytes_in += other.bytes_in;
        self.packets_out += other.packets_out;
        self.packets_in += other.packets_in;
        self.answered += other.answered;
        self.damaged_in += other.damaged_in;
        self.retries += other.retries;
        self.late += other.late;
        self.strays += other.strays;
        self.line_errors += other.line_errors;
    }
}
