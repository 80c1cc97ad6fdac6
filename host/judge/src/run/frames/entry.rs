//! What entered the core, judged by the board's own CRC of it.

use std::iter;

use halfrow_model::row_signature;

use crate::result::{Finding, FlippedBit};

/// The polynomial of CRC-32, reflected: flipping the last bit of a row changes the row's CRC by this.
const LAST_BIT: u32 = 0xedb8_8320;

/// Rows that entered the core with other samples than were sent.
#[derive(Clone, Copy)]
pub(crate) struct WrongEntry {
    /// How many.
    pub(crate) rows: usize,
    /// The first of them.
    pub(crate) row: usize,
    /// Its frame.
    pub(crate) frame: u16,
    /// The single bit of this row which, if flipped, gives the board's CRC; none if no single bit does.
    pub(crate) flipped: Option<FlippedBit>,
}

impl WrongEntry {
    /// What was found of such rows.
    pub(crate) fn finding(self) -> Finding {
        let Self { rows, row, frame, flipped } = self;
        Finding::RowsEnteredChanged { rows, row, frame, flipped }
    }
}

/// The single bit of the row `sent`, of samples of `bits` bits, which gives the CRC `entered` when it is flipped.
pub(crate) fn flipped_bit(sent: &[u16], bits: u32, entered: u32) -> Option<FlippedBit> {
    let word = u16::BITS as usize;
    let wanted = row_signature(sent) ^ entered;
    // A CRC is linear: how a flipped bit changes it depends only on the bit's distance from the row's end.
    let one_earlier = |effect: &u32| Some(effect >> 1 ^ if effect & 1 == 1 { LAST_BIT } else { 0 });
    let effects = iter::successors(Some(LAST_BIT), one_earlier);
    let (_, place) = effects.zip((0..sent.len() * word).rev()).find(|(effect, _)| *effect == wanted)?;
    let flipped = FlippedBit { column: place / word, bit: (place % word) as u32 };
    (flipped.bit < bits).then_some(flipped)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flipped_bit_tells_its_place_and_nothing_else_has_one() {
        let sent: Vec<u16> = (0..1920).map(|column| (column * 2053 % 4096) as u16).collect();
        for (column, bit) in [(0, 0), (0, 11), (5, 7), (1919, 0), (1919, 11)] {
            let mut entered = sent.clone();
            entered[column] ^= 1 << bit;
            assert_eq!(flipped_bit(&sent, 12, row_signature(&entered)), Some(FlippedBit { column, bit }));
            assert_eq!(flipped_bit(&sent, bit, row_signature(&entered)), None);
            entered[column] ^= 2 << bit | 1 << (bit ^ 1);
            assert_eq!(flipped_bit(&sent, 12, row_signature(&entered)), None);
        }
        let right = row_signature(&sent);
        let of_unit = (0..32).map(|line| flipped_bit(&sent, 12, right ^ 1 << line));
        assert!(of_unit.chain([flipped_bit(&sent, 12, right)]).all(|found| found.is_none()));
    }
}
