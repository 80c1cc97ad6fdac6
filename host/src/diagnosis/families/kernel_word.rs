//! One word of the kernel with a bit inverted.

use halfrow_model::{Kernel, NODES, TAP_NAMES, source};

use super::table_word::{inversions, reading};
use crate::diagnosis::hypothesis::{Cause, Hypothesis};
use crate::diagnosis::witnesses::Witnesses;

/// Bits of a word.
const BITS: u32 = 16;
/// Differing rows that must point at the node.
const ROWS: usize = 48;

/// Every bit of every weight of the nodes that all differing samples interpolate with.
pub(super) fn propose<'a>(witnesses: &Witnesses<'a>) -> Vec<Hypothesis<'a>> {
    common_nodes(witnesses)
        .into_iter()
        .flat_map(|node| (0..TAP_NAMES.len()).map(move |tap| (node, tap)))
        .flat_map(|(node, tap)| word(witnesses, node, tap))
        .collect()
}

/// The nodes k for which every differing sample lies between k − 1 and k or between k and k + 1.
pub(super) fn common_nodes(witnesses: &Witnesses<'_>) -> Vec<usize> {
    let mut uses = [0_usize; NODES];
    let mut samples = 0;
    for witness in witnesses.differing.iter().take(ROWS) {
        let tables = witness.tables();
        for column in witness.differing_columns() {
            let node = source(tables.geometry, tables.step, column).node;
            samples += 1;
            for count in uses.iter_mut().skip(node).take(2) {
                *count += 1;
            }
        }
    }
    let is_common = |node: &usize| samples > 0 && uses.get(*node) == Some(&samples);
    (0..NODES).filter(is_common).collect()
}

fn word<'a>(witnesses: &Witnesses<'a>, node: usize, tap: usize) -> Vec<Hypothesis<'a>> {
    let generations = witnesses.generations();
    let words: Vec<_> = generations
        .iter()
        .filter_map(|uploaded| {
            let weight = *uploaded.kernel.nodes().get(node)?.get(tap)?;
            Some((uploaded.generation, u32::from(weight.cast_unsigned())))
        })
        .collect();
    let bits = (0..BITS).flat_map(|bit| inversions(&words, bit).into_iter().map(move |read| (bit, read)));
    bits.map(|(bit, read)| {
        let defect = reading(&words, &read, |word| i64::from(word as u16 as i16));
        let cause = cause(node, tap, &format!(", bit {bit}"), defect);
        let kernels = super::kernels(&generations, |uploaded| {
            let weight = super::table_word::changed(&read, uploaded)?;
            with_word(uploaded.kernel, node, tap, weight as u16 as i16)
        });
        super::with_kernels(cause, kernels)
    })
    .collect()
}

/// A word as a suspect; `bit` names the bit, if it is one.
pub(super) fn cause(node: usize, tap: usize, bit: &str, defect: String) -> Cause {
    let weight = TAP_NAMES.get(tap).copied().unwrap_or_default();
    Cause {
        part: "kernel word",
        place: format!("kernel node {node}, weight {weight}{bit}"),
        defect,
        next_step: format!(
            "Check node {node} of the kernel as the datapath reads it, and the memory that holds weight {weight}."
        ),
    }
}

/// The kernel with another weight at one place.
pub(super) fn with_word(kernel: &Kernel, node: usize, tap: usize, weight: i16) -> Option<Kernel> {
    let mut nodes = kernel.nodes().to_vec();
    *nodes.get_mut(node)?.get_mut(tap)? = weight;
    Kernel::from_nodes(nodes).ok()
}
