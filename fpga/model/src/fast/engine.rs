//! All paths behind one interface.

use super::ModelPath;
use super::content::hold;
use super::located::Located;
use super::nodes::Nodes;
use super::padded::{Ends, Outputs, Padded};
use super::scalar;
use super::walk::{Curve, Line, Walk};
#[cfg(target_arch = "x86_64")]
use super::x86;
use crate::corrector::{correct_row, correct_row_of_values};
use crate::frame::bits_of;
use crate::grid::Grid;
use crate::{Geometry, Kernel, RowFactor, RowValues};

/// Rows whose outputs come from the same columns, to be corrected together.
pub(super) struct Rows<'a, W, const ROWS: usize> {
    pub(super) walk: W,
    pub(super) width: usize,
    pub(super) max: u16,
    pub(super) inputs: [Padded<'a>; ROWS],
    pub(super) outputs: [Outputs<'a>; ROWS],
}

/// What a path keeps of a kernel.
pub(super) enum Engine {
    Reference(Box<Kernel>),
    Scalar(scalar::Weights),
    #[cfg(target_arch = "x86_64")]
    Avx2(x86::Avx2, Box<x86::Planes>),
    #[cfg(target_arch = "x86_64")]
    Avx512(x86::Avx512, Box<Nodes>),
}

impl Engine {
    pub(super) fn new(path: ModelPath, kernel: &Kernel) -> Option<Self> {
        match path {
            ModelPath::Reference => Some(Self::Reference(Box::new(kernel.clone()))),
            ModelPath::Scalar => Some(Self::Scalar(scalar::Weights::new(&Nodes::new(kernel)))),
            #[cfg(target_arch = "x86_64")]
            ModelPath::Avx2 => x86::Avx2::detect()
                .map(|avx2| Self::Avx2(avx2, Box::new(x86::Planes::new(&Nodes::new(kernel))))),
            #[cfg(target_arch = "x86_64")]
            ModelPath::Avx512 => {
                x86::Avx512::detect().map(|avx512| Self::Avx512(avx512, Box::new(Nodes::new(kernel))))
            }
            #[cfg(not(target_arch = "x86_64"))]
            ModelPath::Avx2 | ModelPath::Avx512 => None,
        }
    }

    /// Corrects rows that share the row factor `row_factor`; `ends` is scratch space for their ends.
    pub(super) fn correct_rows<const ROWS: usize>(
        &self,
        ends: &mut [Ends; 2],
        geometry: &Geometry,
        row_factor: RowFactor,
        rows: [&[u16]; ROWS],
        outputs: [&mut [u16]; ROWS],
    ) {
        if let Self::Reference(kernel) = self {
            for (row, output) in rows.into_iter().zip(outputs) {
                correct_row(geometry, row_factor, kernel, row, output);
            }
            return;
        }
        self.correct_along(Line::new(geometry, row_factor), ends, geometry, rows, outputs);
    }

    /// Corrects row `index` of `grid`; `ends` and `values` are scratch space for its ends and its values.
    pub(super) fn correct_row_of_grid(
        &self,
        (ends, values): (&mut [Ends; 2], &mut RowValues),
        geometry: &Geometry,
        (grid, index): (&Grid, usize),
        row: &[u16],
        output: &mut [u16],
    ) {
        if let Self::Reference(kernel) = self {
            grid.values(geometry.centre2(), index, values);
            correct_row_of_values(geometry, values, kernel, row, output);
            return;
        }
        let nodes = values.nodes_mut();
        grid.nodes(geometry.centre2(), index, nodes);
        self.correct_along(Curve::new(nodes), ends, geometry, [row], [output]);
    }

    fn correct_along<W: Walk, const ROWS: usize>(
        &self,
        walk: W,
        ends: &mut [Ends; 2],
        geometry: &Geometry,
        rows: [&[u16]; ROWS],
        outputs: [&mut [u16]; ROWS],
    ) {
        let width = geometry.width();
        let rows = rows.map(|row| &row[..width]);
        rows.iter().zip(&mut *ends).for_each(|(row, ends)| ends.take(row));
        let inputs = std::array::from_fn(|row| Padded::new(rows[row], &ends[row]));
        let outputs = outputs.map(|output| Outputs::new(&mut output[..width]));
        self.correct(Rows { walk, width, max: geometry.depth().max(), inputs, outputs });
    }

    /// Corrects padded rows. The oracle uses none.
    fn correct<W: Walk, const ROWS: usize>(&self, rows: Rows<'_, W, ROWS>) {
        match self {
            Self::Reference(_) => {}
            Self::Scalar(weights) => scalar::correct(weights, rows),
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(avx2, planes) => avx2.correct(planes, rows),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512(avx512, nodes) => avx512.correct(nodes, rows),
        }
    }

    /// Whether samples that no depth can hold spoil nothing but the outputs, as with vectors, whose lanes wrap. Such an
    /// engine's rows are checked after their correction, which has brought them into the cache.
    pub(super) fn takes_any_sample(&self) -> bool {
        !matches!(self, Self::Reference(_) | Self::Scalar(_))
    }

    /// The bits that are set in any of `samples`; they tell whether a depth can hold all samples.
    pub(super) fn bits_of(&self, samples: &[u16]) -> u16 {
        match self {
            Self::Reference(_) | Self::Scalar(_) => bits_of(samples),
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(avx2, _) => avx2.bits_of(samples),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512(avx512, _) => avx512.bits_of(samples),
        }
    }

    /// [`hold`], which only AVX-512 does faster.
    pub(super) fn hold(&self, draws: &[u16], max: u16, samples: &mut [u16]) {
        match self {
            #[cfg(target_arch = "x86_64")]
            Self::Avx512(avx512, _) => avx512.hold(draws, max, samples),
            _ => hold(draws, max, samples),
        }
    }

    /// The sources of the next block of columns; the oracle finds its own.
    pub(super) fn locate(&self, walk: &mut impl Walk) -> Located {
        match self {
            Self::Reference(_) | Self::Scalar(_) => scalar::locate_block(walk),
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(avx2, _) => avx2.locate(walk),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512(avx512, _) => avx512.locate(walk),
        }
    }
}
