//! What the frames of a run exercised in a board, and what they did not. It is computed on the reference's side: from what was
//! uploaded, and from the samples that went in and should have come out.

use std::collections::BTreeSet;

use halfrow_model::{NODES, RowFactor, Source, TAP_NAMES, TableSet};

use crate::board::{BoardNature, grids};
use crate::result::{CheckName, Identity, NotExercised};
use crate::run::Findings;
use crate::run::at_speed::known_bursts;
use crate::run::findings::levels::{Levels, ShownBits};
use crate::run::frames::observations::Observations;
use crate::run::rules::MOST_FILLED;
use crate::run::steps::Run;
use crate::tables::Generation;

/// What bursts exercised of a board, and what they left.
#[derive(Default)]
pub(crate) struct Exercised {
    /// What was not exercised at the full pixel clock.
    pub(crate) left: Vec<NotExercised>,
    /// The tables with which frames were made in corners.
    pub(crate) corners: Vec<Generation>,
    /// The plan's generations with which whole frames were made.
    pub(crate) whole: Vec<u8>,
}

impl Run<'_> {
    /// What the run did not exercise of the board, as far as that is known: it has `seen` frames, and made `bursts`.
    pub(crate) fn not_exercised(&self, seen: &Observations, bursts: Exercised) -> Vec<NotExercised> {
        let Findings { board, checks, attempt, .. } = &*self.findings;
        let Exercised { left, corners, whole } = bursts;
        let used = self.generations.iter().filter_map(|generation| used_of(generation, seen, &whole));
        let used: Vec<_> = used.collect();
        let generations: Vec<_> = used.iter().chain(&corners).collect();
        let identity = board.identity.as_ref();
        let of_frames =
            identity.map_or_else(Vec::new, |board| not_exercised(board, &generations, seen.shown));
        let has_grid = generations.iter().any(|generation| generation.tables.shape().is_some());
        let no_grid = identity.is_some() && grids(&self.board.capabilities).is_some() && !has_grid;
        let untried = !checks.has_passed(CheckName::Rules);
        let records = known_bursts(&self.board.capabilities).map_or(0, |bursts| u32::from(bursts.records));
        let are_left = !untried && records > MOST_FILLED;
        let is_physical = self.board.capabilities.nature == BoardNature::Hardware;
        let others = [
            untried.then_some(NotExercised::Rules {}),
            are_left.then_some(NotExercised::FurtherRecords { filled: MOST_FILLED }),
            no_grid.then_some(NotExercised::Grids {}),
            attempt.came_back_unnumbered.then_some(NotExercised::SameBoard {}),
            is_physical.then_some(NotExercised::CameraPins {}),
            attempt.leaves_counters_out.then_some(NotExercised::CountersOfPoorLinks {}),
        ];
        of_frames.into_iter().chain(left).chain(others.into_iter().flatten()).collect()
    }
}

/// The part of `generation` with which frames were made, if any were: whole ones, if it is among the `whole` ones.
fn used_of(generation: &Generation, seen: &Observations, whole: &[u8]) -> Option<Generation> {
    let height = generation.tables.geometry().height();
    if whole.contains(&generation.number) {
        return generation.upper(height);
    }
    let made = seen.frames.iter().filter(|frame| frame.generation == generation.number);
    generation.upper(made.map(|frame| frame.first_rows.unwrap_or(height)).max()?)
}

