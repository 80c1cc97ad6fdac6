//! How many faults a run finds.

use serde::{Deserialize, Serialize};

/// How many single faults of the board's Verilog a run like this one finds, measured one by one (fpga/checks/coverage.md).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct CoverageReport {
    /// Faults that the run finds.
    pub found: usize,
    /// Faults that were put in, without those proven to make no difference.
    pub faults: usize,
    /// Faults proven to make no difference.
    pub equivalent: usize,
}
