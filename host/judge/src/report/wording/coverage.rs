//! Words for the faults that a run finds.

use crate::result::{BoardKind, CoverageReport, Report};
use crate::verdict::Verdict;
use crate::words::grouped;

/// The share of the Verilog's faults that a PASS rules out, without a full stop. None for a mock, which is not made of the
/// Verilog, and for a soak or a run within a time.
#[must_use]
pub fn coverage(report: &Report) -> Option<String> {
    let is_told = report.verdict() == Verdict::Pass && report.within.is_none() && report.soak.is_none();
    if !is_told || report.board.kind == BoardKind::Mock {
        return None;
    }
    let Some(CoverageReport { found, faults, .. }) = report.coverage else {
        return Some("of this plan and build was not measured".to_owned());
    };
    // Rounded down, so as never to claim more than was measured.
    let share = (1000 * found / faults.max(1)) as f64 / 10.0;
    Some(format!("finds {share:.1} % of {} single faults of the Verilog at this geometry", grouped(faults)))
}
