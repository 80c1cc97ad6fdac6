//! A stuck data line, of the line memory or at the output of the datapath.

use super::StuckLine;
use crate::diagnosis::hypothesis::Hypothesis;
use crate::diagnosis::witnesses::Witnesses;
use crate::result::Defect;

/// Data lines of the line memory, whatever the depth.
const LINES: u32 = 12;

/// Every data line stuck at either level, before and after the datapath.
pub(super) fn propose<'a>(_: &Witnesses<'a>) -> Vec<Hypothesis<'a>> {
    StuckLine::all(LINES).map(memory).chain(StuckLine::all(LINES).map(output)).collect()
}

fn memory<'a>(line: StuckLine) -> Hypothesis<'a> {
    let defect = Defect::LineMemoryDataStuck { bit: line.bit, value: line.value() };
    Hypothesis::new(defect, move |witness| {
        Some(witness.tables().corrected(&carried(line, witness.samples())).into())
    })
}

fn output<'a>(line: StuckLine) -> Hypothesis<'a> {
    let defect = Defect::OutputDataStuck { bit: line.bit, value: line.value() };
    Hypothesis::new(defect, move |witness| Some(carried(line, witness.expected).into()))
}

fn carried(line: StuckLine, samples: &[u16]) -> Vec<u16> {
    samples.iter().map(|&sample| line.carry(sample.into()) as u16).collect()
}
