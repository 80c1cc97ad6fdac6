//! A line of a table's memory stuck, so that many entries are read wrong.

use halfrow_model::{Kernel, NODES, TAP_NAMES};

use super::StuckLine;
use super::row_factor::with_step;
use crate::diagnosis::Uploaded;
use crate::diagnosis::hypothesis::{Cause, Hypothesis, Prediction};
use crate::diagnosis::witnesses::Witnesses;

/// Bits of a row factor, of a weight, and of a node's number.
const FACTOR_BITS: u32 = 25;
const WEIGHT_BITS: u32 = 16;
const NODE_BITS: u32 = 7;

/// Every data and address line of both tables, and row tables that are read one entry too early or too late.
pub(super) fn propose<'a>(witnesses: &Witnesses<'a>) -> Vec<Hypothesis<'a>> {
    let Some(geometry) = witnesses.geometry() else { return Vec::new() };
    let row_bits = usize::BITS - (geometry.height() - 1).leading_zeros();
    let generations = witnesses.generations();
    let weights =
        (0..TAP_NAMES.len()).flat_map(|tap| StuckLine::all(WEIGHT_BITS).map(move |line| (tap, line)));
    StuckLine::all(FACTOR_BITS)
        .map(factor_data)
        .chain(StuckLine::all(row_bits).map(factor_address))
        .chain([-1, 1].map(neighbour))
        .chain(StuckLine::all(NODE_BITS).map(|line| node_address(&generations, line)))
        .chain(weights.map(|(tap, line)| weight_data(&generations, tap, line)))
        .collect()
}

fn factor_data<'a>(line: StuckLine) -> Hypothesis<'a> {
    let cause = Cause {
        part: "row table data",
        place: format!("row table, data bit {}, {}", line.bit, line.describe()),
        defect: format!("bit {} of every factor at {}", line.bit, u8::from(line.high)),
        next_step: format!("Check data line {} of the row table's memory.", line.bit),
    };
    Hypothesis::new(cause, move |witness| {
        let step = line.carry(witness.tables().step);
        (step != witness.tables().step).then(|| with_step(witness, step))
    })
}

fn factor_address<'a>(line: StuckLine) -> Hypothesis<'a> {
    let cause = Cause {
        part: "row table address",
        place: format!("row table, address bit {}, {}", line.bit, line.describe()),
        defect: format!("every row with another bit {} made with another row's factor", line.bit),
        next_step: format!("Check address line {} of the row table's memory.", line.bit),
    };
    from_other_entry(cause, move |row| Some(line.carry(row as u32) as usize))
}

fn neighbour<'a>(distance: isize) -> Hypothesis<'a> {
    let (side, way) = if distance < 0 { ("before", "behind") } else { ("after", "ahead") };
    let cause = Cause {
        part: "row table address",
        place: format!("the row table's address, one entry {way}"),
        defect: format!("every row made with the factor of the row {side} it"),
        next_step: "Check when the row counter that addresses the row table moves on.".to_owned(),
    };
    from_other_entry(cause, move |row| row.checked_add_signed(distance))
}

/// Rows made with the entry of another row. What lies beyond the table is not known.
fn from_other_entry<'a>(cause: Cause, entry: impl Fn(usize) -> Option<usize> + 'a) -> Hypothesis<'a> {
    Hypothesis::new(cause, move |witness| {
        let other = entry(witness.row);
        if other == Some(witness.row) {
            return None;
        }
        let step = other.and_then(|row| witness.uploaded.tables.step(row));
        Some(step.map_or_else(Prediction::unknown, |step| with_step(witness, step)))
    })
}

fn node_address<'a>(generations: &[Uploaded<'_>], line: StuckLine) -> Hypothesis<'a> {
    let cause = Cause {
        part: "kernel address",
        place: format!("kernel memory, address bit {}, {}", line.bit, line.describe()),
        defect: format!("every node with another bit {} read as another node", line.bit),
        next_step: format!("Check address line {} of the kernel's memory.", line.bit),
    };
    with_nodes(generations, cause, |nodes| {
        let read = |node: usize| nodes.get(line.carry(node as u32) as usize).copied().unwrap_or_default();
        (0..NODES).map(read).collect()
    })
}

fn weight_data<'a>(generations: &[Uploaded<'_>], tap: usize, line: StuckLine) -> Hypothesis<'a> {
    let weight = TAP_NAMES.get(tap).copied().unwrap_or_default();
    let cause = Cause {
        part: "kernel data",
        place: format!("kernel memory, weight {weight}, data bit {}, {}", line.bit, line.describe()),
        defect: format!("bit {} of {weight} at {} in every node", line.bit, u8::from(line.high)),
        next_step: format!("Check data line {} of the memory that holds weight {weight}.", line.bit),
    };
    with_nodes(generations, cause, |nodes| {
        let mut nodes = nodes.to_vec();
        for weight in nodes.iter_mut().filter_map(|node| node.get_mut(tap)) {
            *weight = line.carry(u32::from(weight.cast_unsigned())) as u16 as i16;
        }
        nodes
    })
}

/// All rows made with other nodes.
fn with_nodes<'a>(
    generations: &[Uploaded<'_>],
    cause: Cause,
    read: impl Fn(&[[i16; 5]; NODES]) -> Vec<[i16; 5]>,
) -> Hypothesis<'a> {
    let kernels = super::kernels(generations, |uploaded| {
        let kernel = Kernel::from_nodes(read(uploaded.kernel.nodes())).ok()?;
        (kernel != *uploaded.kernel).then_some(kernel)
    });
    super::with_kernels(cause, kernels)
}
