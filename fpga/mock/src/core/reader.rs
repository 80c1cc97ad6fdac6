//! A row on its way out: every pixel clock makes one output sample from the ring.

use std::sync::Arc;

use super::defects::CoreDefects;
use super::delay::Leaving;
use super::kernel::Kernel;
use super::ring::Ring;
use super::source::{FRACTION_BITS, Source};
use super::values::RowValues;
use super::weights::Weights;
use super::window::Window;
use crate::depth::Depth;

/// What a row is bound to when its first sample enters. It is kept until the last sample has left.
#[derive(Clone, Debug)]
pub struct RowBinding {
    /// Columns W.
    pub width: u16,
    /// Twice the optical centre's column, C.
    pub centre2: u16,
    /// Bits of a sample; outputs are clamped to them.
    pub depth: Depth,
    /// Where its columns come from.
    pub values: RowValues,
    /// The interpolation kernel.
    pub kernel: Arc<Kernel>,
}

/// The state of the row that is leaving.
#[derive(Debug)]
pub(crate) struct Reader {
    row: RowInRing,
    kernel: Arc<Kernel>,
    largest: i32,
    column: u16,
    source: Source,
    window: Window,
}

impl Reader {
    /// Starts to read a row whose first sample went to the address `base`, and loads the whole window.
    #[cold]
    pub(crate) fn start(binding: &RowBinding, base: usize, ring: &Ring, defects: &CoreDefects) -> Self {
        let row = RowInRing {
            base,
            width: i32::from(binding.width),
            offset: defects.tap_offset,
            nearest_edge: defects.nearest_edge,
        };
        let source = Source::new(binding.centre2, &binding.values, defects.source_rounding);
        let window = Window::load(source.position().n, |column| row.sample(ring, column));
        let largest = i32::from(binding.depth.largest());
        Self { row, kernel: Arc::clone(&binding.kernel), largest, column: 0, source, window }
    }

    /// One pixel clock: the sample of the next column, until the row ends.
    #[inline(always)]
    pub(crate) fn make(&mut self, ring: &Ring, defects: &CoreDefects) -> Option<Leaving> {
        let column = self.column;
        if i32::from(column) >= self.row.width {
            return None;
        }
        let position = self.source.advance();
        let row = &self.row;
        self.window.follow(position.n, |column| row.sample(ring, column));
        let other_colour = (position.n ^ i32::from(column)) & 1;
        let taps = self.window.taps(other_colour == 1);
        let taps = defects.taps(taps);
        let x = ((other_colour as u32) << FRACTION_BITS) | position.fraction;
        let sum = Weights::at(&self.kernel, x, defects.weighing).sum(taps, defects.rounding);
        self.column += 1;
        Some(Leaving { sample: defects.output(sum, self.largest), column })
    }
}

/// Where a row lies in the ring.
#[derive(Debug)]
struct RowInRing {
    base: usize,
    width: i32,
    offset: i32,
    /// Whether the nearest sample stands in beyond the ends, whatever its colour.
    nearest_edge: bool,
}

impl RowInRing {
    /// P(m): the row's sample at a column or, outside the row, the nearest one of the same colour.
    #[inline]
    fn sample(&self, ring: &Ring, column: i32) -> u16 {
        let column = column + self.offset;
        let inside = if self.nearest_edge {
            column.clamp(0, self.width - 1)
        } else if column < 0 {
            column & 1
        } else if column < self.width {
            column
        } else {
            self.width - 2 + (column & 1)
        };
        ring.read(self.base, inside.unsigned_abs() as usize)
    }
}
