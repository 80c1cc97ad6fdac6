//! Harm to single bytes.

use crate::chance::Chance;

/// What happens to a byte.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ByteHarm {
    /// One of its bits, picked at random, flips.
    Flip,
    /// It gets lost.
    Drop,
    /// It comes twice.
    Duplicate,
    /// It gets lost, with everything after it up to the end of its packet.
    Truncate,
}

/// A stream in which some bytes suffer.
#[derive(Debug)]
pub(crate) struct SpoiltBytes {
    harm: ByteHarm,
    chance: Chance,
    /// Bytes that have come, and so the number of the next one.
    count: u64,
    /// Whether bytes get lost until the next zero.
    losing: bool,
}

impl SpoiltBytes {
    pub(super) fn new(harm: ByteHarm, chance: Chance) -> Self {
        Self { harm, chance, count: 0, losing: false }
    }

    pub(super) fn pass(&mut self, mut bytes: &[u8], out: &mut Vec<u8>) {
        while let Some((before, struck, after)) = self.split_at_struck(bytes) {
            self.copy(before, out);
            self.chance.strikes(self.count);
            self.spoil(struck, out);
            self.count += 1;
            bytes = after;
        }
        self.copy(bytes, out);
    }

    /// The first byte among `bytes` that is struck, with what is before and after it.
    fn split_at_struck<'b>(&self, bytes: &'b [u8]) -> Option<(&'b [u8], u8, &'b [u8])> {
        let offset = usize::try_from(self.chance.next()?.checked_sub(self.count)?).ok()?;
        let (before, rest) = bytes.split_at_checked(offset)?;
        rest.split_first().map(|(&struck, after)| (before, struck, after))
    }

    fn copy(&mut self, bytes: &[u8], out: &mut Vec<u8>) {
        self.count += bytes.len() as u64;
        self.keep(bytes, out);
    }

    fn keep(&mut self, bytes: &[u8], out: &mut Vec<u8>) {
        let mut kept = bytes;
        if self.losing {
            let end = bytes.iter().position(|&byte| byte == 0);
            self.losing = end.is_none();
            kept = &bytes[end.unwrap_or(bytes.len())..];
        }
        out.extend_from_slice(kept);
    }

    fn spoil(&mut self, byte: u8, out: &mut Vec<u8>) {
        match self.harm {
            ByteHarm::Flip => out.push(byte ^ 1 << self.chance.below(8)),
            ByteHarm::Drop => {}
            ByteHarm::Duplicate => out.extend([byte; 2]),
            ByteHarm::Truncate => {
                self.losing = true;
                self.keep(&[byte], out);
            }
        }
    }
}
