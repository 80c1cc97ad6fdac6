//! A data line stuck: of the line memory, or behind the datapath.

use super::StuckLine;
use crate::diagnosis::hypothesis::{Cause, Hypothesis};
use crate::diagnosis::witnesses::Witnesses;

/// Data lines of the line memory, whatever the depth.
const LINES: u32 = 12;

/// Every data line stuck at either level, before the datapath and behind it.
pub(super) fn propose<'a>(_: &Witnesses<'a>) -> Vec<Hypothesis<'a>> {
    StuckLine::all(LINES).map(memory).chain(StuckLine::all(LINES).map(output)).collect()
}

fn memory<'a>(line: StuckLine) -> Hypothesis<'a> {
    let bit = line.bit;
    let cause = Cause {
        part: "data bit",
        place: format!("line memory, data bit {bit}, {}", line.describe()),
        defect: format!("bit {bit} of every stored sample at {}", u8::from(line.high)),
        next_step: format!("Check data line {bit} of the line memory, and the samples' way into it."),
    };
    Hypothesis::new(cause, move |witness| {
        Some(witness.tables().corrected(&carried(line, witness.samples())).into())
    })
}

fn output<'a>(line: StuckLine) -> Hypothesis<'a> {
    let bit = line.bit;
    let cause = Cause {
        part: "output bit",
        place: format!("corrected samples, bit {bit}, {}", line.describe()),
        defect: format!("bit {bit} of every output at {}", u8::from(line.high)),
        next_step: format!("Check data line {bit} from the datapath's output to the bank of corrected rows."),
    };
    Hypothesis::new(cause, move |witness| Some(carried(line, witness.expected).into()))
}

fn carried(line: StuckLine, samples: &[u16]) -> Vec<u16> {
    samples.iter().map(|&sample| line.carry(sample.into()) as u16).collect()
}
