//! Boards that correct with a grid: what is named for row factors is named for them too, and a wrong entry is named by
//! grid row and node.

use halfrow::result::Suspect;
use halfrow::tables::Generation;
use halfrow_model::{BitDepth, Interpolant, Kernel, TableSet, correct};

use crate::bench::{Bench, CaseInput, assert_named, fault, grid, is_told, off_centre_grid};
use crate::scenes::Random;

/// Grid rows of [`grid`], and its columns, including the one of the offsets.
const ROWS: usize = 8;
const COLUMNS: usize = 8;

/// The fault of a bit of the entry at `column` and `row`, which reads back right, and the place that must be named.
fn wrong_entry(column: usize, row: usize, bit: u32) -> (String, String) {
    let entry = match column {
        0 => "offset".to_owned(),
        node => format!("node {}", node - 1),
    };
    let text = format!("row-factor,row={},bit={bit},hidden=true", column * ROWS + row);
    (text, format!("grid row {row}, {entry}, bit {bit}"))
}

#[test]
fn a_bit_of_a_grids_entry_is_named() {
    let bench = grid();
    for (column, row, bit) in [
        (0, 0, 14),
        (0, 4, 18),
        (1, 2, 16),
        (1, 5, 13),
        (2, 3, 17),
        (4, 1, 17),
        (4, 6, 15),
        (6, 4, 19),
        (7, 3, 18),
    ] {
        let (text, place) = wrong_entry(column, row, bit);
        assert_named(&bench, &text, &place);
    }
}

/// Many entries, with bits that move samples far and bits that hardly do.
#[test]
fn no_wrong_entry_is_named_for_certain() {
    let bench = grid();
    let mut random = Random::new(16);
    let (mut alone, mut tried) = (0, 0);
    for _ in 0..40 {
        let mut below = |bound: usize| random.below(bound as u64) as usize;
        let (text, place) = wrong_entry(below(COLUMNS), below(ROWS), below(23) as u32);
        let suspects = bench.diagnose(fault(&text));
        let [first, others @ ..] = &suspects[..] else { continue };
        let unsure = first.explained < 1.0 || first.evidence().contains("not certain");
        assert!(is_told(first, &place) && others.is_empty() || unsure, "{text}: {suspects:#?}");
        tried += 1;
        alone += usize::from(is_told(first, &place) && others.is_empty());
    }
    assert!(4 * alone >= 3 * tried && tried >= 20, "{alone} of {tried}");
}

/// The row leads out of the frame, and which samples come then is undefined.
#[test]
fn the_highest_bits_of_a_grids_entry_are_named_first() {
    for (column, row, bit) in [(0, 3, 23), (0, 5, 24), (1, 4, 24), (3, 2, 23), (5, 5, 24)] {
        let (text, place) = wrong_entry(column, row, bit);
        let suspects = grid().diagnose(fault(&text));
        assert_eq!(suspects[0].place(), place, "{suspects:#?}");
    }
}

#[test]
fn a_grids_entry_that_drifts_during_the_run_is_named_with_its_onset() {
    let bench = grid();
    let mut seen = bench.play(Some(fault("drifting-table,after=100,row=28,bit=18")));
    seen.keep_all(bench.sound_frames());
    let suspects = bench.judge(&seen);
    assert_eq!(suspects[0].place(), "grid row 4, node 2, bit 18", "{suspects:#?}");
    assert_eq!((suspects.len(), suspects[0].explained), (1, 1.0));
    assert!(suspects[0].evidence().contains("began during the run"), "{}", suspects[0].evidence());
}

#[test]
fn lines_taps_and_weights_are_named_behind_a_grid() {
    for (text, place) in [
        ("stuck-data,bit=5,value=1", "line memory, data bit 5 stuck at 1"),
        ("stuck-data,bit=11,value=0", "line memory, data bit 11 stuck at 0"),
        ("stuck-address,bit=3", "line memory, address bit 3"),
        ("stuck-address,bit=6", "line memory, address bit 6"),
        ("kernel-word,node=16,weight=g4,bit=12,hidden=true", "kernel node 16, weight g4, bit 12"),
        ("tap-offset,columns=1", "the window's read address, one column to the right"),
        ("tap-offset,columns=-3", "the window's read address, 3 columns to the left"),
        ("no-rounding", "the output's rounding"),
        ("dead-tap,tap=4", "tap G4 stuck at 0"),
        ("dead-tap,tap=1,reads=5", "tap R1 reading R5"),
    ] {
        assert_named(&grid(), text, place);
    }
}

#[test]
fn an_address_line_is_named_behind_a_grid_although_the_ring_did_not_begin_with_the_run() {
    let bench = Bench { rows_before: 1, ..grid() };
    assert_named(&bench, "stuck-address,bit=5", "line memory, address bit 5");
}