/// What frames that were corrected with `generations` did not exercise of `board`.
fn not_exercised(board: &Identity, generations: &[&Generation], shown: ShownBits) -> Vec<NotExercised> {
    if generations.is_empty() {
        return Vec::new();
    }
    let tables: Vec<_> = generations.iter().map(|generation| &generation.tables).collect();
    let depth = board.depths.iter().copied().max().unwrap_or_default().into();
    let (nodes, taps) = unused_of_kernel(generations, board.taps);
    [
        some(shown.input.constant(depth), |bits| NotExercised::InputBits { bits }),
        some(shown.output.constant(depth), |bits| NotExercised::OutputBits { bits }),
        some(column_lines(&tables, board), |lines| NotExercised::ColumnAddress { lines }),
        some(line_memory_lines(&tables, board), |lines| NotExercised::LineMemoryAddress { lines }),
        some(entry_lines(&tables, board), |lines| NotExercised::RowTableAddress { lines }),
        some(factor_bits(&tables), |bits| NotExercised::RowFactorBits { bits }),
        some(nodes, |nodes| NotExercised::KernelNodes { nodes }),
        some(taps, |taps| NotExercised::Taps { taps }),
        centre(&tables, board, shown.centre),
        some(unused_depths(&tables, board), |bits| NotExercised::Depths { bits }),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// `what` of `items`, if there are any.
fn some<T>(items: Vec<T>, what: impl FnOnce(Vec<T>) -> NotExercised) -> Option<NotExercised> {
    (!items.is_empty()).then(|| what(items))
}

/// The address lines of a memory with this many entries.
fn lines(entries: usize) -> std::ops::Range<usize> {
    0..entries.saturating_sub(1).checked_ilog2().map_or(0, |top| top as usize + 1)
}

/// Address lines of the board's widest row that are 0 at every column of frames with these tables.
fn column_lines(tables: &[&TableSet], board: &Identity) -> Vec<usize> {
    let last = tables.iter().map(|tables| tables.geometry().width() - 1).max().unwrap_or_default();
    lines(board.max_width.into()).filter(|line| last >> line == 0).collect()
}

/// Address lines of the ring that may be stuck unseen. With a stuck line a sample is overwritten by the one 2^line later, which
/// shows only if it is still needed then (DATAPATH.md, "Ring").
fn line_memory_lines(tables: &[&TableSet], board: &Identity) -> Vec<usize> {
    let longest = tables.iter().filter_map(|tables| look_back(tables)).max().unwrap_or_default();
    lines(board.ring.into()).filter(|line| 1_i64 << line > longest).collect()
}

/// The most samples that are stored after one that is still needed. The end of a row decides.
fn look_back(tables: &TableSet) -> Option<i64> {
    let (width, rows) = (tables.geometry().width(), 0..tables.geometry().height());
    let ends = rows.filter_map(|row| Some(tables.values(row)?.source(width - 1).column));
    Some(width as i64 - 1 - ends.min()? + width as i64 / 2 - 1)
}

/// Address lines of the memory of row factors and grids that separate no two different entries.
fn entry_lines(tables: &[&TableSet], board: &Identity) -> Vec<usize> {
    let tells = |line: &usize| {
        tables.iter().any(|tables| {
            let entries: Vec<_> = tables.entries().collect();
            (0..entries.len())
                .any(|entry| entry >> line & 1 == 1 && entries[entry] != entries[entry - (1 << line)])
        })
    };
    let room = board.grids.map_or(board.max_height, |grids| grids.entries.max(board.max_height));
    lines(room.into()).filter(|line| !tells(line)).collect()
}

fn factor_bits(tables: &[&TableSet]) -> Vec<usize> {
    Levels::of(tables.iter().flat_map(|tables| tables.entries())).constant(RowFactor::BITS)
}

/// The nodes with which no output is made, and the taps, of a board with `taps`, that have no weight in any output.
fn unused_of_kernel(generations: &[&Generation], taps: u8) -> (Vec<usize>, Vec<String>) {
    let (mut used, mut weighed) = ([false; NODES], [false; TAP_NAMES.len()]);
    let alike = |one: &Generation, other: &Generation| {
        one.tables.geometry().centre2() == other.tables.geometry().centre2()
            && one.tables.shape() == other.tables.shape()
            && one.tables.entries().eq(other.tables.entries())
            && one.kernel == other.kernel
    };
    for (place, generation) in generations.iter().enumerate() {
        if generations[..place].iter().any(|earlier| alike(earlier, generation)) {
            continue;
        }
        let nodes = nodes_used(&generation.tables);
        for (node, _) in nodes.iter().enumerate().filter(|(_, used)| **used) {
            used[node] = true;
            let [g0, r1, g4, r5, g6] = generation.kernel.nodes()[node].map(i32::from);
            let weights = [g0, r1, (1 << 14) - g0 - g4 - g6, -r1 - r5, g4, r5, g6];
            weighed.iter_mut().zip(weights).for_each(|(weighed, weight)| *weighed |= weight != 0);
        }
    }
    let unused = (0..NODES).filter(|&node| !used[node]).collect();
    let of_board = if taps < 7 { 1..6 } else { 0..7 };
    let unweighed = of_board.filter(|&tap| !weighed[tap]).map(|tap| TAP_NAMES[tap].to_owned()).collect();
    (unused, unweighed)
}

/// The nodes with which outputs are made: the one left of the source, and the next one unless the source is exactly at
/// the first.
fn nodes_used(tables: &TableSet) -> [bool; NODES] {
    let (geometry, mut used) = (tables.geometry(), [false; NODES]);
    for values in (0..geometry.height()).filter_map(|row| tables.values(row)) {
        for column in 0..geometry.width() {
            let Source { node, fraction, .. } = values.source(column);
            used[node] = true;
            used[node + 1] |= fraction > 0;
        }
        if used.iter().all(|&used| used) {
            break;
        }
    }
    used
}

/// The bits of C that may be stuck unseen, of which `shown` have shown themselves.
fn centre(tables: &[&TableSet], board: &Identity, shown: Levels) -> Option<NotExercised> {
    let centres: BTreeSet<_> = tables.iter().map(|tables| tables.geometry().centre2()).collect();
    if centres.len() == 1 {
        return centres.first().map(|&centre2| NotExercised::OneCentre { centre2 });
    }
    let bits = lines(2 * usize::from(board.max_width) - 1).len() as u32;
    some(shown.constant(bits), |bits| NotExercised::CentreBits { bits })
}

fn unused_depths(tables: &[&TableSet], board: &Identity) -> Vec<u32> {
    let used = |bits: &u32| tables.iter().any(|tables| tables.geometry().depth().bits() == *bits);
    board.depths.iter().copied().map(u32::from).filter(|bits| !used(bits)).collect()
}

#[cfg(test)]
mod tests {
    use halfrow_model::{BitDepth, Frame, Geometry, Interpolant, Kernel, Phase};

    use super::*;
    use crate::result::GridsReport;

    fn board(taps: u8) -> Identity {
        Identity {
            name: "made".to_owned(),
            serial: String::new(),
            build: String::new(),
            protocol: 1,
            datapath: 1,
            max_width: 2048,
            max_height: 1024,
            depths: vec![8, 10, 12],
            taps,
            latency: 12,
            ring: 2048,
            least_blanking: 0,
            table_banks: 2,
            row_banks_in: 2,
            row_banks_out: 2,
            clock_hz: 0,
            bursts: None,
            entered: false,
            grids: None,
        }
    }

    /// A generation for frames of 128 x 16.
    fn generation(centre2: u32, interpolant: Interpolant, factor: impl Fn(u32) -> u32) -> Generation {
        let geometry = Geometry::new(128, 16, BitDepth::Twelve, centre2).unwrap();
        let factors = (0..16).map(|row| RowFactor::new(factor(row)).unwrap()).collect();
        let tables = TableSet::new(geometry, factors).unwrap();
        Generation { number: 2, tables, kernel: Kernel::from(interpolant) }
    }

    fn found(taps: u8, generations: &[&Generation]) -> Vec<NotExercised> {
        let mut shown = ShownBits::default();
        // Both levels of every bit of samples, and each bit of every centre.
        let frame = Frame::new(64, BitDepth::Twelve, Phase::Grbg, [0, 4095].repeat(32)).unwrap();
        let centres = generations.iter().map(|generation| generation.tables.geometry().centre2());
        shown.note(&frame, &frame, Levels::of(centres));
        not_exercised(&board(taps), generations, shown)
    }

    fn taps(names: &[&str]) -> NotExercised {
        NotExercised::Taps { taps: names.iter().map(|&name| name.to_owned()).collect() }
    }

    /// Without stretching, every output is its own column: x = 0, so only node 0 and G2 are used, and n = 127 at column
    /// 127, so that a sample is needed while 63 more are stored, too few for line 6. One factor for all rows exercises no
    /// line of the row table, and none of the factor's 25 bits.
    #[test]
    fn a_table_that_stretches_nothing_exercises_next_to_nothing() {
        let generation = generation(127, Interpolant::Hermite, |_| 1 << 24);
        assert_eq!(
            found(7, &[&generation]),
            [
                NotExercised::ColumnAddress { lines: vec![7, 8, 9, 10] },
                NotExercised::LineMemoryAddress { lines: vec![6, 7, 8, 9, 10] },
                NotExercised::RowTableAddress { lines: (0..10).collect() },
                NotExercised::RowFactorBits { bits: (0..25).collect() },
                NotExercised::KernelNodes { nodes: (1..65).collect() },
                taps(&["G0", "R1", "R3", "G4", "R5", "G6"]),
                NotExercised::OneCentre { centre2: 127 },
                NotExercised::Depths { bits: vec![8, 10] },
            ]
        );
    }

    /// At half the distances the sources lie at (127 + 2j)/4: one or three quarters of the way between two columns, at
    /// nodes 8, 24, 40 and 56. That of column 127 is 95.25, so a sample is needed while 32 + 63 = 95 more are stored.
    #[test]
    fn half_the_distances_use_four_nodes() {
        let half = |row| if row == 0 { 1 << 24 } else { 1 << 23 };
        let (all, lines) = (|nodes: &[usize]| (1..65).filter(|node| !nodes.contains(node)).collect(), 4..10);
        let linear = generation(127, Interpolant::Linear, half);
        let found_linear = found(7, &[&linear]);
        assert!(found_linear.contains(&NotExercised::LineMemoryAddress { lines: (7..11).collect() }));
        assert!(found_linear.contains(&NotExercised::RowTableAddress { lines: lines.collect() }));
        assert!(found_linear.contains(&NotExercised::KernelNodes { nodes: all(&[8, 24, 40, 56]) }));
        assert!(found_linear.contains(&NotExercised::RowFactorBits { bits: (0..23).collect() }));
        assert!(found_linear.contains(&taps(&["G0", "R1", "R3", "R5", "G6"])));
    }

    /// At 0.99 of the distances the source of column 127 is 126.365, so a sample is needed while 1 + 63 = 64 more are
    /// stored: with line 6 stuck, the last of these overwrites it.
    #[test]
    fn a_line_tells_samples_apart_that_are_as_far_apart_as_it_counts() {
        let found = found(7, &[&generation(127, Interpolant::Linear, |_| 16_609_444)]);
        assert!(found.contains(&NotExercised::LineMemoryAddress { lines: (7..11).collect() }), "{found:?}");
    }

    /// In addition to node 0, which the tables without stretching use.
    #[test]
    fn tables_that_differ_in_factors_alone_use_nodes_of_their_own() {
        let [none, half] = [24, 23].map(|bit| generation(127, Interpolant::Hermite, |_| 1 << bit));
        let unused = (1..65).filter(|node| ![8, 24, 40, 56].contains(node)).collect();
        assert!(found(7, &[&none, &half]).contains(&NotExercised::KernelNodes { nodes: unused }));
    }

    /// One factor for all rows separates no two entries, and 4,096 of them have twelve address lines.
    #[test]
    fn the_memory_of_a_grid_has_lines_beyond_those_of_the_rows() {
        let grids = GridsReport { entries: 4096, grid_blanking: 32, width: 192 };
        let roomy = Identity { grids: Some(grids), ..board(7) };
        let unmoved = generation(127, Interpolant::Hermite, |_| 1 << 24);
        let parts = not_exercised(&roomy, &[&unmoved], ShownBits::default());
        assert!(parts.contains(&NotExercised::RowTableAddress { lines: (0..12).collect() }), "{parts:?}");
    }

    /// It depends on the kernel and on the board.
    #[test]
    fn five_taps_leave_the_outer_ones_of_seven_unused() {
        let five = generation(127, Interpolant::Hermite, |_| 1 << 23);
        let seven = generation(127, Interpolant::Keys, |_| 1 << 23);
        let is_tap = |part: &NotExercised| matches!(part, NotExercised::Taps { .. });
        let named = |board, generations: &[&Generation]| {
            found(board, generations).into_iter().filter(is_tap).collect::<Vec<_>>()
        };
        assert_eq!(named(7, &[&five]), [taps(&["G0", "G6"])]);
        assert_eq!(named(5, &[&five]), []);
        // Keys' kernel has no weight for R taps, and Hermite's none for G0 and G6.
        assert_eq!(named(7, &[&seven]), [taps(&["R1", "R3", "R5"])]);
        assert_eq!(named(7, &[&five, &seven]), []);
    }

    /// C has 12 bits on a board of 2048 columns: 127 is 0000 0111 1111, and 0 is all zeros.
    #[test]
    fn of_two_centres_the_bits_that_are_the_same_are_told() {
        let [here, there] = [127, 0].map(|centre2| generation(centre2, Interpolant::Linear, |_| 1 << 23));
        let found = found(7, &[&here, &there]);
        assert!(found.contains(&NotExercised::CentreBits { bits: (7..12).collect() }));
    }

    /// 0x0f5 and 0x005: bits 0 and 2 are always 1, 4 to 7 are both, all others always 0.
    #[test]
    fn bits_of_samples_count_on_either_side_of_the_board() {
        let frame =
            |samples: [u16; 2]| Frame::new(64, BitDepth::Twelve, Phase::Grbg, samples.repeat(32)).unwrap();
        let mut shown = ShownBits::default();
        shown.note(&frame([0x0f5, 0x005]), &frame([0, 0xfff]), Levels::default());
        let generation = generation(127, Interpolant::Linear, |_| 1 << 23);
        let found = not_exercised(&board(7), &[&generation], shown);
        assert_eq!(found[0], NotExercised::InputBits { bits: vec![0, 1, 2, 3, 8, 9, 10, 11] });
        assert!(!found.iter().any(|part| matches!(part, NotExercised::OutputBits { .. })));
        shown.note(&frame([0, 0xfff]), &frame([7, 7]), Levels::default());
        assert!(!matches!(
            not_exercised(&board(7), &[&generation], shown)[0],
            NotExercised::InputBits { .. }
        ));
    }
}
