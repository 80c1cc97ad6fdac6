//! The corrector for large amounts of data: the same bits as [`crate::correct_row`], many samples at a time.
//!
//! The oracle next to it follows DATAPATH.md to the letter, and each path here is checked against it. What the paths do
//! differently: a row's ends are copied together with the samples that stand in beyond them, so that no tap is a special case;
//! coordinates are relative to the block of columns, so that they fit 32 bits; and rows with the same row factor, above and
//! below the lens's axis, share coordinates and weights. Rows of a grid do not, since none mirrors another to the bit.

mod content;
mod engine;
mod located;
mod nodes;
mod padded;
mod path;
mod scalar;
mod signer;
mod walk;
#[cfg(target_arch = "x86_64")]
mod x86;

use std::convert::Infallible;
use std::fmt;
use std::sync::Arc;

pub use path::{ModelPath, UnavailablePath, UnknownPath};
pub use signer::Signer;

use crate::corrector::check_frame;
use crate::table::Entries;
use crate::{
    CorrectError, Frame, FrameError, Geometry, Kernel, RowFactor, RowValues, Source, TableSet, source,
};
use engine::{Engine, Rows};
use located::Located;
use padded::Ends;
use walk::{Curve, Line, Walk, blocks};

/// Columns that are computed together. Every width holds at least two blocks.
const BLOCK: usize = 32;

/// Corrects rows and frames with one kernel by one [`ModelPath`].
///
/// Every path gives the same bits for row factors, and for a grid whose sources lie in their rows: one that
/// [`TableSet::check_ring`] accepts with some ring. A program checks this once, before it corrects with a grid that it did not
/// get from a [`Camera`](crate::Camera). No board can serve any other grid, and each path makes something else of it.
///
/// It can be used for any number of rows, frames and geometries. It allocates only when a row is wider than all before it. Each
/// thread takes its own: a clone shares what was computed from the kernel.
pub struct Corrector {
    path: ModelPath,
    engine: Arc<Engine>,
    /// The ends of the two rows that are corrected together.
    ends: [Ends; 2],
    /// The values of the grid's row that is being corrected.
    values: RowValues,
}

impl fmt::Debug for Corrector {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Corrector").field("path", &self.path).finish_non_exhaustive()
    }
}

impl Clone for Corrector {
    fn clone(&self) -> Self {
        Self::of(self.path, Arc::clone(&self.engine))
    }
}

impl Corrector {
    /// A corrector for `kernel`.
    ///
    /// # Errors
    /// [`UnavailablePath`] when this processor does not support `path`.
    pub fn new(path: ModelPath, kernel: &Kernel) -> Result<Self, UnavailablePath> {
        let engine = Engine::new(path, kernel).ok_or(UnavailablePath(path))?;
        Ok(Self::of(path, Arc::new(engine)))
    }

    /// A corrector that is the oracle, which every processor can run.
    #[must_use]
    pub fn oracle(kernel: &Kernel) -> Self {
        Self::of(ModelPath::Reference, Arc::new(Engine::Reference(Box::new(kernel.clone()))))
    }

    fn of(path: ModelPath, engine: Arc<Engine>) -> Self {
        Self { path, engine, ends: Default::default(), values: RowValues::default() }
    }

    /// The path that it takes.
    #[must_use]
    pub fn path(&self) -> ModelPath {
        self.path
    }

    /// Corrects one row with the row factor `row_factor` into `output`, as [`crate::correct_row`] does.
    ///
    /// The samples of `row` must be within the geometry's depth, as those of a [`Frame`] are.
    ///
    /// # Panics
    /// When `row` or `output` holds fewer samples than the geometry's width.
    pub fn correct_row(
        &mut self,
        geometry: &Geometry,
        row_factor: RowFactor,
        row: &[u16],
        output: &mut [u16],
    ) {
        self.engine.correct_rows(&mut self.ends, geometry, row_factor, [row], [output]);
    }

    /// Corrects `row`, which is row `index` of a frame for `tables`, into `output`. For an index that the frame does not have,
    /// `output` stays as it is.
    ///
    /// The samples of `row` must be within the geometry's depth, as those of a [`Frame`] are, and the sources of a grid's row
    /// must lie in the row, as [`TableSet::check_ring`] makes sure.
    ///
    /// # Panics
    /// When `row` or `output` holds fewer samples than the geometry's width.
    pub fn correct_row_of(&mut self, tables: &TableSet, index: usize, row: &[u16], output: &mut [u16]) {
        let geometry = tables.geometry();
        if index >= geometry.height() {
            return;
        }
        match tables.stored() {
            Entries::Rows(row_factors) => self.correct_row(geometry, row_factors[index], row, output),
            Entries::Grid(grid) => {
                let kept = (&mut self.ends, &mut self.values);
                self.engine.correct_row_of_grid(kept, geometry, (grid, index), row, output);
            }
        }
    }

    /// Corrects `frame` into `samples`, row after row. Rows that mirror each other and have the same row factor are corrected
    /// together.
    /// A grid's sources must lie in their rows, as [`TableSet::check_ring`] makes sure.
    ///
    /// # Errors
    /// [`CorrectError`] when the frame's size or depth is not the one that the tables are for.
    ///
    /// # Panics
    /// When the length of `samples` is not the frame's.
    pub fn correct_into(
        &mut self,
        tables: &TableSet,
        frame: &Frame,
        samples: &mut [u16],
    ) -> Result<(), CorrectError> {
        check_frame(tables.geometry(), frame)?;
        assert_eq!(samples.len(), frame.samples().len(), "the output has another size than the frame");
        let _: Result<(), Infallible> = self.correct_pairs(tables, frame.samples(), samples, |_, _| Ok(()));
        Ok(())
    }