/// The suspects for a board that makes the frames with the tables and the kernel that `made` returns.
fn diagnose(bench: &Bench, made: impl Fn(&TableSet, &Kernel) -> (TableSet, Kernel)) -> Vec<Suspect> {
    let mut seen = CaseInput { frames: Vec::new(), evidence: Vec::new() };
    for (generation, input, expected) in bench.sound_frames() {
        let Generation { tables, kernel, .. } = &bench.generations[usize::from(generation) - 1];
        let (tables, kernel) = made(tables, kernel);
        let found = correct(&tables, &kernel, &input).unwrap();
        seen.take(generation, input, expected, found);
    }
    bench.judge(&seen)
}

/// A bench with a grid whose entries have nothing in common and leave room at both ends of the row.
fn drawn() -> Bench {
    let tables = &grid().generations[1].tables;
    let entry = |index: usize| {
        let drawn = (index as u32).wrapping_mul(2_654_435_761);
        if index < ROWS { (1 << 24) + (drawn >> 18) } else { 14_680_064 + (drawn >> 12) }
    };
    let entries: Vec<_> = (0..ROWS * COLUMNS).map(entry).collect();
    let tables = TableSet::from_grid(*tables.geometry(), tables.shape().unwrap(), &entries).unwrap();
    Bench::of(tables, 256, Interpolant::Hermite)
}

/// The grid with the entries that `read` gives.
fn read_as(tables: &TableSet, read: impl Fn(&[u32], usize) -> u32) -> TableSet {
    let entries: Vec<_> = tables.entries().collect();
    let read: Vec<_> = (0..entries.len()).map(|index| read(&entries, index)).collect();
    TableSet::from_grid(*tables.geometry(), tables.shape().unwrap(), &read).unwrap()
}

#[test]
fn a_weight_of_any_value_is_found_behind_a_grid() {
    let suspects = diagnose(&grid(), |tables, kernel| {
        let mut nodes = kernel.nodes().to_vec();
        nodes[16][2] = -1234;
        (tables.clone(), Kernel::from_nodes(nodes).unwrap())
    });
    assert_eq!(suspects[0].place(), "kernel node 16, weight g4", "{suspects:#?}");
    assert_eq!(suspects[0].explained, 1.0, "{suspects:#?}");
}

#[test]
fn lines_of_a_grids_memory_are_named() {
    let certain = |read: fn(&[u32], usize) -> u32| {
        let suspects = diagnose(&drawn(), |tables, kernel| (read_as(tables, read), kernel.clone()));
        assert_eq!((suspects.len(), suspects[0].explained), (1, 1.0), "{suspects:#?}");
        suspects[0].place()
    };
    let data = certain(|entries, index| entries[index] & !(1 << 13));
    assert_eq!(data, "row table, data bit 13 stuck at 0");
    let address = certain(|entries, index| entries[index & !1]);
    assert_eq!(address, "row table, address bit 0 stuck at 0");
    let ahead = certain(|entries, index| entries.get(index + 1).copied().unwrap_or(1 << 24));
    assert_eq!(ahead, "the row table's address, one entry ahead");
}

#[test]
fn stale_grids_are_named_frame_by_frame() {
    for name in ["stale-table", "stale-table-hidden"] {
        let suspects = grid().diagnose(fault(name));
        let [only] = &suspects[..] else { panic!("{suspects:#?}") };
        assert_eq!((only.part(), only.explained), ("stale tables", 1.0));
        for clause in ["frame 0 made as it went in", "with the tables of generation 1 instead of 2"] {
            assert!(only.evidence().contains(clause), "{}", only.evidence());
        }
    }
}

/// The board takes frame 2's centre, and the entries of the decoy.
#[test]
fn stale_grids_are_named_in_a_frame_with_another_centre() {
    let mut bench = off_centre_grid();
    let stale = bench.generations[0].tables.clone();
    bench.generations[0].tables = stale.with_settings(BitDepth::Eight, 191).unwrap();
    let mut seen = CaseInput { frames: Vec::new(), evidence: Vec::new() };
    for (index, (generation, input, expected)) in bench.sound_frames().into_iter().enumerate() {
        let Generation { tables, kernel, .. } = &bench.generations[usize::from(generation) - 1];
        let tables = if index == 2 { &stale } else { tables };
        let found = correct(tables, kernel, &input).unwrap();
        seen.take(generation, input, expected, found);
    }
    let suspects = bench.judge(&seen);
    let [only] = &suspects[..] else { panic!("{suspects:#?}") };
    assert_eq!((only.part(), only.explained), ("stale tables", 1.0));
    let clause = "frame 2 made with the factors of generation 1 instead of 2";
    assert!(only.evidence().contains(clause), "{}", only.evidence());
}

#[test]
fn a_sound_board_with_a_grid_has_no_suspects() {
    let bench = grid();
    assert_eq!(bench.judge(&bench.play(None)), []);
}
