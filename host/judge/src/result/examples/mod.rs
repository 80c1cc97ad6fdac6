//! An example of every finding and every defect, for the page of codes and for tests.

mod rules;
mod suspects;

use super::{
    Account, BoardKind, BrokenOff, BurstCount, ClockSeen, Corner, Counter, Defect, Doubt, EqualAtSpeed,
    Finding, FlippedBit, KeptRow, LateRows, Memory, MissingRow, NoBurst, NotExercised, NumberedRow,
    PlacedRow, Problem, RepeatedRow, Repetition, Streamed,
};
use crate::compare::Difference;
use crate::verdict::Verdict;

pub use suspects::suspects;

/// An example of every finding that is no error.
#[must_use]
pub fn findings() -> Vec<Finding> {
    findings_with_verdicts().into_iter().map(|(_, finding)| finding).collect()
}

/// An example of every finding that is no error, with the verdict that it leads to; none for what was not done.
#[must_use]
pub fn findings_with_verdicts() -> Vec<(Option<Verdict>, Finding)> {
    let with = |verdict| move |finding| (verdict, finding);
    let of_the_board = of_the_board().into_iter().chain(on_entry_and_at_speed()).chain(rules::on_rules());
    let all = right().into_iter().chain(of_the_board.map(with(Some(Verdict::Fail))));
    all.chain(unjudged().map(with(Some(Verdict::Error)))).collect()
}

fn right() -> Vec<(Option<Verdict>, Finding)> {
    let found = [
        Finding::GoldenSamplesFound { samples: 4_147_328, path: "avx2".to_owned() },
        Finding::BoardIdentified { name: "halfrow mock".to_owned(), wire: 1, datapath: 1 },
        Finding::EchoesReturned { bytes: 8192, echoes: 5 },
        Finding::TablesUploaded { entries: 1080, nodes: 65, generation: 2 },
        Finding::TablesReadBack { ports: 3 },
        Finding::FramesEqual { frames: 16, samples: 33_177_600 },
        Finding::LatencyRight { clocks: 972 },
        Finding::TablesUnchanged {},
        Finding::TablesUnused {},
        Finding::CountersRight { rows: 17_280, damaged_unseen: 0 },
        Finding::EqualAtSpeed(EqualAtSpeed {
            frames: 138,
            clock_hz: 96_000_000,
            seen: ClockSeen { least_hz: Some(95_000_000), most_hz: Some(103_000_000) },
            seconds: Some(3.0),
            held_back: 0,
            corners: 4,
        }),
        Finding::PausedAtSpeed { frames: 138, paused: 2 },
        Finding::NothingAtSpeed { reason: NoBurst::BoardMakesNone {} },
        Finding::RulesKept { requests: 612 },
        Finding::RulesLeftOut {},
        Finding::NotReached {},
        Finding::AllRight {
            frames: 16,
            samples: 33_177_600,
            latency: 972,
            board: BoardKind::Hardware,
            reconnections: 0,
        },
    ];
    let is_left_out = |finding: &Finding| {
        use Finding::{NotReached, NothingAtSpeed, PausedAtSpeed, RulesLeftOut, TablesUnused};
        matches!(
            finding,
            NotReached {} | NothingAtSpeed { .. } | PausedAtSpeed { .. } | RulesLeftOut {} | TablesUnused {}
        )
    };
    found.into_iter().map(|finding| ((!is_left_out(&finding)).then_some(Verdict::Pass), finding)).collect()
}

fn of_the_board() -> [Finding; 18] {
    let defect = || Box::new(Defect::LineMemoryDataStuck { bit: 5, value: 1 });
    let account = Account::Words { wrong: 40, explained: 40, others: 0 };
    let of_table = Box::new(Defect::TableDataStuck { table: Memory::Rows, weight: None, bit: 7, value: 1 });
    [
        Finding::EchoWrong {},
        Finding::TableReadsWrong { defect: of_table, account },
        Finding::TableCrcWrong {},
        Finding::CommitCrcWrong {},
        Finding::TablesChanged { found: Box::new(Finding::TableCrcWrong {}) },
        Finding::GenerationWrong { row: 3, frame: 2, named: 1, committed: 2 },
        Finding::SamplesDiffer {
            differences: 1234,
            samples: 33_177_600,
            differing_frames: 2,
            frames: 16,
            tried: None,
            suspect: Some(defect()),
            others: 0,
            short: None,
        },
        late_row(),
        Finding::CounterWrong { counter: Counter::RowsOut, counted: 17_279, right: 17_280, rule: None },
        Finding::GapsMiscounted { row: 3, frame: 2, counted: 11, expected: 12 },
        Finding::LatencyMiscounted { least: 972, most: 972, counted_least: 971, counted_most: 972 },
        Finding::RowMisplaced(PlacedRow { row: 3, frame: 2, rules: false }),
        Finding::RowSwallowed { row: 3, frame: 2, again: 3 },
        Finding::RowCopyDiffers(PlacedRow { row: 3, frame: 2, rules: false }),
        Finding::RowNeverSent { row: 3, frame: 2, sequence: 1083, rules: false },
        Finding::RowNumberedTwice(NumberedRow { row: 3, frame: 2, number: 513, rules: false }),
        Finding::RowRepeatsStand(RepeatedRow { row: 3, frame: 2, repeats: 0, rules: false }),
        Finding::RowOutOfOrder(PlacedRow { row: 3, frame: 2, rules: false }),
    ]
}

