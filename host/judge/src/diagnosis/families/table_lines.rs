//! A stuck line in a table's memory, so that many entries are read wrong.

use halfrow_model::{Kernel, NODES, RowFactor, WEIGHT_NAMES};

use super::StuckLine;
use super::row_factor::with_entry;
use crate::diagnosis::address_bits;
use crate::diagnosis::hypothesis::{Hypothesis, Prediction};
use crate::diagnosis::witnesses::Witnesses;
use crate::result::Defect;
use crate::tables::Generation;

/// Bits of a weight, and of a node's number.
const WEIGHT_BITS: u32 = 16;
const NODE_BITS: u32 = 7;

/// Every data and address line of both tables, and entries read one too early or too late.
pub(super) fn propose<'a>(witnesses: &Witnesses<'a>) -> Vec<Hypothesis<'a>> {
    let Some(geometry) = witnesses.geometry() else { return Vec::new() };
    let ring = witnesses.case.ring;
    let generations = witnesses.generations();
    let weights =
        (0..WEIGHT_NAMES.len()).flat_map(|tap| StuckLine::all(WEIGHT_BITS).map(move |line| (tap, line)));
    StuckLine::all(RowFactor::BITS)
        .map(move |line| factor_data(line, ring))
        .chain(StuckLine::all(address_bits(geometry.height())).map(move |line| factor_address(line, ring)))
        .chain([-1, 1].map(|distance| neighbour(distance, ring)))
        .chain(StuckLine::all(NODE_BITS).map(|line| node_address(&generations, line)))
        .chain([-1, 1].map(|distance| node_neighbour(&generations, distance)))
        .chain(weights.map(|(tap, line)| weight_data(&generations, tap, line)))
        .collect()
}

fn factor_data<'a>(line: StuckLine, ring: usize) -> Hypothesis<'a> {
    let defect = Defect::RowTableDataStuck { bit: line.bit, value: line.value() };
    Hypothesis::new(defect, move |witness| {
        let uploaded = witness.uploaded.tables.row_factor(witness.row)?.get();
        let entry = line.carry(uploaded);
        (entry != uploaded).then(|| with_entry(witness, entry, ring))
    })
}

fn factor_address<'a>(line: StuckLine, ring: usize) -> Hypothesis<'a> {
    let defect = Defect::RowTableAddressStuck { bit: line.bit, value: line.value() };
    from_other_entry(defect, ring, move |row| Some(line.carry(row as u32) as usize))
}

fn neighbour<'a>(distance: isize, ring: usize) -> Hypothesis<'a> {
    let defect = Defect::RowTableAddressOff { entries: distance };
    from_other_entry(defect, ring, move |row| row.checked_add_signed(distance))
}

/// Rows made with the entry of another row. What lies beyond the table is not known.
fn from_other_entry<'a>(
    defect: Defect,
    ring: usize,
    entry: impl Fn(usize) -> Option<usize> + 'a,
) -> Hypothesis<'a> {
    Hypothesis::new(defect, move |witness| {
        let factors = witness.uploaded.tables.row_factors()?;
        let other = entry(witness.row);
        if other == Some(witness.row) {
            return None;
        }
        let read = other.and_then(|row| factors.get(row));
        Some(read.map_or_else(Prediction::unknown, |read| with_entry(witness, read.get(), ring)))
    })
}

fn node_address<'a>(generations: &[&Generation], line: StuckLine) -> Hypothesis<'a> {
    let defect = Defect::KernelAddressStuck { bit: line.bit, value: line.value() };
    with_nodes(generations, defect, |nodes| {
        let read = |node: usize| nodes.get(line.carry(node as u32) as usize).copied().unwrap_or_default();
        (0..NODES).map(read).collect()
    })
}

/// Weights interpolated between nodes beside the right ones. Beyond the kernel's end its last node stands in.
fn node_neighbour<'a>(generations: &[&Generation], distance: isize) -> Hypothesis<'a> {
    with_nodes(generations, Defect::KernelAddressOff { nodes: distance }, |nodes| {
        let read = |node: usize| nodes[node.saturating_add_signed(distance).min(NODES - 1)];
        (0..NODES).map(read).collect()
    })
}

fn weight_data<'a>(generations: &[&Generation], tap: usize, line: StuckLine) -> Hypothesis<'a> {
    let weight = WEIGHT_NAMES.get(tap).copied().unwrap_or_default();
    let defect = Defect::KernelDataStuck { weight: weight.to_owned(), bit: line.bit, value: line.value() };
    with_nodes(generations, defect, |nodes| {
        let mut nodes = nodes.to_vec();
        for weight in nodes.iter_mut().filter_map(|node| node.get_mut(tap)) {
            *weight = line.carry(u32::from(weight.cast_unsigned())) as u16 as i16;
        }
        nodes
    })
}

/// All rows made with the nodes that `read` makes of the uploaded ones.
fn with_nodes<'a>(
    generations: &[&Generation],
    defect: Defect,
    read: impl Fn(&[[i16; 5]; NODES]) -> Vec<[i16; 5]>,
) -> Hypothesis<'a> {
    let kernels = super::kernels(generations, |uploaded| {
        let kernel = Kernel::from_nodes(read(uploaded.kernel.nodes())).ok()?;
        (kernel != uploaded.kernel).then_some(kernel)
    });
    super::with_kernels(defect, kernels)
}
