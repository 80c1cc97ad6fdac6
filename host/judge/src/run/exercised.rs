//! What the frames of a run put to the test in a board, and what they left untouched, found on the reference's side: from
//! what was uploaded, and from the samples that went in and should have come out.

use std::collections::BTreeSet;

use halfrow_model::{Frame, Geometry, NODES, Source, TableSet, source};

use super::plan::Generation;
use crate::result::{Identity, NotExercised};

/// Bits of a row factor.
const FACTOR_BITS: u32 = 25;
/// The taps in the order of their columns.
const TAPS: [&str; 7] = ["G0", "R1", "G2", "R3", "G4", "R5", "G6"];

/// The levels that bits have had.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Levels {
    ones: u32,
    zeros: u32,
}

impl Levels {
    fn of(values: impl IntoIterator<Item = u32>) -> Self {
        values.into_iter().fold(Self::default(), |levels, value| Self {
            ones: levels.ones | value,
            zeros: levels.zeros | !value,
        })
    }

    /// Takes the samples of a frame, unless it could add nothing.
    fn note(&mut self, frame: &Frame) {
        if !self.constant(frame.depth().bits()).is_empty() {
            let Self { ones, zeros } = Self::of(frame.samples().iter().copied().map(u32::from));
            self.ones |= ones;
            self.zeros |= zeros;
        }
    }

    /// Those of the lowest `bits` that were never both 0 and 1.
    fn constant(self, bits: u32) -> Vec<usize> {
        (0..bits).filter(|bit| (self.ones & self.zeros) >> bit & 1 == 0).map(|bit| bit as usize).collect()
    }
}

/// The levels that the bits of samples have had.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct SampleLevels {
    input: Levels,
    output: Levels,
}

impl SampleLevels {
    /// Takes a frame that went in, and what should have come out.
    pub(super) fn note(&mut self, input: &Frame, output: &Frame) {
        self.input.note(input);
        self.output.note(output);
    }
}

/// What frames corrected with `generations` left untouched of `board`.
pub(super) fn not_exercised(
    board: &Identity,
    generations: &[&Generation],
    samples: SampleLevels,
) -> Vec<NotExercised> {
    let Some(first) = generations.first() else { return Vec::new() };
    let geometry = first.tables.geometry();
    let tables: Vec<_> = generations.iter().map(|generation| &generation.tables).collect();
    let depth = board.depths.iter().copied().max().unwrap_or_default().into();
    let (nodes, taps) = unused_of_kernel(generations, board.taps);
    [
        some(samples.input.constant(depth), |bits| NotExercised::InputBits { bits }),
        some(samples.output.constant(depth), |bits| NotExercised::OutputBits { bits }),
        some(column_lines(geometry, board), |lines| NotExercised::ColumnAddress { lines }),
        some(line_memory_lines(&tables, board), |lines| NotExercised::LineMemoryAddress { lines }),
        some(row_table_lines(&tables, board), |lines| NotExercised::RowTableAddress { lines }),
        some(factor_bits(&tables), |bits| NotExercised::RowFactorBits { bits }),
        some(nodes, |nodes| NotExercised::KernelNodes { nodes }),
        some(taps, |taps| NotExercised::Taps { taps }),
        centre(&tables, board),
        some(unused_depths(&tables, board), |bits| NotExercised::Depths { bits }),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// What `items` are, if there are any.
fn some<T>(items: Vec<T>, what: impl FnOnce(Vec<T>) -> NotExercised) -> Option<NotExercised> {
    (!items.is_empty()).then(|| what(items))
}

/// The lines that address so many entries.
fn lines(entries: usize) -> std::ops::Range<usize> {
    0..entries.saturating_sub(1).checked_ilog2().map_or(0, |top| top as usize + 1)
}

/// Lines of the board's widest row that are 0 at every column of these.
fn column_lines(geometry: &Geometry, board: &Identity) -> Vec<usize> {
    lines(board.max_width.into()).filter(|line| (geometry.width() - 1) >> line == 0).collect()
}

/// Lines of the ring that may be stuck unseen. A sample's place is also that of the one 2^line later then, so it must still
/// be needed when that one has been stored (DATAPATH.md, "Ring").
fn line_memory_lines(tables: &[&TableSet], board: &Identity) -> Vec<usize> {
    let longest = tables.iter().filter_map(|tables| look_back(tables)).max().unwrap_or_default();
    lines(board.ring.into()).filter(|line| 1_i64 << line > longest).collect()
}

/// The most samples that are stored behind one that is still needed. The row that is stretched most decides, at its end.
fn look_back(tables: &TableSet) -> Option<i64> {
    let (geometry, &step) = (tables.geometry(), tables.steps().iter().min()?);
    let last = geometry.width() - 1;
    Some(last as i64 - source(geometry, step, last).column + geometry.width() as i64 / 2 - 1)
}

/// Lines of the board's row table that tell no two rows of different factors apart.
fn row_table_lines(tables: &[&TableSet], board: &Identity) -> Vec<usize> {
    let tells = |line: &usize| {
        tables.iter().any(|tables| {
            let steps = tables.steps();
            let above = (0..steps.len()).filter(|row| row >> line & 1 == 1);
            above.into_iter().any(|row| steps[row] != steps[row - (1 << line)])
        })
    };
    lines(board.max_height.into()).filter(|line| !tells(line)).collect()
}

fn factor_bits(tables: &[&TableSet]) -> Vec<usize> {
    Levels::of(tables.iter().flat_map(|tables| tables.steps()).copied()).constant(FACTOR_BITS)
}

/// Nodes that no output is made with, and taps of a board of `taps` that weigh nothing in any.
fn unused_of_kernel(generations: &[&Generation], taps: u8) -> (Vec<usize>, Vec<String>) {
    let (mut used, mut weighed) = ([false; NODES], [false; TAPS.len()]);
    let alike = |one: &Generation, other: &Generation| {
        one.tables.geometry().centre2() == other.tables.geometry().centre2()
            && one.tables.steps() == other.tables.steps()
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
    let unweighed = of_board.filter(|&tap| !weighed[tap]).map(|tap| TAPS[tap].to_owned()).collect();
    (unused, unweighed)
}

/// The nodes that outputs are made with: the one left of the source, and the next one unless it lies right on the first.
fn nodes_used(tables: &TableSet) -> [bool; NODES] {
    let (geometry, mut used) = (tables.geometry(), [false; NODES]);
    let steps: BTreeSet<_> = tables.steps().iter().copied().collect();
    for step in steps {
        for column in 0..geometry.width() {
            let Source { node, fraction, .. } = source(geometry, step, column);
            used[node] = true;
            used[node + 1] |= fraction > 0;
        }
        if used.iter().all(|&used| used) {
            break;
        }
    }
    used
}

fn centre(tables: &[&TableSet], board: &Identity) -> Option<NotExercised> {
    let centres: BTreeSet<_> = tables.iter().map(|tables| tables.geometry().centre2()).collect();
    if centres.len() == 1 {
        return centres.first().map(|&centre2| NotExercised::OneCentre { centre2 });
    }
    let bits = lines(2 * usize::from(board.max_width) - 1).len() as u32;
    some(Levels::of(centres).constant(bits), |bits| NotExercised::CentreBits { bits })
}

fn unused_depths(tables: &[&TableSet], board: &Identity) -> Vec<u32> {
    let used = |bits: &u32| tables.iter().any(|tables| tables.geometry().depth().bits() == *bits);
    board.depths.iter().copied().map(u32::from).filter(|bits| !used(bits)).collect()
}
