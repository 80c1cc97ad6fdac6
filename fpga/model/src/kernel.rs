//! The kernel: an interpolant as a board stores it, 65 nodes of five weights (DATAPATH.md, "Kernel").

use crate::Interpolant;

/// Nodes of a kernel: x = 0, 1/32, …, 2. The last one closes the 64th interval.
pub const NODES: usize = 65;

/// The weight 1: weights have 14 fractional bits.
pub const WEIGHT_ONE: i32 = 1 << 14;

/// The least weight that 16 bits hold.
const MIN_WEIGHT: f64 = -2.0;

/// The largest weight that 16 bits hold: 2 − 2^-14.
const MAX_WEIGHT: f64 = i16::MAX as f64 / WEIGHT_ONE as f64;

/// The taps, the samples that an output is made of, in the order of their columns.
pub const TAP_NAMES: [&str; 7] = ["G0", "R1", "G2", "R3", "G4", "R5", "G6"];

/// The stored weights, in their order. Those of the taps G2 and R3 follow from these five.
pub const WEIGHT_NAMES: [&str; 5] = ["g0", "r1", "g4", "r5", "g6"];

/// The weights of a kernel at its [`NODES`] nodes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Kernel {
    nodes: [[i16; 5]; NODES],
}

/// How many samples a kernel reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Taps {
    /// R1 to R5: every node has g0 = g6 = 0.
    Five,
    /// G0 to G6.
    Seven,
}

/// The weights do not make a kernel.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum KernelError {
    /// Not [`NODES`] nodes.
    #[error("{0} nodes; a kernel has {count}, at x = 0, 1/32, …, 2", count = NODES)]
    Count(usize),
    /// A weight outside −2 to 2 − 2^-14.
    #[error(
        "the weight {tap} of node {node} is {weight}, outside {min} to {max}; \
         check the interpolant: only g2 and r3, which are not stored, may be larger",
        min = MIN_WEIGHT,
        max = MAX_WEIGHT
    )]
    Weight {
        /// The node, 0 to 64.
        node: usize,
        /// The weight's name, one of [`WEIGHT_NAMES`].
        tap: &'static str,
        /// The weight given.
        weight: f64,
    },
}

impl Kernel {
    /// The kernel with `nodes`, each g0 r1 g4 r5 g6 in units of 2^-14.
    ///
    /// # Errors
    /// [`KernelError::Count`] when there are not exactly [`NODES`] nodes.
    pub fn from_nodes(nodes: Vec<[i16; 5]>) -> Result<Self, KernelError> {
        let nodes = nodes.try_into().map_err(|nodes: Vec<_>| KernelError::Count(nodes.len()))?;
        Ok(Self { nodes })
    }

    /// The kernel of real weights, each node g0 r1 g4 r5 g6, rounded half up to 14 fractional bits.
    ///
    /// # Errors
    /// [`KernelError`] when there are not exactly [`NODES`] nodes, or a weight is outside −2 to 2 − 2^-14 or not a number.
    /// Nothing is saturated.
    pub fn from_weights(weights: &[[f64; 5]]) -> Result<Self, KernelError> {
        let nodes: Result<_, _> =
            weights.iter().enumerate().map(|(node, weights)| round_node(node, weights)).collect();
        Self::from_nodes(nodes?)
    }

    /// All nodes from x = 0, each g0 r1 g4 r5 g6 in units of 2^-14.
    #[must_use]
    pub fn nodes(&self) -> &[[i16; 5]; NODES] {
        &self.nodes
    }

    /// The taps that a board needs for this kernel.
    #[must_use]
    pub fn taps(&self) -> Taps {
        let five = self.nodes.iter().all(|&[g0, .., g6]| g0 == 0 && g6 == 0);
        if five { Taps::Five } else { Taps::Seven }
    }

    /// The kernel in a board's format: node after node, each weight as 16 bits, little endian; 650 bytes.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        self.nodes.iter().flatten().flat_map(|weight| weight.to_le_bytes()).collect()
    }

    /// The five weights `fraction` / 256 of the way from `node`, 0 to 63, to the next one.
    pub(crate) fn weights_at(&self, node: usize, fraction: i32) -> [i32; 5] {
        let (low, high) = (&self.nodes[node], &self.nodes[node + 1]);
        std::array::from_fn(|tap| {
            let (low, high) = (i32::from(low[tap]), i32::from(high[tap]));
            low + (((high - low) * fraction + 128) >> 8)
        })
    }
}

impl From<Interpolant> for Kernel {
    /// The interpolant's weights at the nodes. All of them lie within −1 to 1.
    fn from(interpolant: Interpolant) -> Self {
        let node = |node: usize| {
            let [g0, r1, _, _, g4, r5, g6] = interpolant.weights(node as f64 / 32.0);
            [g0, r1, g4, r5, g6].map(round_weight)
        };
        Self { nodes: std::array::from_fn(node) }
    }
}

fn round_node(node: usize, weights: &[f64; 5]) -> Result<[i16; 5], KernelError> {
    for (tap, weight) in WEIGHT_NAMES.into_iter().zip(*weights) {
        if !(MIN_WEIGHT..=MAX_WEIGHT).contains(&weight) {
            return Err(KernelError::Weight { node, tap, weight });
        }
    }
    Ok(weights.map(round_weight))
}

/// A legal weight with 14 fractional bits, rounded half up.
fn round_weight(weight: f64) -> i16 {
    (weight * f64::from(WEIGHT_ONE) + 0.5).floor() as i16
}