fn late_row() -> Finding {
    Finding::LatencyWrong(LateRows {
        rows: 16,
        of_rows: 17_280,
        is_one_row: true,
        row: 3,
        frame: 0,
        first: 973,
        last: 973,
        claimed: 972,
    })
}

/// A bit that was flipped on its way in.
const FLIPPED: FlippedBit = FlippedBit { column: 5, bit: 11 };
/// Bounds around a quarter of 96 MHz.
const SLOW_CLOCK: ClockSeen = ClockSeen { least_hz: Some(22_100_000), most_hz: Some(24_600_000) };

/// A row of which one sample differs in bit 11.
fn kept_row() -> KeptRow {
    let first = vec![Difference { row: 3, column: 1207, expected: 412, found: 2460 }];
    KeptRow { generation: 2, differences: 1, first }
}

/// Findings on what entered the core, and on frames that the board made itself.
fn on_entry_and_at_speed() -> [Finding; 6] {
    [
        Finding::ClockNotAsNamed { clock_hz: 96_000_000, seen: SLOW_CLOCK },
        Finding::RowsEnteredChanged { rows: 9, row: 3, frame: 2, flipped: Some(FLIPPED) },
        Finding::EntryMiscounted { rows: 9, row: 3, frame: 2 },
        Finding::DiffersAtSpeed {
            wrong: 2,
            frames: 138,
            first: 17,
            repetition: Repetition::Trapped {
                frames: 19,
                row: 3,
                only_there: false,
                streamed: Streamed::Right,
                kept: Some(Box::new(kept_row())),
            },
            suspect: Some(Box::new(Defect::OnlyAtSpeed { row: Some(3), samples: 1, bits: vec![11] })),
            others: 0,
            short: None,
        },
        Finding::MiscountedAtSpeed { frame: 17, count: BurstCount::Rows, counted: 1079, right: 1080 },
        Finding::InCorner {
            corner: Corner { width: 1364, height: 24, bits: 8, centre2: 1365, grid: false },
            found: Box::new(Finding::MiscountedAtSpeed {
                frame: 1,
                count: BurstCount::Rows,
                counted: 23,
                right: 24,
            }),
        },
    ]
}

fn unjudged() -> [Finding; 15] {
    let reason = Problem::new("no-answer", "no answer to ECHO in 8 tries; check that the board is powered");
    [
        Finding::RowLostOnce { row: 3, frame: 2 },
        Finding::RowLostAmongOthers { row: 3, frame: 2 },
        Finding::RowLostEachTime(MissingRow { row: 3, frame: 2, waits_for: None }),
        Finding::RowStayedAway(PlacedRow { row: 3, frame: 65_535, rules: false }),
        Finding::BurstStalled { frame: 17, frames: 138, seconds: 5.0 },
        Finding::BurstEndedEarly { came: 17, frames: 138 },
        Finding::RightInAnotherSession {
            found: Box::new(Finding::TableCrcWrong {}),
            doubt: Doubt::RequestsTwice { requests: 2 },
        },
        Finding::WrongOverDoubtfulLink {
            found: Box::new(Finding::CommitCrcWrong {}),
            doubt: Doubt::PacketsMiscounted { counted: 513, sent: 512 },
        },
        Finding::SecondLookBrokenOff(Box::new(BrokenOff {
            found: Finding::TableCrcWrong {},
            doubt: Doubt::RequestsTwice { requests: 2 },
            reason: reason.clone().into(),
        })),
        Finding::NothingJudged {},
        Finding::CapabilityImpossible {
            capability: "latency".to_owned(),
            value: 40,
            legal: "L is 3 to 32".to_owned(),
        },
        Finding::DatapathUnknown { datapath: 3, known: 1 },
        Finding::HardwareRequired { board: BoardKind::Mock },
        Finding::BoardExchanged {},
        Finding::BoardStayedAway { reason: Box::new(reason), seconds: 30.0 },
    ]
}

/// An example of everything that a run may not exercise.
#[must_use]
pub fn not_exercised() -> Vec<NotExercised> {
    vec![
        NotExercised::InputBits { bits: vec![8, 9, 10, 11] },
        NotExercised::OutputBits { bits: vec![11] },
        NotExercised::ColumnAddress { lines: vec![7, 8, 9, 10] },
        NotExercised::LineMemoryAddress { lines: vec![7, 8, 9, 10] },
        NotExercised::RowTableAddress { lines: vec![4, 5, 6, 7, 8, 9, 10] },
        NotExercised::RowFactorBits { bits: vec![22, 23, 24] },
        NotExercised::KernelNodes { nodes: vec![0, 1, 2, 64] },
        NotExercised::Taps { taps: vec!["G0".to_owned(), "G6".to_owned()] },
        NotExercised::OneCentre { centre2: 1919 },
        NotExercised::CentreBits { bits: vec![8, 9, 10, 11] },
        NotExercised::FullSpeed {},
        NotExercised::NamedClock { clock_hz: 96_000_000, seen: SLOW_CLOCK },
        NotExercised::UnseenClock { clock_hz: 96_000_000 },
        NotExercised::TableChangeAtSpeed {},
        NotExercised::Rules {},
        NotExercised::Grids {},
        NotExercised::FurtherRecords { filled: 1024 },
        NotExercised::CountersOfPoorLinks {},
        NotExercised::SameBoard {},
        NotExercised::IdleTime { seconds: 55 },
        NotExercised::CameraPins {},
        NotExercised::Depths { bits: vec![8, 10] },
    ]
}
