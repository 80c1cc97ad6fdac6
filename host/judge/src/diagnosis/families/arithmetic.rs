//! Missing rounding and clamping, and numbers taken as others.

use super::taps::wired;
use crate::diagnosis::datapath::Wiring;
use crate::diagnosis::hypothesis::Hypothesis;
use crate::diagnosis::witnesses::Witnesses;
use crate::result::{ClampEnd, Defect};

/// The sum, the weights or both not rounded, or source coordinates; weights without their sign, or rounded toward zero; the outputs
/// not clamped at one end or both.
pub(super) fn propose<'a>(_: &Witnesses<'a>) -> Vec<Hypothesis<'a>> {
    let sound = Wiring::default();
    vec![
        wired(Wiring { rounding: 0, ..sound }, Defect::OutputRoundingMissing {}),
        wired(Wiring { weight_rounding: 0, ..sound }, Defect::WeightRoundingMissing {}),
        wired(Wiring { rounding: 0, weight_rounding: 0, ..sound }, Defect::RoundingMissing {}),
        wired(Wiring { rounds_source: false, ..sound }, Defect::SourceRoundingMissing {}),
        wired(Wiring { toward_zero: true, ..sound }, Defect::WeightsTowardZero {}),
        wired(Wiring { unsigned_weights: true, ..sound }, Defect::WeightsUnsigned {}),
        wired(Wiring { clamps_low: false, ..sound }, Defect::ClampMissing { end: ClampEnd::Low }),
        wired(Wiring { clamps_high: false, ..sound }, Defect::ClampMissing { end: ClampEnd::High }),
        wired(
            Wiring { clamps_low: false, clamps_high: false, ..sound },
            Defect::ClampMissing { end: ClampEnd::Both },
        ),
    ]
}
