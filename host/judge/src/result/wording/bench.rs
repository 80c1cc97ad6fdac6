//! What a technician should do about a finding where no suspect says it.

use super::{LOGIC, MEMORY, REPORT, TIMING, technician};
use crate::result::{Answer, BurstCount, Finding};

/// What tells a rule that is broken from a path that fails at speed now and then.
const SAME_RULE: &str = "If each run names the same rule, try another board first: if that one fails the same way, the design or \
                         the bitstream is wrong.";

/// What a technician should do with a board that has this finding; none for findings that are not against the board.
#[must_use]
#[expect(clippy::too_many_lines, reason = "one line a finding")]
pub fn at_the_bench(finding: &Finding) -> Option<String> {
    let asked = match finding {
        Finding::TableReadsWrong { defect, .. } => return Some(technician(defect)),
        Finding::SamplesDiffer { suspect: Some(suspect), .. }
        | Finding::DiffersAtSpeed { suspect: Some(suspect), .. } => return Some(technician(suspect)),
        Finding::TablesChanged { found } | Finding::InCorner { found, .. } => return found.technician(),
        Finding::RuleBroken { found: Answer::OtherSignatures { .. }, .. } => {
            return Some(format!("{TIMING} {SAME_RULE}"));
        }
        Finding::SamplesDiffer { suspect: None, .. } => REPORT,
        Finding::EchoWrong {} | Finding::TableCrcWrong {} | Finding::CommitCrcWrong {} => MEMORY,
        Finding::LatencyWrong(late) if late.come_and_go() => TIMING,
        Finding::DiffersAtSpeed { suspect: None, .. }
        | Finding::GenerationWrong { .. }
        | Finding::MiscountedAtSpeed { count: BurstCount::Generation, .. }
        | Finding::ClockNotAsNamed { .. }
        | Finding::RowSwallowed { .. }
        | Finding::RowCopyDiffers(_) => TIMING,
        Finding::RowsEnteredChanged { .. }
        | Finding::EntryMiscounted { .. }
        | Finding::MiscountedAtSpeed { .. }
        | Finding::LatencyWrong(_)
        | Finding::CounterWrong { .. }
        | Finding::GapsMiscounted { .. }
        | Finding::LatencyMiscounted { .. }
        | Finding::RowMisplaced(_)
        | Finding::RowNeverSent { .. }
        | Finding::RowNumberedTwice(_)
        | Finding::RowRepeatsStand(_)
        | Finding::RowOutOfOrder(_)
        | Finding::RuleBroken { .. } => LOGIC,
        Finding::GoldenSamplesFound { .. }
        | Finding::BoardIdentified { .. }
        | Finding::EchoesReturned { .. }
        | Finding::TablesUploaded { .. }
        | Finding::TablesReadBack { .. }
        | Finding::FramesEqual { .. }
        | Finding::LatencyRight { .. }
        | Finding::TablesUnchanged {}
        | Finding::TablesUnused {}
        | Finding::CountersRight { .. }
        | Finding::EqualAtSpeed(_)
        | Finding::PausedAtSpeed { .. }
        | Finding::NothingAtSpeed { .. }
        | Finding::RulesKept { .. }
        | Finding::RulesLeftOut {}
        | Finding::NotReached {}
        | Finding::AllRight { .. }
        | Finding::BurstStalled { .. }
        | Finding::BurstEndedEarly { .. }
        | Finding::RowLostOnce { .. }
        | Finding::RowLostAmongOthers { .. }
        | Finding::RowStayedAway(_)
        | Finding::RowLostEachTime(_)
        | Finding::RightInAnotherSession { .. }
        | Finding::WrongOverDoubtfulLink { .. }
        | Finding::SecondLookBrokenOff(_)
        | Finding::NothingJudged {}
        | Finding::CapabilityImpossible { .. }
        | Finding::DatapathUnknown { .. }
        | Finding::HardwareRequired { .. }
        | Finding::BoardExchanged {}
        | Finding::BoardStayedAway { .. }
        | Finding::Problem(_) => return None,
    };
    Some(asked.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::result::{LateRows, examples};
    use crate::verdict::Verdict;

    #[test]
    fn every_finding_against_the_board_says_what_to_do_at_the_bench_and_no_other() {
        for (verdict, finding) in examples::findings_with_verdicts() {
            let is_against = verdict == Some(Verdict::Fail);
            assert_eq!(finding.technician().is_some(), is_against, "{finding:?}");
        }
    }

    /// A second board says nothing about a fault that comes and goes on the first.
    #[test]
    fn rows_that_are_late_now_and_then_send_nobody_to_another_board() {
        let late = |rows, of_rows, is_one_row| {
            let (row, frame, first, last, claimed) = (3, 0, 973, 973, 972);
            let late = LateRows { rows, of_rows, is_one_row, row, frame, first, last, claimed };
            at_the_bench(&Finding::LatencyWrong(late)).unwrap()
        };
        // All rows, also as an earlier program's report counts them, and the same row of every frame.
        for told in [late(96, 96, false), late(9, 0, false), late(16, 96, true)] {
            assert_eq!(told, LOGIC);
        }
        for told in [late(1, 96, true), late(7, 96, false)] {
            assert_eq!(told, TIMING);
        }
    }
}
