//! The datapath with one part broken.
//!
//! Other samples, factors and weights go through the reference itself, [`RowTables::corrected`]. Only what the reference has no
//! input for is computed here: a sum that is not rounded or not clamped, taps that carry other samples, memory that changes
//! between two reads, a factor above 1, and a grid that leads out of the row. Here a row is read as a board reads it, through a
//! window of eight samples with one read a pixel clock (DATAPATH.md, "Ring").

use std::ops::Range;
use std::rc::Rc;

use halfrow_model::{
    Geometry, Kernel, RowFactor, RowValues, Source, TableSet, correct_row, correct_row_of_values,
    source_by_entry,
};

/// Samples in the window, columns n − 3 to n + 4.
const WINDOW: usize = 8;
/// Columns of the window left and right of n.
const LEFT: i64 = 3;
const RIGHT: i64 = 4;
/// How many columns past the middle of the row the newest sample is when the first output is read.
pub(super) const LOOK_AHEAD: usize = 3;
/// The column n has 12 bits. A factor above 1 makes it wrap.
const COLUMNS: i64 = 1 << 12;
/// A position has 13 fractional bits. The bit above them says that the base is left of n.
const LEFT_OF_N: usize = 1 << 13;

/// How far a row is stretched.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Stretch {
    /// By the table entry as the board reads it: a row factor if the board is sound, otherwise any word.
    Factor(u32),
    /// By the values of the row that the board finds in a grid.
    Grid(Rc<RowValues>),
}

impl Stretch {
    /// The stretch of a row by the tables in a frame of `geometry`, if they have the row and are as wide.
    pub(super) fn of(tables: &TableSet, geometry: &Geometry, row: usize) -> Option<Self> {
        let is_as_wide = tables.geometry().width() == geometry.width();
        is_as_wide.then(|| Self::about(tables, geometry.centre2(), row)).flatten()
    }

    /// The stretch of a row by the tables, if they have it. The values of a grid depend on the optical centre that the board
    /// has, whichever frames the grid was made for.
    pub(super) fn about(tables: &TableSet, centre2: u32, row: usize) -> Option<Self> {
        match tables.shape() {
            None => tables.row_factor(row).map(|factor| Self::Factor(factor.get())),
            Some(_) => tables.values_about(centre2, row).map(|values| Self::Grid(Rc::new(values))),
        }
    }
}

/// What a row is made with.
#[derive(Clone, Debug)]
pub(super) struct RowTables<'a> {
    /// Size, depth and centre.
    pub(super) geometry: &'a Geometry,
    /// C as the board has it, which may lie beyond the row.
    pub(super) centre2: u32,
    /// How far the row is stretched.
    pub(super) stretch: Stretch,
    /// The kernel.
    pub(super) kernel: &'a Kernel,
}

/// A tap that does not carry its own sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct DeadTap {
    /// The tap, 0 for G0 to 6 for G6.
    pub(super) tap: usize,
    /// The tap whose sample it carries instead; none for zero.
    pub(super) reads: Option<usize>,
}

/// How the arithmetic is wired. The default is as specified.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wiring {
    /// Added to the weighted sum before its 14 fractional bits are dropped.
    pub(super) rounding: i32,
    /// Added to the product between two nodes before its 8 fractional bits are dropped.
    pub(super) weight_rounding: i32,
    /// Whether the product between two nodes loses its fraction toward zero instead of down.
    pub(super) toward_zero: bool,
    /// Whether weights are taken as numbers without a sign.
    pub(super) unsigned_weights: bool,
    /// Whether half of what remains is added to a source coordinate before its last bits are dropped.
    pub(super) rounds_source: bool,
    /// Whether outputs below 0 become 0; otherwise they wrap.
    pub(super) clamps_low: bool,
    /// Whether outputs above 2^B − 1 become 2^B − 1; otherwise they wrap.
    pub(super) clamps_high: bool,
    /// A tap that does not carry its own sample.
    pub(super) dead_tap: Option<DeadTap>,
    /// Whether the base column has the colour that is not the output's own.
    pub(super) other_colour: bool,
}

impl Default for Wiring {
    fn default() -> Self {
        Self {
            rounding: 1 << 13,
            weight_rounding: 1 << 7,
            toward_zero: false,
            unsigned_weights: false,
            rounds_source: true,
            clamps_low: true,
            clamps_high: true,
            dead_tap: None,
            other_colour: false,
        }
    }
}