    /// Corrects the samples of a frame for which there is no [`Frame`], such as those that another program holds, into
    /// `output`: both W·H samples, row after row. Each row is checked next to its correction, while it is in the cache. A
    /// grid's sources must lie in their rows, as [`TableSet::check_ring`] makes sure.
    ///
    /// # Errors
    /// [`FrameError::TooBright`] for the first sample that the depth cannot hold. The content of `output` is then meaningless.
    ///
    /// # Panics
    /// When the length of `samples` or `output` is not W·H.
    pub fn correct_samples(
        &mut self,
        tables: &TableSet,
        samples: &[u16],
        output: &mut [u16],
    ) -> Result<(), FrameError> {
        let geometry = tables.geometry();
        let (width, depth) = (geometry.width(), geometry.depth());
        assert_eq!(samples.len(), width * geometry.height(), "the input has another size than the tables");
        assert_eq!(output.len(), samples.len(), "the output has another size than the input");
        let checked = self.correct_pairs(tables, samples, output, |engine, row| {
            if engine.bits_of(row) <= depth.max() { Ok(()) } else { Err(()) }
        });
        // Rows are not corrected from the top down, but the first such sample is to be reported.
        checked.or_else(|()| FrameError::check(width, depth, samples))
    }

    /// Corrects all rows, in pairs that mirror each other. Each row must pass `check`, before or after its correction.
    fn correct_pairs<E>(
        &mut self,
        tables: &TableSet,
        samples: &[u16],
        output: &mut [u16],
        check: impl Fn(&Engine, &[u16]) -> Result<(), E>,
    ) -> Result<(), E> {
        let (width, height) = (tables.geometry().width(), tables.geometry().height());
        let (upper, lower) = output.split_at_mut(height.div_ceil(2) * width);
        let mut lower = lower.rchunks_exact_mut(width);
        for (row, output) in upper.chunks_exact_mut(width).enumerate() {
            let mirrored = height - 1 - row;
            let inputs = [row, mirrored].map(|row| &samples[row * width..][..width]);
            let is_checked_first = !self.engine.takes_any_sample();
            if is_checked_first {
                inputs.iter().try_for_each(|row| check(&self.engine, row))?;
            }
            match lower.next() {
                None => self.correct_row_of(tables, row, inputs[0], output),
                Some(below) => self.correct_pair(tables, [row, mirrored], inputs, [output, below]),
            }
            if !is_checked_first {
                inputs.iter().try_for_each(|row| check(&self.engine, row))?;
            }
        }
        Ok(())
    }

    /// Corrects the two rows numbered `rows`, together if they have the same row factor.
    fn correct_pair(
        &mut self,
        tables: &TableSet,
        rows: [usize; 2],
        inputs: [&[u16]; 2],
        outputs: [&mut [u16]; 2],
    ) {
        if let [Some(upper), Some(lower)] = rows.map(|row| tables.row_factor(row))
            && upper == lower
        {
            self.engine.correct_rows(&mut self.ends, tables.geometry(), upper, inputs, outputs);
            return;
        }
        for ((row, input), output) in rows.into_iter().zip(inputs).zip(outputs) {
            self.correct_row_of(tables, row, input, output);
        }
    }

    /// The corrected frame, the same as [`crate::correct`] gives if a grid's sources lie in their rows, as
    /// [`TableSet::check_ring`] makes sure.
    ///
    /// # Errors
    /// [`CorrectError`] when the frame's size or depth is not the one that the tables are for.
    pub fn correct(&mut self, tables: &TableSet, frame: &Frame) -> Result<Frame, CorrectError> {
        let mut samples = vec![0; frame.samples().len()];
        self.correct_into(tables, frame, &mut samples)?;
        Ok(frame.with_samples(samples))
    }

    /// Where this path takes the outputs of a row from: a into `bases` and x, in units of 2^-13 column, into `distances`,
    /// column after column. They are those of [`crate::source`], with x = 256·i + t.
    ///
    /// # Panics
    /// When `bases` or `distances` is shorter than the geometry's width.
    pub fn locate(
        &self,
        geometry: &Geometry,
        row_factor: RowFactor,
        bases: &mut [i16],
        distances: &mut [u16],
    ) {
        let walk = Line::new(geometry, row_factor);
        let oracle = |column| source(geometry, row_factor, column);
        self.locate_along(walk, oracle, geometry, (bases, distances));
    }

    /// [`Self::locate`] for a row with `values`; the sources are those of [`RowValues::source`].
    ///
    /// # Panics
    /// When `bases` or `distances` is shorter than the geometry's width, or `values` are for a narrower one.
    pub fn locate_by_values(
        &self,
        geometry: &Geometry,
        values: &RowValues,
        bases: &mut [i16],
        distances: &mut [u16],
    ) {
        let oracle = |column| values.source(column);
        self.locate_along(Curve::new(values.nodes()), oracle, geometry, (bases, distances));
    }

    fn locate_along(
        &self,
        mut walk: impl Walk,
        oracle: impl Fn(usize) -> Source,
        geometry: &Geometry,
        (bases, distances): (&mut [i16], &mut [u16]),
    ) {
        let width = geometry.width();
        for column in blocks(width) {
            let located = match *self.engine {
                Engine::Reference(_) => Located::by_oracle(column, &oracle),
                _ => self.engine.locate(&mut walk),
            };
            located.write(&mut bases[column..width], &mut distances[column..width]);
        }
    }
}
