//! The numbers of the packets in which the rows of a stream were sent. A refusal of a row under another number answers an old
//! packet.

use super::Given;

/// How many packets back a number is unique: numbers have 16 bits.
const RECENT: u64 = 1 << 15;

pub(super) struct Numbers {
    /// Numbers of rows that were sent before the stream.
    given: Vec<u16>,
    /// Packets that were sent before it.
    before: u64,
    /// Packets of the stream, and the last one's number.
    packets: u64,
    last: u16,
}

impl Numbers {
    /// Before the stream's first packet; `before` packets were sent earlier.
    pub(super) fn new(given: Given, before: u64) -> Self {
        Self { given: given.numbers, before, packets: 0, last: 0 }
    }

    /// Now `packets` packets have been sent in all, the last one under the number `last`.
    pub(super) fn go_on(&mut self, packets: u64, last: u16) {
        (self.packets, self.last) = (packets.saturating_sub(self.before), last);
    }

    /// Whether a row of the stream may have been sent under this number.
    pub(super) fn has(&self, number: u16) -> bool {
        let back = u64::from(self.last.wrapping_sub(number));
        back < self.packets.min(RECENT) || self.given.contains(&number)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stream_has_the_numbers_of_its_own_packets_and_of_rows_given_before() {
        let mut numbers = Numbers::new(Given { rows: 1, numbers: vec![7] }, 100);
        assert!(numbers.has(7) && !numbers.has(0));
        numbers.go_on(103, 1);
        assert!([7, 1, 0, 0xffff].into_iter().all(|number| numbers.has(number)));
        assert!([2, 6, 8, 0xfffe].into_iter().all(|number| !numbers.has(number)));
        numbers.go_on(100 + (1 << 20), 1);
        assert!(numbers.has(0x8002) && !numbers.has(0x8001));
    }
}