impl RowTables<'_> {
    /// What a sound board makes of `input`, a row of the geometry's width, with these tables.
    pub(super) fn corrected(&self, input: &[u16]) -> Vec<u16> {
        let mut output = vec![0; self.geometry.width()];
        match &self.stretch {
            Stretch::Factor(entry) => {
                let legal = RowFactor::new(*entry).ok().filter(|_| self.centre2 == self.geometry.centre2());
                let Some(row_factor) = legal else { return self.read(input) };
                correct_row(self.geometry, row_factor, self.kernel, input, &mut output);
            }
            Stretch::Grid(_) if !self.lies_in_row() => return self.read(input),
            Stretch::Grid(values) => {
                correct_row_of_values(self.geometry, values, self.kernel, input, &mut output);
            }
        }
        output
    }

    /// The same through the window, which also works with illegal tables.
    fn read(&self, input: &[u16]) -> Vec<u16> {
        self.run(&Wiring::default(), |column, _| self.sample_of(input, column))
    }

    /// Whether every output comes from within the row. The first and the last one decide: n never falls, except where it wraps.
    fn lies_in_row(&self) -> bool {
        let last = self.geometry.width() - 1;
        let [first, end] = [0, last].map(|column| self.source(column).column);
        (first..=last as i64).contains(&end)
    }

    /// The longest range of columns for which a board with a ring of `ring` samples has every sample that it reads. With legal
    /// tables these are all columns.
    pub(super) fn foretold(&self, ring: usize) -> Range<usize> {
        let in_ring = |output: usize, column: i64| {
            let newest = output + self.geometry.width() / 2 + LOOK_AHEAD;
            newest.checked_sub(self.geometry.sample_column(column)).is_some_and(|age| age < ring)
        };
        let mut sound = Vec::new();
        let mut reads = 0;
        let mut before = None;
        for output in 0..self.geometry.width() {
            let column = self.source(output).column.rem_euclid(COLUMNS);
            if before != Some(column) {
                let first = if before.is_none() { column - LEFT } else { column + RIGHT };
                let read = (first..=column + RIGHT).map(|m| in_ring(output, m));
                reads = read.fold(reads, |reads, sound| if sound { reads + 1 } else { 0 });
                before = Some(column);
            }
            sound.push(reads >= WINDOW);
        }
        widest(&sound)
    }

    /// What a board with this wiring makes of a row. `read` gives the sample that the window gets for a column, which may lie
    /// outside the row, at the time of an output.
    pub(super) fn run(&self, wiring: &Wiring, read: impl Fn(i64, usize) -> u16) -> Vec<u16> {
        let mut window: Option<Window> = None;
        (0..self.geometry.width())
            .map(|output| {
                let (column, distance) = self.position(output, wiring);
                let column = column.rem_euclid(COLUMNS);
                let window = window.get_or_insert_with(|| Window::load(column, |m| read(m, output)));
                window.follow(column, |m| read(m, output));
                let position = distance ^ if wiring.other_colour { LEFT_OF_N } else { 0 };
                let taps = window.taps(position & LEFT_OF_N != 0);
                wiring.output(self.kernel, position, taps, self.geometry.depth().max())
            })
            .collect()
    }

    /// Where the output at a column comes from.
    pub(super) fn source(&self, column: usize) -> Source {
        match &self.stretch {
            Stretch::Factor(entry) => source_by_entry(self.centre2, *entry, column),
            Stretch::Grid(values) => values.source(column),
        }
    }

    /// n and x of the output at a column: the column at or left of its source, and the distance of the source from the base.
    fn position(&self, column: usize, wiring: &Wiring) -> (i64, usize) {
        if wiring.rounds_source {
            let source = self.source(column);
            return (source.column, source.node << 8 | source.fraction as usize);
        }
        let unrounded = match &self.stretch {
            Stretch::Factor(entry) => {
                let (centre2, entry) = (i64::from(self.centre2), i64::from(*entry));
                ((centre2 << 24) + (2 * column as i64 - centre2) * entry) >> 12
            }
            Stretch::Grid(values) => (values.coordinate(column) >> 15).rem_euclid(COLUMNS << 13),
        };
        let n = unrounded >> 13;
        let base = n - ((n ^ column as i64) & 1);
        (n, (unrounded - (base << 13)) as usize)
    }

    /// The output at one column of `input`.
    pub(super) fn output(&self, input: &[u16], column: usize) -> u16 {
        self.output_of_taps(input, self.source(column))
    }

    /// The output whose taps and weights are those of `source`.
    pub(super) fn output_of_taps(&self, input: &[u16], source: Source) -> u16 {
        let position = source.node << 8 | source.fraction as usize;
        let taps = std::array::from_fn(|tap| self.sample_of(input, source.base - 2 + tap as i64));
        Wiring::default().output(self.kernel, position, taps, self.geometry.depth().max())
    }

    /// P(m): the row's sample at a column, or the sample that stands in for a column outside the row.
    pub(super) fn sample_of(&self, row: &[u16], column: i64) -> u16 {
        row.get(self.geometry.sample_column(column)).copied().unwrap_or_default()
    }
}

