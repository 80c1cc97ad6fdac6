//! The line memory: the one row of samples that the core holds.

use super::defects::StuckBits;

/// Width of the line memory in bits. Narrower samples leave the upper bits zero.
const SAMPLE_MASK: u16 = 0x0FFF;

/// A ring of M samples, written at a running address that is not reset between rows.
#[derive(Debug)]
pub(crate) struct Ring {
    memory: Vec<u16>,
    next: usize,
    address_lines: StuckBits,
    data_lines: StuckBits,
}

impl Ring {
    /// An all-zero ring of `size` samples, a power of two.
    pub(crate) fn new(size: usize, address_lines: StuckBits, data_lines: StuckBits) -> Self {
        Self { memory: vec![0; size], next: 0, address_lines, data_lines }
    }

    /// The address of the next write. When a row's first sample enters, it is the row's base.
    pub(crate) fn next_address(&self) -> usize {
        self.next
    }

    /// Writes one sample and advances the address.
    #[inline]
    pub(crate) fn write(&mut self, sample: u16) {
        let cell = self.cell(self.next);
        self.memory[cell] = self.data_lines.apply(sample) & SAMPLE_MASK;
        self.next = (self.next + 1) & (self.memory.len() - 1);
    }

    /// The sample `column` columns after the address `base`, or whatever has overwritten it since.
    #[inline]
    pub(crate) fn read(&self, base: usize, column: usize) -> u16 {
        self.memory[self.cell(base + column)]
    }

    /// The memory cell of an address; addresses wrap at M.
    fn cell(&self, address: usize) -> usize {
        usize::from(self.address_lines.apply(address as u16)) & (self.memory.len() - 1)
    }
}
