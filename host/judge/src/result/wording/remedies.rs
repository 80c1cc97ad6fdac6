//! What to do about a finding.

use super::{designer, latency, rules};
use crate::result::{BurstCount, Doubt, Finding};

const CHECK_THE_LINK: &str = "Check the link, and run again.";

/// What to do about a finding, if anything.
#[must_use]
#[expect(clippy::too_many_lines, reason = "one arm a finding")]
pub fn remedy(finding: &Finding) -> Option<String> {
    let asked = match finding {
        Finding::Problem(problem) | Finding::BoardStayedAway { reason: problem, .. } => {
            return problem.remedy.clone();
        }
        Finding::TablesChanged { found } | Finding::InCorner { found, .. } => return remedy(found),
        Finding::SecondLookBrokenOff(it) => {
            return Some(remedy(&it.reason).unwrap_or_else(|| CHECK_THE_LINK.to_owned()));
        }
        Finding::TableReadsWrong { defect: suspect, .. }
        | Finding::SamplesDiffer { suspect: Some(suspect), .. }
        | Finding::DiffersAtSpeed { suspect: Some(suspect), .. } => return Some(designer(suspect)),
        Finding::SamplesDiffer { suspect: None, .. } => super::MAPS,
        Finding::CapabilityImpossible { .. } => {
            "Correct what the board says of itself (CAPABILITIES in protocol/WIRE.md), or load another bitstream."
        }
        Finding::EchoWrong {} => "Check the board's packet buffers: the link carried what the board sent.",
        Finding::TableCrcWrong {} | Finding::CommitCrcWrong {} => {
            "Check the board's CRC unit, and whether the tables change on their own."
        }
        Finding::GenerationWrong { .. } => {
            "The board uses stale tables: check when its bank switch takes effect."
        }
        Finding::LatencyWrong(late) => latency::remedy(late.are_one_row()),
        Finding::CounterWrong { rule: Some(_), .. } => return Some(rules::remedy(None)),
        Finding::RuleBroken { found, .. } => return Some(rules::remedy(Some(found))),
        Finding::CounterWrong { rule: None, .. }
        | Finding::GapsMiscounted { .. }
        | Finding::LatencyMiscounted { .. } => {
            "Check the board's counters and its row player; the samples themselves were right."
        }
        Finding::RowMisplaced(_) | Finding::RowNeverSent { .. } => {
            "Check how the board keeps a row's place with its samples."
        }
        Finding::RowSwallowed { .. } => {
            "Check the row banks and the row player: the board took the row and lost it inside."
        }
        Finding::RowsEnteredChanged { .. } => {
            "Check the banks that rows wait in, and the unpacking of samples in front of them."
        }
        Finding::EntryMiscounted { .. } => {
            "Check the board's CRC unit, and the banks that rows wait in where they hold samples that no output reads."
        }
        Finding::MiscountedAtSpeed { count: BurstCount::LeastLatency | BurstCount::MostLatency, .. } => {
            "Check how the board counts latency, and whether the output paused for a clock that it does not count as a \
             pause: its samples are right."
        }
        Finding::MiscountedAtSpeed { .. } => {
            "Check what the board counts of the frames that it makes: their samples were right."
        }
        Finding::ClockNotAsNamed { .. } => {
            "Check the settings of the board's PLL and its oscillator, and the clock that its capabilities name."
        }
        Finding::BurstStalled { .. } => "Check the board's clock, and run again.",
        Finding::BurstEndedEarly { .. } | Finding::BoardExchanged {} => "Run again.",
        Finding::RowCopyDiffers(_) => {
            "Check what else writes to the output banks while the board waits for the acknowledgement of a row."
        }
        Finding::RowNumberedTwice(_) => {
            "Check the board's count of ROW_OUT packets, the sequence in their headers."
        }
        Finding::RowRepeatsStand(_) => {
            "Check where the board counts how often it sent a row, the `repeats` of ROW_OUT."
        }
        Finding::RowOutOfOrder(_) => {
            "Check in which order the board plays its input banks and sends its output banks, and whether RESET \
             lets its packet numbers begin anew."
        }
        Finding::RowLostOnce { .. } => "Check cable and connectors, and run again.",
        Finding::RowLostAmongOthers { .. } => "Check cable, connectors and rate.",
        Finding::RowStayedAway(_) => "Check cable, connectors and rate, and run again.",
        Finding::RowLostEachTime(_) => {
            "Check what the board does with this row, and whether something on the way swallows certain bytes or lengths."
        }
        Finding::WrongOverDoubtfulLink { doubt: Doubt::AnswerLost {}, .. } => {
            "Check first how the board answers this, then the link, and run again."
        }
        Finding::RightInAnotherSession { .. } | Finding::WrongOverDoubtfulLink { .. } => CHECK_THE_LINK,
        Finding::NothingJudged {} => "Name at least one frame, or none for the built-in ones.",
        Finding::DatapathUnknown { datapath, known } => {
            let asked =
                format!("Load a bitstream of datapath {known}, or install a halfrow that knows {datapath}.");
            return Some(asked);
        }
        Finding::HardwareRequired { .. } => "Name a real board.",
        Finding::DiffersAtSpeed { suspect: None, .. }
        | Finding::GoldenSamplesFound { .. }
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
        | Finding::AllRight { .. } => return None,
    };
    Some(asked.to_owned())
}