impl Wiring {
    /// One output: the taps G0 to G6 weighted at `position`, in units of 2^-13 column right of the base.
    fn output(&self, kernel: &Kernel, position: usize, taps: [u16; 7], max: u16) -> u16 {
        let [g0, r1, g4, r5, g6] = self.weights(kernel, position);
        let [s0, s1, s2, s3, s4, s5, s6] = self.carried(taps).map(i32::from);
        let own = g0 * (s0 - s2) + g4 * (s4 - s2) + g6 * (s6 - s2);
        let other = r1 * (s1 - s3) + r5 * (s5 - s3);
        self.limited(((s2 << 14) + own + other + self.rounding) >> 14, i32::from(max))
    }

    fn weights(&self, kernel: &Kernel, position: usize) -> [i32; 5] {
        let node = position >> 8 & 63;
        let fraction = (position & 255) as i32;
        let weight = |word: i16| {
            if self.unsigned_weights { word.cast_unsigned().into() } else { i32::from(word) }
        };
        let (low, high) = (kernel.nodes()[node].map(weight), kernel.nodes()[node + 1].map(weight));
        std::array::from_fn(|tap| {
            let between = (high[tap] - low[tap]) * fraction + self.weight_rounding;
            low[tap] + if self.toward_zero { between / 256 } else { between >> 8 }
        })
    }

    fn carried(&self, taps: [u16; 7]) -> [u16; 7] {
        let mut carried = taps;
        if let Some(DeadTap { tap, reads }) = self.dead_tap
            && let Some(carried) = carried.get_mut(tap)
        {
            *carried = reads.and_then(|other| taps.get(other).copied()).unwrap_or_default();
        }
        carried
    }

    /// An output that is not clamped wraps. In two's complement, and as the maximum is 2^B − 1, that is a mask.
    fn limited(&self, value: i32, max: i32) -> u16 {
        let clamps = if value < 0 { self.clamps_low } else { self.clamps_high };
        (if clamps { value.clamp(0, max) } else { value & max }) as u16
    }
}

/// The longest range in which all marks are true; the first of several.
fn widest(marks: &[bool]) -> Range<usize> {
    let mut widest = 0..0;
    let mut start = 0;
    for (place, mark) in marks.iter().enumerate() {
        if !mark {
            start = place + 1;
        } else if place + 1 - start > widest.len() {
            widest = start..place + 1;
        }
    }
    widest
}

/// The eight samples that serve all taps of an output.
struct Window {
    samples: [u16; WINDOW],
    column: i64,
}

impl Window {
    fn load(column: i64, read: impl Fn(i64) -> u16) -> Self {
        Self { samples: std::array::from_fn(|place| read(column - LEFT + place as i64)), column }
    }

    /// Moves to `column`. There is time for only one read, even if n jumps.
    fn follow(&mut self, column: i64, read: impl Fn(i64) -> u16) {
        if column != self.column {
            self.column = column;
            self.samples.rotate_left(1);
            self.samples[WINDOW - 1] = read(column + RIGHT);
        }
    }

    fn taps(&self, left_of_n: bool) -> [u16; 7] {
        let first = usize::from(!left_of_n);
        std::array::from_fn(|tap| self.samples[first + tap])
    }
}
