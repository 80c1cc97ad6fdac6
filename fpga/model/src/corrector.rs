//! The corrector: the integer datapath, bit for bit (DATAPATH.md). Written for clarity, since boards are judged by it.

use crate::kernel::WEIGHT_ONE;
use crate::table::Entries;
use crate::{Frame, Geometry, Kernel, RowFactor, RowValues, TableSet};

/// Where an output sample comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Source {
    /// a: the column of tap G2, the nearest column at or left of the source that has the output's colour; −1 to W − 1.
    pub base: i64,
    /// n: the column at or left of the source, 0 to W − 1.
    pub column: i64,
    /// i: the kernel node at or left of the source, 0 to 63.
    pub node: usize,
    /// t: how far the source is from that node to the next, in 256ths, 0 to 255.
    pub fraction: i32,
}

/// The frame has another size or depth than the tables are for.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CorrectError {
    /// The frame's size is not the table set's.
    #[error(
        "the frame is {frame_width} x {frame_height} and the tables are for {width} x {height}; \
         make the tables for the frame's size"
    )]
    Size {
        /// Columns of the frame.
        frame_width: usize,
        /// Rows of the frame.
        frame_height: usize,
        /// Columns of the geometry.
        width: usize,
        /// Rows of the geometry.
        height: usize,
    },
    /// The frame's depth is not the table set's.
    #[error(
        "the frame has {frame} bits a sample and the tables are for {tables}; make the tables for the frame's depth"
    )]
    Depth {
        /// Bits of the frame's samples.
        frame: u32,
        /// Bits of the geometry's samples.
        tables: u32,
    },
}

/// Where the output of `column`, 0 to W − 1, comes from in a row with the row factor `row_factor`.
///
/// # Panics
/// May panic when the row has no such column.
#[must_use]
pub fn source(geometry: &Geometry, row_factor: RowFactor, column: usize) -> Source {
    source_by_entry(geometry.centre2(), row_factor.get(), column)
}

/// The arithmetic of [`source`] for any words in place of C and Q: what a board makes of a centre and an entry that it misreads.
/// With C above 2W − 2 or Q above 2^24 the source may lie outside the row.
#[must_use]
pub fn source_by_entry(centre2: u32, entry: u32, column: usize) -> Source {
    locate(q_of_line(row_start(centre2, entry) + 2 * column as i64 * i64::from(entry)), column)
}

/// S[0] = C · (2^24 − Q), in units of 2^-25 pixel.
fn row_start(centre2: u32, entry: u32) -> i64 {
    i64::from(centre2) * (i64::from(RowFactor::ONE.get()) - i64::from(entry))
}

/// q, in units of 2^-13 pixel, of an S of datapath 1, which is in units of 2^-25 pixel.
fn q_of_line(coordinate: i64) -> i64 {
    (coordinate + (1 << 11)) >> 12
}

/// The source of `column`, from q.
pub(crate) fn locate(q: i64, column: usize) -> Source {
    let n = q >> 13;
    let base = base_column(n, column);
    let x = q - (base << 13);
    Source { base, column: n, node: (x >> 8) as usize, fraction: (x & 255) as i32 }
}

/// a: the nearest column at or left of `n` whose colour is that of `column`.
pub(crate) fn base_column(n: i64, column: usize) -> i64 {
    n - ((n ^ column as i64) & 1)
}

/// The taps G0 R1 G2 R3 G4 R5 G6 around the base column a.
pub(crate) fn taps(geometry: &Geometry, row: &[u16], base: i64) -> [u16; 7] {
    let inside = usize::try_from(base - 2).ok().and_then(|first| row.get(first..)?.first_chunk());
    // Only the row's ends need the edge rule. Its arithmetic at every tap would take half the time of a frame.
    inside
        .copied()
        .unwrap_or_else(|| std::array::from_fn(|tap| row[geometry.sample_column(base - 2 + tap as i64)]))
}

