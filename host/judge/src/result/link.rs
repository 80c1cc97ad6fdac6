//! What a report says about the link.

use serde::{Deserialize, Serialize};

use super::{Finding, Problem};
use crate::link::LineErrors;

/// The codes of problems that a poor line can cause, or one at another rate.
const OF_LINE: [&str; 10] = [
    "link-broke",
    "no-answer",
    "request-never-answered",
    "request-damaged-each-time",
    "not-a-board",
    "session-lost",
    "burst-begun-again",
    "link-too-poor",
    "row-missing",
    "run-too-long",
];

/// What went over the link, and what went wrong on it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LinkReport {
    /// The link's name, for people.
    pub name: String,
    /// Bytes written.
    pub bytes_out: u64,
    /// Bytes read.
    pub bytes_in: u64,
    /// Packets written, retries included.
    pub packets_out: u64,
    /// Packets read whole.
    pub packets_in: u64,
    /// Packets that arrived damaged.
    pub damaged_in: u64,
    /// Packets that reached the board damaged, by its own count.
    pub damaged_out: u64,
    /// Packets sent again.
    pub retries: u64,
    /// Retries without a loss: the first answer was only late.
    pub late: u64,
    /// Packets that nobody waited for: second answers, rows that had already come, and packets of another session.
    pub strays: u64,
    /// The errors on the line that the chip at the link's near end has seen.
    pub line_errors: LineErrors,
    /// The most retries, late ones not counted, with which the link still counts as good enough to judge a board. Each link has its
    /// own limit, and after reconnections this is their sum.
    pub retry_limit: u64,
    /// The round trip of an empty request, in microseconds of the link's clock; none if it was not measured. A replay makes none.
    pub round_trip_us: Option<u64>,
    /// How long the run took on the link's clock, in seconds.
    pub seconds: f64,
    /// Every time that the board went away and came back, in order.
    pub reconnections: Vec<Reconnection>,
}

impl LinkReport {
    /// What errors on the line say to do about a run that ended without a verdict, with `finding`, if they may have led to it.
    pub(super) fn line_advice_on(&self, finding: &Finding) -> Option<&'static str> {
        self.line_errors.advice().filter(|_| may_come_from_line(finding))
    }
}

/// One time that the board went away during the run and came back.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Reconnection {
    /// How it went away, and what was under way.
    pub reason: Problem,
    /// How long it was away, in seconds.
    pub seconds_away: f64,
    /// Whether it still had its tables, and so had not lost its power; none when it was not asked.
    #[serde(default)]
    pub kept_tables: Option<bool>,
}

/// Whether errors on the line may have led to `finding`, by which a run ended without a verdict.
fn may_come_from_line(finding: &Finding) -> bool {
    match finding {
        Finding::Problem(problem) | Finding::BoardStayedAway { reason: problem, .. } => {
            OF_LINE.contains(&problem.code.as_str())
        }
        Finding::SecondLookBrokenOff(it) => may_come_from_line(&it.reason),
        Finding::RightInAnotherSession { .. }
        | Finding::WrongOverDoubtfulLink { .. }
        | Finding::RowLostOnce { .. }
        | Finding::RowLostAmongOthers { .. }
        | Finding::RowStayedAway(_)
        | Finding::RowLostEachTime(_)
        | Finding::BurstStalled { .. }
        | Finding::BurstEndedEarly { .. } => true,
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::OF_LINE;
    use crate::result::codes::LISTS;

    #[test]
    fn every_problem_of_a_line_is_one_that_there_is() {
        let codes: Vec<_> =
            LISTS.into_iter().flatten().flat_map(|list| list.codes).map(|(code, _)| *code).collect();
        let unknown: Vec<_> = OF_LINE.into_iter().filter(|code| !codes.contains(code)).collect();
        assert!(unknown.is_empty(), "{unknown:?}");
    }
}
