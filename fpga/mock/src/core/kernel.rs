//! The interpolation kernel as the tables store it: nodes of five words.

/// Nodes of a kernel, at x = 0, 1/32, … 2 columns.
pub const NODES: usize = 65;

/// Weights that a node stores.
const NODE_WEIGHTS: usize = 5;

/// The weights that a node stores. Those of G2 and R3 follow from them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weight {
    /// Two columns left of the base, the output's own colour.
    G0,
    /// One column left of the base, the row's other colour.
    R1,
    /// Two columns right of the base, the output's own colour.
    G4,
    /// Three columns right of the base, the row's other colour.
    R5,
    /// Four columns right of the base, the output's own colour.
    G6,
}

impl Weight {
    /// All of them, in the order of [`Node`]'s fields.
    pub(crate) const ALL: [Self; NODE_WEIGHTS] = [Self::G0, Self::R1, Self::G4, Self::R5, Self::G6];

    /// Their names, in the same order.
    pub(crate) const NAMES: [&str; NODE_WEIGHTS] = ["g0", "r1", "g4", "r5", "g6"];

    pub(crate) fn name(self) -> &'static str {
        Self::NAMES[self as usize]
    }
}

/// The stored weights at one kernel position, signed, in units of 2^-14.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Node {
    /// Weight of [`Weight::G0`]; 0 in a five-tap kernel.
    pub g0: i16,
    /// Weight of [`Weight::R1`].
    pub r1: i16,
    /// Weight of [`Weight::G4`].
    pub g4: i16,
    /// Weight of [`Weight::R5`].
    pub r5: i16,
    /// Weight of [`Weight::G6`]; 0 in a five-tap kernel.
    pub g6: i16,
}

impl From<[i16; NODE_WEIGHTS]> for Node {
    /// The node with these words, in the order of [`Node`]'s fields.
    fn from([g0, r1, g4, r5, g6]: [i16; NODE_WEIGHTS]) -> Self {
        Self { g0, r1, g4, r5, g6 }
    }
}

impl Node {
    /// Whether the node needs the outer taps, which a five-tap build lacks.
    #[must_use]
    pub(crate) fn needs_outer_taps(&self) -> bool {
        self.g0 != 0 || self.g6 != 0
    }

    /// The stored words, in the order of [`Node`]'s fields.
    #[must_use]
    pub fn words(&self) -> [i16; NODE_WEIGHTS] {
        let &Self { g0, r1, g4, r5, g6 } = self;
        [g0, r1, g4, r5, g6]
    }

    /// The stored word of one weight.
    pub(crate) fn word_mut(&mut self, weight: Weight) -> &mut i16 {
        match weight {
            Weight::G0 => &mut self.g0,
            Weight::R1 => &mut self.r1,
            Weight::G4 => &mut self.g4,
            Weight::R5 => &mut self.r5,
            Weight::G6 => &mut self.g6,
        }
    }
}

/// A whole kernel (Eqs. 10, 11, 12 and 18 at 65 positions).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Kernel {
    /// The nodes, from x = 0 to x = 2 columns.
    pub nodes: [Node; NODES],
}

impl Default for Kernel {
    /// The kernel of a board that was just switched on: all words are zero, so that each output is its base sample.
    fn default() -> Self {
        Self { nodes: [Node::default(); NODES] }
    }
}
