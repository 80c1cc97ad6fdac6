//! Rounding and clamping that are missing.

use super::taps::wired;
use crate::diagnosis::datapath::Wiring;
use crate::diagnosis::hypothesis::{Cause, Hypothesis};
use crate::diagnosis::witnesses::Witnesses;

/// The sum or the weights not rounded, the outputs not clamped at either end or at one.
pub(super) fn propose<'a>(_: &Witnesses<'a>) -> Vec<Hypothesis<'a>> {
    let sound = Wiring::default();
    vec![
        wired(Wiring { rounding: 0, ..sound }, no_rounding()),
        wired(Wiring { weight_rounding: 0, ..sound }, no_weight_rounding()),
        wired(Wiring { rounding: 0, weight_rounding: 0, ..sound }, no_rounding_at_all()),
        wired(Wiring { clamps_low: false, ..sound }, no_clamp("below 0")),
        wired(Wiring { clamps_high: false, ..sound }, no_clamp("above the largest sample")),
        wired(Wiring { clamps_low: false, clamps_high: false, ..sound }, no_clamp("beyond either end")),
    ]
}

fn no_rounding() -> Cause {
    Cause {
        part: "rounding",
        place: "the output's rounding".to_owned(),
        defect: "dropping the fraction of the sum without adding a half, 2^13,".to_owned(),
        next_step: "Check the constant that is added to the weighted sum.".to_owned(),
    }
}

fn no_weight_rounding() -> Cause {
    Cause {
        part: "weight rounding",
        place: "the rounding of interpolated weights".to_owned(),
        defect: "dropping their fraction without adding a half, 2^7,".to_owned(),
        next_step: "Check the constant that is added between two kernel nodes.".to_owned(),
    }
}

fn no_rounding_at_all() -> Cause {
    Cause {
        part: "rounding",
        place: "the rounding of outputs and of interpolated weights".to_owned(),
        defect: "dropping the fractions of both without adding a half".to_owned(),
        next_step: "Check the constants that are added to the weighted sum and between two kernel nodes."
            .to_owned(),
    }
}

fn no_clamp(beyond: &str) -> Cause {
    Cause {
        part: "clamp",
        place: format!("the output's clamp, {beyond}"),
        defect: "letting such sums wrap".to_owned(),
        next_step: "Check the comparison that clamps the output to 0 and 2^B - 1.".to_owned(),
    }
}