/// The output sample: the taps weighed with the five weights, rounded half up and clamped to 0..=`max`.
fn blend(weights: [i32; 5], taps: [u16; 7], max: u16) -> u16 {
    let [g0, r1, g4, r5, g6] = weights;
    let [s0, s1, s2, s3, s4, s5, s6] = taps.map(i32::from);
    let sum =
        s2 * WEIGHT_ONE + g0 * (s0 - s2) + g4 * (s4 - s2) + g6 * (s6 - s2) + r1 * (s1 - s3) + r5 * (s5 - s3);
    ((sum + WEIGHT_ONE / 2) >> 14).clamp(0, i32::from(max)) as u16
}

/// Corrects one row with the row factor `row_factor` into `output`.
///
/// # Panics
/// When `row` or `output` holds fewer samples than the geometry's width. May panic when samples of `row` exceed the geometry's
/// depth, which those of a [`Frame`] never do.
pub fn correct_row(
    geometry: &Geometry,
    row_factor: RowFactor,
    kernel: &Kernel,
    row: &[u16],
    output: &mut [u16],
) {
    let mut coordinate = row_start(geometry.centre2(), row_factor.get());
    let source = |column| {
        let source = locate(q_of_line(coordinate), column);
        coordinate += 2 * i64::from(row_factor.get());
        source
    };
    correct_from(geometry, source, kernel, row, output);
}

/// Corrects one row with `values`, which are those of a table for this geometry, into `output`.
///
/// # Panics
/// When `row` or `output` holds fewer samples than the geometry's width, or `values` are for a narrower one. May panic when
/// samples of `row` exceed the geometry's depth, which those of a [`Frame`] never do.
pub fn correct_row_of_values(
    geometry: &Geometry,
    values: &RowValues,
    kernel: &Kernel,
    row: &[u16],
    output: &mut [u16],
) {
    correct_from(geometry, |column| values.source(column), kernel, row, output);
}

/// Corrects a row whose outputs come from `source`, which is called column by column from the left.
fn correct_from(
    geometry: &Geometry,
    mut source: impl FnMut(usize) -> Source,
    kernel: &Kernel,
    row: &[u16],
    output: &mut [u16],
) {
    let row = &row[..geometry.width()];
    for (column, sample) in output[..geometry.width()].iter_mut().enumerate() {
        let source = source(column);
        let weights = kernel.weights_at(source.node, source.fraction);
        *sample = blend(weights, taps(geometry, row, source.base), geometry.depth().max());
    }
}

/// The corrected frame: what a board must return.
///
/// # Errors
/// [`CorrectError`] when the frame's size or depth is not the one that the tables are for.
pub fn correct(tables: &TableSet, kernel: &Kernel, frame: &Frame) -> Result<Frame, CorrectError> {
    let geometry = tables.geometry();
    check_frame(geometry, frame)?;
    let mut samples = vec![0; frame.samples().len()];
    let outputs = samples.chunks_exact_mut(geometry.width());
    let mut values = RowValues::default();
    for (index, (row, output)) in frame.rows().zip(outputs).enumerate() {
        match tables.stored() {
            Entries::Rows(row_factors) => correct_row(geometry, row_factors[index], kernel, row, output),
            Entries::Grid(grid) => {
                grid.values(geometry.centre2(), index, &mut values);
                correct_row_of_values(geometry, &values, kernel, row, output);
            }
        }
    }
    Ok(frame.with_samples(samples))
}

impl TableSet {
    /// Checks that `frame` has the size and the depth that the tables are for.
    ///
    /// # Errors
    /// [`CorrectError`] when it has not.
    pub fn check_frame(&self, frame: &Frame) -> Result<(), CorrectError> {
        check_frame(self.geometry(), frame)
    }
}

/// Checks that `frame` has the size and the depth of `geometry`.
pub(crate) fn check_frame(geometry: &Geometry, frame: &Frame) -> Result<(), CorrectError> {
    let (width, height) = (geometry.width(), geometry.height());
    if (frame.width(), frame.height()) != (width, height) {
        let (frame_width, frame_height) = (frame.width(), frame.height());
        return Err(CorrectError::Size { frame_width, frame_height, width, height });
    }
    if frame.depth() != geometry.depth() {
        return Err(CorrectError::Depth { frame: frame.depth().bits(), tables: geometry.depth().bits() });
    }
    Ok(())
}
