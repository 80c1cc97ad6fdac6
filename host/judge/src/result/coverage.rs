//! What a PASS is worth.

use serde::{Deserialize, Serialize};

/// How many single faults of the board's Verilog a run like this one finds, measured one by one (fpga/checks/coverage.md).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct CoverageReport {
    /// Faults that it finds.
    pub found: usize,
    /// Faults that were put in, without those that are proven to make no difference.
    pub faults: usize,
    /// Faults that are proven to make no difference.
    pub equivalent: usize,
}
