//! An example of every defect.

use super::FLIPPED;
use crate::result::{
    Account, ClampEnd, ContentKind, Counting, Defect, Extent, Instead, KernelSwitch, LineFault, MadeAs,
    MadeWith, Memory, NamedBlanking, Reading, RowSource, SampleBus, SampleLines, StaleFrames, Suspect,
    TableWord, TableWords,
};

/// A suspect for every defect.
#[must_use]
pub fn suspects() -> Vec<Suspect> {
    let samples =
        Account::Samples { differing: 960, explained: 960, contradicted: 0, others: 0, set_in: false };
    let words = Account::Words { wrong: 40, explained: 40, others: 0 };
    let seen = in_tables().into_iter().chain(of_lines()).chain(of_logic());
    let seen = seen.map(|defect| Suspect { defect, account: samples.clone(), explained: 1.0 });
    let read = read_back().map(|defect| Suspect { defect, account: words.clone(), explained: 1.0 });
    let unknown = Suspect::explaining_nothing(none_known());
    let late = Suspect {
        defect: Defect::TablesChangeLate { rows: 1 },
        account: Account::Signatures { wrong: 2, explained: 2 },
        explained: 1.0,
    };
    let before = Suspect { defect: Defect::RecordsLate {}, ..late.clone() };
    seen.chain(read).chain([late, before]).chain(without_share()).chain([unknown]).collect()
}

fn in_tables() -> Vec<Defect> {
    let reading = |read, uploaded| Reading { uploaded, read, generation: 2, only: true, alike: Vec::new() };
    let made = MadeWith { factors: Some(1), kernel: Some(1) };
    vec![
        Defect::RowFactorBitWrong {
            row: 3,
            bit: 4,
            reading: reading(16_000_016, 16_000_000),
            above_one: false,
        },
        Defect::RowFactorWrong {
            row: 3,
            generation: 2,
            least: 15_999_999,
            most: 16_000_001,
            uploaded: 16_000_100,
            only: true,
        },
        Defect::GridEntryBitWrong {
            column: 12,
            row: 4,
            bit: 6,
            reading: reading(16_000_064, 16_000_000),
            illegal: false,
        },
        Defect::KernelWordBitWrong { node: 7, weight: "g4".to_owned(), bit: 3, reading: reading(-120, -128) },
        Defect::KernelWordWrong {
            node: 7,
            weight: "g4".to_owned(),
            generation: 2,
            least: -120,
            most: -120,
            uploaded: -128,
            only: true,
        },
        Defect::StaleTables {
            rows: Vec::new(),
            frames: vec![StaleFrames { frame: 2, committed: 2, made_with: vec![made] }],
        },
        Defect::KernelSwitchedInRow(KernelSwitch { row: 1079, frame: 1, column: 960, before: 1, after: 2 }),
    ]
}

fn of_lines() -> Vec<Defect> {
    vec![
        Defect::LineMemoryDataStuck { bit: 5, value: 1 },
        Defect::OutputDataStuck { bit: 5, value: 0 },
        Defect::SampleLinesWrong(SampleLines {
            bus: SampleBus::Output,
            fault: LineFault::Exchanged,
            bits: vec![4, 5],
            columns: None,
        }),
        Defect::LineMemoryAddressStuck { bit: 10, counting: Counting::Run },
        Defect::RowTableDataStuck { bit: 7, value: 1 },
        Defect::RowTableAddressStuck { bit: 2, value: 0 },
        Defect::RowTableAddressOff { entries: -1 },
        Defect::KernelAddressStuck { bit: 3, value: 0 },
        Defect::KernelAddressOff { nodes: 1 },
        Defect::KernelDataStuck { weight: "g0".to_owned(), bit: 3, value: 0 },
    ]
}

fn of_logic() -> Vec<Defect> {
    vec![
        Defect::TapOffset { columns: 1 },
        Defect::TapDead { tap: "G4".to_owned(), reads: None },
        Defect::BaseColourWrong {},
        Defect::OutputRoundingMissing {},
        Defect::WeightRoundingMissing {},
        Defect::RoundingMissing {},
        Defect::WeightsUnsigned {},
        Defect::WeightsTowardZero {},
        Defect::SourceRoundingMissing {},
        Defect::BaseColumnRight {},
        Defect::EdgeColourWrong {},
        Defect::ClampMissing { end: ClampEnd::High },
        Defect::CentreIgnored { instead: Instead::Usual },
        Defect::CentreOff { halves: 1 },
        Defect::CentreBitStuck { bit: 3, value: 0 },
        Defect::DepthIgnored { instead: Instead::FrameBefore },
        Defect::RowsExchanged { source: RowSource::Output { frames: 0, rows: -1 }, mostly: false },
        Defect::RowShifted { columns: 1 },
        Defect::ColumnPairsExchanged {},
        Defect::PairBytesReversed { first_in_front: true },
        Defect::RowsLost { rows: 2, first: 3 },
        Defect::ContentWrong {
            row: 3,
            kind: ContentKind::Toggle,
            made: MadeAs::Toggle { p: 2, high: false },
        },
    ]
}

fn read_back() -> impl Iterator<Item = Defect> {
    let table = Memory::Rows;
    [
        Defect::TableLengthWrong { table, uploaded: 1080, read: 1079 },
        Defect::TableWordWrong(TableWord {
            table: Memory::Kernel,
            entry: 7,
            weight: Some("g4".to_owned()),
            bits: vec![3],
            uploaded: -128,
            read: -120,
            wrong: 1,
        }),
        Defect::TableWordsWrong(TableWords {
            table,
            entry: 3,
            weight: None,
            uploaded: 16_000_000,
            read: 16_064_512,
            wrong: 40,
            words: 1080,
        }),
        Defect::TableBytesReversed { table },
        Defect::GridEntryReadsWrong {
            column: 0,
            row: 4,
            bits: vec![6],
            uploaded: 16_777_216,
            read: 16_777_280,
            wrong: 1,
        },
        Defect::TableDataStuck { table, weight: None, bit: 7, value: 1 },
        Defect::TableAddressStuck { table, bit: 2, value: 0 },
        Defect::TableWriteAddressStuck { table, bit: 2 },
        Defect::TableAddressOff { table, entries: 1 },
        Defect::TableLevelStuck { table, value: 0 },
    ]
    .into_iter()
}

fn without_share() -> impl Iterator<Item = Suspect> {
    [
        Defect::RowsChangedOnEntry { rows: 9, first: 3, frame: 2, flipped: Some(FLIPPED) },
        Defect::OnlyAtSpeed { row: Some(3), samples: 1, bits: vec![11] },
        Defect::SignatureWrong { row: 3 },
        Defect::SeenAtSpeed { row: Some(3), samples: 1, bits: vec![11], lost: None },
        Defect::LeastBlankingTooSmall(NamedBlanking { named: 8, right: 900 }),
    ]
    .into_iter()
    .map(Suspect::explaining_nothing)
}

fn none_known() -> Defect {
    Defect::NoneKnown {
        rows: Some(Extent::From { first: 512 }),
        columns: Some(Extent::Every {}),
        least: Some(-1),
        most: Some(1),
        bright: None,
        bits: vec![0, 1],
        unstreamed: false,
        frames: 2,
        of_frames: 16,
    }
}
