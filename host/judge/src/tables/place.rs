//! The places in a table file that an error can name.

use std::fmt;

/// A place in a table or kernel file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// `datapath`: the datapath's id.
    Datapath,
    /// `about`: the user's own notes.
    About,
    /// `width`: W.
    Width,
    /// `height`: H.
    Height,
    /// `bits`: B.
    Bits,
    /// `centre2`: C.
    Centre2,
    /// `step`: the list of all row factors.
    RowFactors,
    /// The row factor of one row.
    RowFactor {
        /// The row, from 0 at the top.
        row: usize,
    },
    /// `v`: the binary logarithm of the rows between grid rows.
    V,
    /// `k`: the binary logarithm of the columns between nodes.
    K,
    /// `grid`: the list of all its entries, column by column.
    Grid,
    /// One entry of the grid.
    GridEntry {
        /// Its index in the list, from 0.
        entry: usize,
    },
    /// `kernel`: the list of all nodes.
    Kernel,
    /// The weights of one node.
    Node {
        /// The node, 0 to 64.
        node: usize,
    },
    /// One weight of one node.
    Weight {
        /// The node, 0 to 64.
        node: usize,
        /// The weight's name, one of [`halfrow_model::WEIGHT_NAMES`].
        weight: &'static str,
    },
}

impl Place {
    /// The key of the file under which the place lies.
    #[must_use]
    pub fn key(self) -> &'static str {
        match self {
            Self::Datapath => "datapath",
            Self::About => "about",
            Self::Width => "width",
            Self::Height => "height",
            Self::Bits => "bits",
            Self::Centre2 => "centre2",
            Self::RowFactors | Self::RowFactor { .. } => "step",
            Self::V => "v",
            Self::K => "k",
            Self::Grid | Self::GridEntry { .. } => "grid",
            Self::Kernel | Self::Node { .. } | Self::Weight { .. } => "kernel",
        }
    }

    /// An instruction that says what belongs there.
    pub(super) fn remedy(self) -> &'static str {
        match self {
            Self::Datapath => "give the id of the datapath that the tables are for",
            Self::About => "put your notes between { and }",
            Self::Width => "give the frame's columns, an even number",
            Self::Height => "give the frame's rows",
            Self::Bits => "give 8, 10 or 12 bits a sample",
            Self::Centre2 => "give twice the column of the optical centre, counted from 0",
            Self::RowFactors => "give one row factor for each row, from the top",
            Self::RowFactor { .. } => {
                "a row factor is 2^24 / k, rounded, with a stretch factor k of at least 1"
            }
            Self::V => "2^v rows lie between two grid rows; give 1 to 6",
            Self::K => "2^k columns lie between two nodes; give 5 or 6",
            Self::Grid => "give the entries column by column: the offsets first, then a column for each node",
            Self::GridEntry { .. } => {
                "an entry of a grid has 25 bits; make the tables again with `halfrow tables`"
            }
            Self::Kernel => "give one node for each x = 0, 1/32, ..., 2",
            Self::Node { .. } => "give the five weights g0, r1, g4, r5, g6",
            Self::Weight { .. } => {
                "weights count in 2^-14: 16384 is 1.0, and 2.0 (32768) cannot be held; check the interpolant"
            }
        }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::RowFactor { row } => write!(f, "the row factor of row {row}"),
            Self::GridEntry { entry } => write!(f, "entry {entry} of `grid`"),
            Self::Node { node } => write!(f, "node {node} of `kernel`"),
            Self::Weight { node, weight } => write!(f, "the weight {weight} of node {node}"),
            whole => write!(f, "`{}`", whole.key()),
        }
    }
}
