//! Data lines of samples that are inverted, exchanged or connected, and lines that are stuck in every other column.

use halfrow_protocol::samples::{pack, unpack};

use crate::diagnosis::hypothesis::Hypothesis;
use crate::diagnosis::witnesses::Witnesses;
use crate::result::{ColumnParity, Defect, LineFault, SampleBus, SampleLines};

/// Rows at which each of the many hypotheses is tried first, and the share of these that it must explain.
const GLANCED: usize = 3;
const PROMISING: f64 = 0.2;
/// Lines of a byte.
const OF_BYTES: u32 = 8;

pub(super) fn propose<'a>(witnesses: &Witnesses<'a>) -> Vec<Hypothesis<'a>> {
    let Some(geometry) = witnesses.geometry() else { return Vec::new() };
    let bits = geometry.depth().bits();
    let buses = [
        (SampleBus::LineMemory, bits),
        (SampleBus::Output, bits),
        (SampleBus::BytesIn, OF_BYTES),
        (SampleBus::BytesOut, OF_BYTES),
    ];
    let all = buses.into_iter().flat_map(|(bus, lines)| faults(bus, lines)).map(hypothesis);
    all.filter(|lines| lines.score(witnesses.differing.iter().take(GLANCED)).share() >= PROMISING).collect()
}

/// What may be wrong with the `lines` lines of a bus. Lines stuck in all columns are those of `memory_data`.
fn faults(bus: SampleBus, lines: u32) -> Vec<SampleLines> {
    use LineFault::{Exchanged, Inverted, JoinedHigh, JoinedLow, StuckHigh, StuckLow};
    let is_of_bytes = matches!(bus, SampleBus::BytesIn | SampleBus::BytesOut);
    let parities = [Some(ColumnParity::Even), Some(ColumnParity::Odd)].into_iter().filter(|_| !is_of_bytes);
    let of_one = [StuckLow, StuckHigh, Inverted].into_iter().flat_map(|fault| {
        let all = (is_of_bytes || fault == Inverted).then_some(None);
        all.into_iter().chain(parities.clone()).map(move |columns| (fault, columns))
    });
    let one = of_one.flat_map(|(fault, columns)| {
        (0..lines).map(move |bit| SampleLines { bus, fault, bits: vec![bit], columns })
    });
    let two = [Exchanged, JoinedLow, JoinedHigh].into_iter().flat_map(|fault| {
        let pairs = (0..lines).flat_map(move |low| (low + 1..lines).map(move |high| vec![low, high]));
        pairs.map(move |bits| SampleLines { bus, fault, bits, columns: None })
    });
    one.chain(two).collect()
}

fn hypothesis<'a>(lines: SampleLines) -> Hypothesis<'a> {
    Hypothesis::new(Defect::SampleLinesWrong(lines.clone()), move |row| {
        let carried = match lines.bus {
            SampleBus::Output | SampleBus::BytesOut => carried(&lines, row.expected),
            SampleBus::LineMemory | SampleBus::BytesIn => {
                row.tables().corrected(&carried(&lines, row.samples()))
            }
        };
        Some(carried.into())
    })
}

/// What the samples of a row become on these lines.
fn carried(lines: &SampleLines, samples: &[u16]) -> Vec<u16> {
    if matches!(lines.bus, SampleBus::LineMemory | SampleBus::Output) {
        let of_column = |(column, &sample): (usize, &u16)| {
            if is_meant(lines.columns, column) { carry(lines, sample) } else { sample }
        };
        return samples.iter().enumerate().map(of_column).collect();
    }
    let mut packed = Vec::new();
    pack(samples, &mut packed);
    packed.iter_mut().for_each(|byte| *byte = carry(lines, (*byte).into()) as u8);
    let mut carried = vec![0; samples.len()];
    unpack(&packed, &mut carried);
    carried
}

fn is_meant(columns: Option<ColumnParity>, column: usize) -> bool {
    match columns {
        None => true,
        Some(ColumnParity::Even) => column.is_multiple_of(2),
        Some(ColumnParity::Odd) => !column.is_multiple_of(2),
    }
}

fn carry(SampleLines { fault, bits, .. }: &SampleLines, word: u16) -> u16 {
    let lines = bits.iter().fold(0, |all, bit| all | 1_u16 << bit);
    let set = word & lines;
    let carried = match fault {
        LineFault::StuckLow => 0,
        LineFault::StuckHigh => lines,
        LineFault::Inverted => !set & lines,
        LineFault::Exchanged if set == 0 || set == lines => set,
        LineFault::Exchanged => !set & lines,
        LineFault::JoinedLow if set == lines => lines,
        LineFault::JoinedLow => 0,
        LineFault::JoinedHigh if set == 0 => 0,
        LineFault::JoinedHigh => lines,
    };
    word & !lines | carried
}
