//! The grid with the least largest error: weighted least squares, starting from the closed form, in which the weights of large
//! errors grow from round to round (Lawson's algorithm).

use std::collections::BTreeSet;

use super::closed_form::Spline;
use super::lattice::{Lattice, Part};
use super::normal::Normal;
use super::rows::fractions;
use crate::{Camera, GridShape, TableSet};

/// How often the weights are adapted to the errors.
const ROUNDS: usize = 16;

/// The weight of outputs next to the rim or to a pole. It does not grow, since no grid can follow the projection there.
const RIM: f64 = 0.01;

/// Keeps coefficients that no output depends on at the closed form's values.
const DAMPING: f64 = 1e-6;

/// The least weight of an inner output. Without it, an output without error would get the weight 0 and never count again.
const LEAST: f64 = 3e-3;

/// The weight that holds a node at a factor of 1 where its factor would be clamped, since clamping shifts the rest of the row.
const HELD: f64 = 30.0;

/// A fit of one shape to the outputs of a lattice.
struct Fit<'a> {
    lattice: &'a Lattice,
    shape: GridShape,
    spline: Spline,
    weights: Vec<f64>,
    /// Nodes that are held at 1, each with its row of the lattice.
    held: BTreeSet<(usize, usize)>,
}

impl Fit<'_> {
    /// The coefficients that make the output at `column` of `row`, in rising order, and their weights.
    fn terms(&self, column: usize, row: usize) -> [(usize, f64); 9] {
        let pitch = self.shape.column_pitch();
        let (segment, u) = (column / pitch, (column % pitch) as f64 / pitch as f64);
        let (left, right) = ((1.0 - u).powi(2) / 2.0, u.powi(2) / 2.0);
        let across = [left, 1.0 - left - right, right];
        let (first, down) = fractions(self.shape, row);
        std::array::from_fn(|term| {
            let (c, b) = (term / 3, term % 3);
            ((segment + c) * self.spline.rows + first + b, across[c] * down[b])
        })
    }

    /// The error of every output, wanted − found, in columns and in the lattice's order.
    fn misses(&self) -> Vec<f64> {
        let found = |(column, row)| -> f64 {
            let terms = self.terms(column, row);
            terms.iter().map(|&(place, weight)| weight * self.spline.coefficients[place]).sum()
        };
        let places = self.places().map(found);
        places.zip(&self.lattice.wanted).map(|(found, (wanted, _))| wanted - found).collect()
    }

    /// Column and row of every output.
    fn places(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        let columns = &self.lattice.columns;
        self.lattice.rows.iter().flat_map(move |&row| columns.iter().map(move |&column| (column, row)))
    }

    /// Fits the spline to the outputs, by least squares with their weights.
    fn solve(&mut self) {
        let misses = self.misses();
        let mut normal = Normal::new(self.spline.coefficients.len(), 2 * self.spline.rows + 2, DAMPING);
        for ((place, miss), &weight) in self.places().zip(&misses).zip(&self.weights) {
            if weight > 0.0 {
                normal.add(&self.terms(place.0, place.1), *miss, weight);
            }
        }
        self.hold(&mut normal);
        for (coefficient, correction) in self.spline.coefficients.iter_mut().zip(normal.solved()) {
            *coefficient += correction;
        }
    }

    /// Adds to `normal` that every node whose factor is above 1, or was in an earlier round, shall have 1.
    fn hold(&mut self, normal: &mut Normal) {
        let pitch = self.shape.column_pitch() as f64;
        let nodes = 0..self.spline.coefficients.len() / self.spline.rows - 1;
        for &row in &self.lattice.rows {
            for node in nodes.clone() {
                let terms = self.step_terms(node, row);
                let step: f64 =
                    terms.iter().map(|&(place, weight)| weight * self.spline.coefficients[place]).sum();
                if step > pitch {
                    self.held.insert((node, row));
                }
                if self.held.contains(&(node, row)) {
                    normal.add(&terms, pitch - step, HELD);
                }
            }
        }
    }

    /// The coefficients that make h times the factor of `node` on `row`, in rising order, and their weights.
    fn step_terms(&self, node: usize, row: usize) -> [(usize, f64); 6] {
        let (first, down) = fractions(self.shape, row);
        std::array::from_fn(|term| {
            let (c, b) = (term / 3, term % 3);
            ((node + c) * self.spline.rows + first + b, if c == 0 { -down[b] } else { down[b] })
        })
    }

    /// Multiplies the weight of each inner output by its error, relative to the largest error.
    fn weigh(&mut self) {
        let misses = self.misses();
        let inner = || misses.iter().zip(&self.lattice.wanted).filter(|(_, (_, part))| *part == Part::Inner);
        let largest = inner().map(|(miss, _)| miss.abs()).fold(0.0, f64::max);
        let parts = self.lattice.wanted.iter().map(|(_, part)| *part);
        for ((weight, miss), part) in self.weights.iter_mut().zip(&misses).zip(parts) {
            if part == Part::Inner && largest > 0.0 {
                *weight *= miss.abs() / largest;
            }
        }
        self.scale();
    }

    /// Scales the weights of inner outputs to a mean of one.
    fn scale(&mut self) {
        let parts = || self.lattice.wanted.iter().map(|(_, part)| *part == Part::Inner);
        let inner = self.weights.iter().zip(parts()).filter(|(_, inner)| *inner);
        let (count, sum) = inner.fold((0.0, 0.0), |(count, sum), (weight, _)| (count + 1.0, sum + weight));
        let scale = if sum > 0.0 { count / sum } else { 1.0 };
        for (weight, _) in self.weights.iter_mut().zip(parts()).filter(|(_, inner)| *inner) {
            *weight = (*weight * scale).max(LEAST);
        }
    }
}

/// The table of shape `shape` that takes the outputs of `lattice` from nearest to the right places: out of the closed form and
/// every round's fit, as integers, the one with the least largest error in the inner part that a ring of `ring` samples, if one is
/// given, can serve, and that error.
pub(super) fn fitted(
    camera: &Camera,
    shape: GridShape,
    lattice: &Lattice,
    ring: Option<usize>,
) -> (f64, TableSet) {
    let closed = Spline::of_camera(camera, shape);
    let table = closed.table(camera);
    let weight = |&(_, part): &(f64, Part)| match part {
        Part::Outside => 0.0,
        Part::Rim => RIM,
        Part::Inner => 1.0,
    };
    let weights = lattice.wanted.iter().map(weight).collect();
    let mut fit = Fit { lattice, shape, spline: closed, weights, held: BTreeSet::new() };
    let mut best = (lattice.error(&table, ring), table);
    for _ in 0..ROUNDS {
        fit.solve();
        let table = fit.spline.fitted_table(camera);
        let found = lattice.error(&table, ring);
        if found < best.0 {
            best = (found, table);
        }
        fit.weigh();
    }
    best
}
