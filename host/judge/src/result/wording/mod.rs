//! The sentences of all findings and defects, made from their codes and parameters here and nowhere else.

#![warn(clippy::wildcard_enum_match_arm, reason = "a new finding or defect needs words of its own")]

mod at_speed;
mod bench;
mod content;
mod evidence;
mod findings;
mod latency;
mod lines;
mod logic;
mod missing;
mod not_exercised;
mod places;
mod remedies;
mod rules;
mod tables;

use super::{Defect, Memory, Shortfall};
use crate::words::grouped;

pub(crate) use at_speed::{named_clock, seen_of_clock};
pub use bench::at_the_bench;
pub use evidence::evidence;
pub(super) use findings::because;
pub use findings::sentence;
pub(crate) use findings::{broken_off, samples_differ};
pub use not_exercised::not_exercised;
pub use remedies::remedy;

/// What there is to say about a defect.
pub(super) struct Words {
    /// The kind of part, in lower case.
    part: &'static str,
    /// Where it is.
    place: String,
    /// What is wrong there, to follow "with": "bit 3 of every output forced to 1".
    defect: String,
    /// Where the designer should look next.
    designer: String,
    /// What a technician should do.
    technician: &'static str,
}

/// For memory, which may have been upset once or may be broken.
const MEMORY: &str = "Reload the bitstream and run again. If the fault comes back, set the board aside: a memory block or an internal \
                      connection of the FPGA is faulty, which cannot be resoldered.";
/// For logic: if the design is wrong, every board with it is.
const LOGIC: &str = "Make sure that the right bitstream is loaded, and run again. If the fault comes back, try another board: if \
                     that one fails the same way, the design or the bitstream is wrong; if it passes, set this board aside.";
/// For timing, whose faults may come and go with supply and temperature.
const TIMING: &str = "Switch the board off and on, reload the bitstream and run three times. If the fault comes back even once, set \
                      the board aside with its reports.";
/// What to do where no defect explains the differences.
pub(crate) const MAPS: &str = "Look at the difference maps of a report.";
/// The same where a report has no map of them.
pub(crate) const NO_MAPS: &str = "No map shows the differences: every frame that has a map is right, and samples differ only at full speed \
                                  or after the frames.";
/// What is told besides to whoever makes a board, since a known defect leaves a known pattern.
pub(crate) const OF_NEW_DESIGN: &str =
    "A new design: compare it with *Worked example* and *Golden values* of fpga/DATAPATH.md.";
/// What is said about differences that no defect explains.
const UNEXPLAINED: &str = "no single known defect explains them";
/// For faults of which nothing is known.
const REPORT: &str = "Reload the bitstream and run again with a report. If the fault comes back, set the board aside, and give the \
                      report to the designer.";

/// All that a technician is told to do with a board, by what is to blame.
pub const AT_THE_BENCH: [(&str, &str); 4] =
    [("Memory", MEMORY), ("Logic", LOGIC), ("Timing", TIMING), ("Unknown", REPORT)];

/// The kind of part, in lower case.
#[must_use]
pub fn part(defect: &Defect) -> &'static str {
    words(defect).part
}

/// Where it is: row, node and weight, bit, as far as it is known.
#[must_use]
pub fn place(defect: &Defect) -> String {
    words(defect).place
}

/// The defect that is suspected behind differing samples, as the end of a sentence. `others` is how many more explain all of
/// them, and `short` what it leaves unexplained.
fn suspicion(suspect: Option<&Defect>, others: usize, short: Option<Shortfall>) -> String {
    let unsure = match others {
        0 => short.map(but).unwrap_or_default(),
        1 => ", or another defect with the same effect".to_owned(),
        more => format!(", or one of {more} others with the same effect"),
    };
    match suspect {
        None => UNEXPLAINED.to_owned(),
        Some(unknown @ Defect::NoneKnown { .. }) => {
            let seen = places::where_and_how(unknown).join(", ");
            if seen.is_empty() { UNEXPLAINED.to_owned() } else { format!("{UNEXPLAINED}: {seen}") }
        }
        Some(suspect) => format!("the suspect is {}{unsure}", place(suspect)),
    }
}

/// Why a suspect is not to be believed as it stands, to follow it.
fn but(Shortfall { differing, explained, contradicted }: Shortfall) -> String {
    let rest = match contradicted {
        0 => None,
        1 => Some("would change a sample that is right".to_owned()),
        more => Some(format!("would change {} samples that are right", grouped(more))),
    };
    // Rounded down, so that 100 % is all of them.
    let share = (explained < differing).then(|| explained * 100 / differing);
    let share = share.map(|share| format!("explains only {share} % of what differs"));
    let told: Vec<_> = share.into_iter().chain(rest).collect();
    format!(", but it {}", told.join(" and "))
}

/// Where the designer of the board should look next, in one sentence.
#[must_use]
pub fn designer(defect: &Defect) -> String {
    words(defect).designer
}

