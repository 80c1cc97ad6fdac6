//! One word of the kernel with an inverted bit.

use halfrow_model::{Kernel, NODES, WEIGHT_NAMES};

use super::table_word::{Word, changed, inversions, reading};
use crate::diagnosis::hypothesis::Hypothesis;
use crate::diagnosis::witnesses::Witnesses;
use crate::result::Defect;
use crate::tables::Generation;

/// Bits of a word.
const BITS: u32 = 16;
/// Differing rows by which the nodes are found.
const ROWS: usize = 48;

/// Every bit of every weight of the nodes that all differing samples are interpolated from.
pub(super) fn propose<'a>(witnesses: &Witnesses<'a>) -> Vec<Hypothesis<'a>> {
    common_words(witnesses).into_iter().flat_map(|word| word.inverted(&witnesses.generations())).collect()
}

/// A word of the kernel.
#[derive(Clone, Copy, Debug)]
pub(super) struct KernelWord {
    /// Its node, 0 to 64.
    pub(super) node: usize,
    /// Its weight, an index of [`WEIGHT_NAMES`].
    pub(super) weight_index: usize,
}

/// The words that every differing sample depends on.
pub(super) fn common_words(witnesses: &Witnesses<'_>) -> Vec<KernelWord> {
    let weights = |node| (0..WEIGHT_NAMES.len()).map(move |weight_index| KernelWord { node, weight_index });
    common_nodes(witnesses).into_iter().flat_map(weights).collect()
}

/// The nodes k for which every differing sample lies between k − 1 and k or between k and k + 1.
fn common_nodes(witnesses: &Witnesses<'_>) -> Vec<usize> {
    let mut uses = [0_usize; NODES];
    let mut samples = 0;
    for witness in witnesses.differing.iter().take(ROWS) {
        let tables = witness.tables();
        for column in witness.differing_columns() {
            let node = tables.source(column).node;
            samples += 1;
            for count in uses.iter_mut().skip(node).take(2) {
                *count += 1;
            }
        }
    }
    let is_common = |node: &usize| samples > 0 && uses.get(*node) == Some(&samples);
    (0..NODES).filter(is_common).collect()
}

impl KernelWord {
    /// The word in a kernel, in units of 2^-14.
    pub(super) fn of(self, kernel: &Kernel) -> Option<i16> {
        kernel.nodes().get(self.node)?.get(self.weight_index).copied()
    }

    /// The kernel with this word replaced.
    pub(super) fn replaced(self, kernel: &Kernel, weight: i16) -> Option<Kernel> {
        let mut nodes = kernel.nodes().to_vec();
        *nodes.get_mut(self.node)?.get_mut(self.weight_index)? = weight;
        Kernel::from_nodes(nodes).ok()
    }

    /// The name of the weight.
    pub(super) fn weight(self) -> String {
        WEIGHT_NAMES.get(self.weight_index).copied().unwrap_or_default().to_owned()
    }

    /// The word with each of its bits broken.
    fn inverted<'a>(self, generations: &[&Generation]) -> Vec<Hypothesis<'a>> {
        let word = |uploaded: &&Generation| {
            Some((uploaded.number, self.of(&uploaded.kernel)?.cast_unsigned().into()))
        };
        let words: Vec<Word> = generations.iter().filter_map(word).collect();
        let signed = |word: u32| word as u16 as i16;
        let broken = |bit, read: &[Word]| {
            let reading = reading(&words, read, |word| signed(word).into());
            let defect = Defect::KernelWordBitWrong { node: self.node, weight: self.weight(), bit, reading };
            let kernels = super::kernels(generations, |uploaded| {
                self.replaced(&uploaded.kernel, signed(changed(read, uploaded)?))
            });
            super::with_kernels(defect, kernels)
        };
        let of_bit = |bit| inversions(&words, bit).iter().map(|read| broken(bit, read)).collect::<Vec<_>>();
        (0..BITS).flat_map(of_bit).collect()
    }
}