/// What a technician should do with this board.
#[must_use]
pub fn technician(defect: &Defect) -> String {
    words(defect).technician.to_owned()
}

/// The same where the defect explains so little that no part is given up for it.
pub(super) fn if_unsure(defect: &Defect) -> String {
    let technician = words(defect).technician;
    if technician == MEMORY { REPORT } else { technician }.to_owned()
}

#[expect(clippy::too_many_lines, reason = "one arm a defect")]
fn words(defect: &Defect) -> Words {
    match defect {
        Defect::RowFactorBitWrong { row, bit, reading, above_one } => {
            tables::row_bit(*row, *bit, reading, *above_one)
        }
        Defect::RowFactorWrong { row, generation, least, most, uploaded, only } => {
            tables::row_value(*row, only.then_some(*generation), (*least, *most), *uploaded)
        }
        Defect::GridEntryBitWrong { column, row, bit, reading, illegal } => {
            tables::grid_bit((*column, *row), *bit, reading, *illegal)
        }
        Defect::KernelWordBitWrong { node, weight, bit, reading } => {
            tables::word_bit(*node, weight, *bit, reading)
        }
        Defect::KernelWordWrong { node, weight, generation, least, most, uploaded, only } => {
            tables::word_value((*node, weight), only.then_some(*generation), (*least, *most), *uploaded)
        }
        Defect::LineMemoryDataStuck { bit, value } => lines::line_memory_data(*bit, *value),
        Defect::OutputDataStuck { bit, value } => lines::output_data(*bit, *value),
        Defect::SampleLinesWrong(wrong) => lines::of_samples(wrong),
        Defect::LineMemoryAddressStuck { bit, counting } => lines::line_memory_address(*bit, *counting),
        Defect::RowTableDataStuck { bit, value } => lines::row_table_data(*bit, *value),
        Defect::RowTableAddressStuck { bit, value } => lines::row_table_address(*bit, *value),
        Defect::RowTableAddressOff { entries } => lines::row_table_off(*entries),
        Defect::KernelAddressStuck { bit, value } => lines::kernel_address(*bit, *value),
        Defect::KernelAddressOff { nodes } => lines::kernel_off(*nodes),
        Defect::KernelDataStuck { weight, bit, value } => lines::kernel_data(weight, *bit, *value),
        Defect::TapOffset { columns } => logic::tap_offset(*columns),
        Defect::TapDead { tap, reads } => logic::tap_dead(tap, reads.as_deref()),
        Defect::BaseColourWrong {} => logic::base_colour(),
        Defect::OutputRoundingMissing {} => logic::output_rounding(),
        Defect::WeightRoundingMissing {} => logic::weight_rounding(),
        Defect::RoundingMissing {} => logic::rounding(),
        Defect::WeightsUnsigned {} => logic::weights_unsigned(),
        Defect::WeightsTowardZero {} => logic::weights_toward_zero(),
        Defect::SourceRoundingMissing {} => logic::source_rounding(),
        Defect::BaseColumnRight {} => logic::base_column_right(),
        Defect::EdgeColourWrong {} => logic::edge_colour(),
        Defect::ClampMissing { end } => logic::clamp(*end),
        Defect::CentreIgnored { instead } => logic::centre_ignored(*instead),
        Defect::CentreOff { halves } => logic::centre_off(*halves),
        Defect::CentreBitStuck { bit, value } => lines::centre_bit(*bit, *value),
        Defect::DepthIgnored { instead } => logic::depth_ignored(*instead),
        Defect::ColumnPairsExchanged {} => logic::pairs_exchanged(),
        Defect::PairBytesReversed { first_in_front } => logic::pair_bytes(*first_in_front),
        Defect::RowsChangedOnEntry { rows, first, frame, flipped } => {
            at_speed::changed_on_entry((*rows, *first, *frame), *flipped)
        }
        Defect::KernelSwitchedInRow(switch) => logic::kernel_switch(*switch),
        Defect::LeastBlankingTooSmall(blanking) => logic::least_blanking(*blanking),
        Defect::TablesChangeLate { rows } => at_speed::tables_late(*rows),
        Defect::RecordsLate {} => content::records_late(),
        Defect::ContentWrong { row, kind, made } => content::wrong(*row, *kind, *made),
        Defect::SignatureWrong { row } => content::signature_wrong(*row),
        Defect::OnlyAtSpeed { row, samples, bits } => at_speed::only_at_speed(*row, *samples, bits),
        Defect::SeenAtSpeed { row, samples, bits, lost: None } => {
            at_speed::seen_at_speed(*row, *samples, bits)
        }
        Defect::SeenAtSpeed { row, samples, bits, lost: Some(lost) } => {
            at_speed::row_lost_too(*row, *samples, bits, *lost)
        }
        Defect::StaleTables { rows, frames } => places::stale(rows, frames),
        Defect::RowsExchanged { source, mostly } => places::exchanged(*source, *mostly),
        Defect::RowShifted { columns } => places::shifted(*columns),
        Defect::RowsLost { rows, first } => places::lost(*rows, *first),
        Defect::NoneKnown { .. } => places::unknown(defect),
        Defect::TableLengthWrong { table, .. } => tables::length(*table),
        Defect::TableWordWrong(wrong) => tables::word_read(wrong),
        Defect::TableWordsWrong(wrong) => tables::words_read(wrong),
        Defect::TableBytesReversed { table } => tables::bytes_reversed(*table),
        Defect::GridEntryReadsWrong { column, row, bits, .. } => {
            tables::grid_entry_read((*column, *row), bits)
        }
        Defect::TableDataStuck { table, weight, bit, value } => {
            tables::data_stuck(*table, weight.as_deref(), *bit, *value)
        }
        Defect::TableAddressStuck { table, bit, value } => tables::address_stuck(*table, *bit, *value),
        Defect::TableWriteAddressStuck { table, bit } => tables::write_address_stuck(*table, *bit),
        Defect::TableAddressOff { table, entries } => tables::address_off(*table, *entries),
        Defect::TableLevelStuck { table, value } => tables::level_stuck(*table, *value),
    }
}

/// What people call the memory of a table.
const fn memory(table: Memory) -> &'static str {
    match table {
        Memory::Rows => "row table",
        Memory::Kernel => "kernel memory",
    }
}

/// `stuck at 1`
fn stuck(value: u8) -> String {
    format!("stuck at {value}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::result::{Account, Finding, Repetition, StaleFrames};

    #[test]
    fn one_frame_is_told_as_one_and_several_as_several() {
        let told = |wrong| evidence(&Defect::RecordsLate {}, &Account::Signatures { wrong, explained: 1 });
        assert!(told(1).ends_with("the signatures of the one wrong frame examined"), "{}", told(1));
        assert!(told(3).ends_with("the signatures of 1 of the 3 wrong frames examined"), "{}", told(3));
        let stale = |rows: &[usize], frames: &[u16]| {
            let of = |&frame: &u16| StaleFrames { frame, committed: 2, made_with: Vec::new() };
            let frames = frames.iter().map(of).collect();
            evidence(&Defect::StaleTables { rows: rows.to_vec(), frames }, &Account::Nothing)
        };
        assert!(stale(&[3], &[5]).starts_with("row 3 of frame 5 made "), "{}", stale(&[3], &[5]));
        let several = stale(&[0, 1], &[5, 7, 8, 9]);
        assert!(several.starts_with("rows 0 and 1 of frames 5, 7 to 9 made "), "{several}");
    }

    #[test]
    fn what_no_defect_explains_is_said_so_and_large_numbers_are_grouped() {
        let suspect = Defect::NoneKnown {
            rows: None,
            columns: None,
            least: None,
            most: None,
            bright: None,
            bits: vec![5],
            unstreamed: false,
            frames: 3607,
            of_frames: 3607,
        };
        let differ = Finding::SamplesDiffer {
            differences: 105,
            samples: 39_398_400,
            differing_frames: 3607,
            frames: 3607,
            tried: None,
            suspect: Some(Box::new(suspect)),
            others: 0,
            short: None,
        };
        assert_eq!(
            sentence(&differ),
            "105 of 39,398,400 samples differ, in 3,607 of 3,607 frames; no single known defect explains them: bit \
             5 alone"
        );
    }

    #[test]
    fn a_suspect_that_is_one_of_several_is_not_told_as_the_fact() {
        let suspect = Some(Box::new(Defect::OutputDataStuck { bit: 9, value: 1 }));
        let (wrong, differing_frames, first) = (1, 1, 0);
        let differ = |others, short| {
            let [streamed, at_speed] = [suspect.clone(), suspect.clone()];
            let (differences, samples, frames) = (7, 99, 2);
            let streamed = Finding::SamplesDiffer {
                differences,
                samples,
                differing_frames,
                frames,
                tried: None,
                suspect: streamed,
                others,
                short,
            };
            let (frames, suspect) = (2, at_speed);
            let repetition = Repetition::NotNeeded {};
            let short = short.map(Box::new);
            let at_speed =
                Finding::DiffersAtSpeed { wrong, frames, first, repetition, suspect, others, short };
            [streamed, at_speed].map(|finding| sentence(&finding))
        };
        let short = |explained, contradicted| Some(Shortfall { differing: 2000, explained, contradicted });
        for (others, short, end) in [
            (0, None, "the suspect is corrected samples, bit 9 stuck at 1"),
            (1, None, "stuck at 1, or another defect with the same effect"),
            (3, None, "stuck at 1, or one of 3 others with the same effect"),
            (0, short(1044, 0), "stuck at 1, but it explains only 52 % of what differs"),
            (
                0,
                short(1999, 1),
                "it explains only 99 % of what differs and would change a sample that is right",
            ),
            (0, short(2000, 1081), "stuck at 1, but it would change 1,081 samples that are right"),
        ] {
            for told in differ(others, short) {
                assert!(told.ends_with(end), "{told}");
            }
        }
    }
}
