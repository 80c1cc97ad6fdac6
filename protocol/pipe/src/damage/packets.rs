//! Harm to whole packets.

use crate::chance::Chance;

/// What happens to a packet, a non-empty run between zeros.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PacketHarm {
    /// One of its bits, picked at random, flips.
    Flip,
    /// It gets lost; the zeros around it stay.
    Drop,
    /// It comes twice, with a zero in between.
    Duplicate,
    /// It comes after the next packet, which cannot suffer the same. A zero follows it there.
    Reorder,
    /// Its bytes from a random one on get lost; the zero after it stays.
    Truncate,
    /// It gets lost if it has at least this many bytes; the zeros around it stay. Shorter ones are not counted.
    Lose {
        /// The fewest bytes between the zeros.
        least: usize,
    },
}

/// A stream in which some packets suffer.
#[derive(Debug)]
pub(crate) struct SpoiltPackets {
    harm: PacketHarm,
    chance: Chance,
    /// Packets that have begun, and so the number of the next one.
    count: u64,
    inside: bool,
    struck: bool,
    /// The struck packet, as far as it has come.
    held: Vec<u8>,
    /// A packet that waits until the next one has passed.
    late: Vec<u8>,
}

impl SpoiltPackets {
    pub(super) fn new(harm: PacketHarm, chance: Chance) -> Self {
        let (held, late) = (Vec::new(), Vec::new());
        Self { harm, chance, count: 0, inside: false, struck: false, held, late }
    }

    pub(super) fn pass(&mut self, mut bytes: &[u8], out: &mut Vec<u8>) {
        while let Some(zero) = bytes.iter().position(|&byte| byte == 0) {
            self.run(&bytes[..zero], out);
            self.end(out);
            bytes = &bytes[zero + 1..];
        }
        self.run(bytes, out);
    }

    /// Takes bytes of a packet; there may be none.
    fn run(&mut self, bytes: &[u8], out: &mut Vec<u8>) {
        if bytes.is_empty() {
            return;
        }
        if !self.inside {
            self.inside = true;
            self.struck = match self.harm {
                // Its length is known only at its end, where this is decided.
                PacketHarm::Lose { .. } => true,
                _ => self.begins_struck() && self.late.is_empty(),
            };
        }
        let to = if self.struck { &mut self.held } else { out };
        to.extend_from_slice(bytes);
    }

    /// Counts a packet, and returns whether it is struck.
    fn begins_struck(&mut self) -> bool {
        self.count += 1;
        self.chance.strikes(self.count - 1)
    }

    /// Takes a zero.
    fn end(&mut self, out: &mut Vec<u8>) {
        let ended = std::mem::take(&mut self.inside);
        let late = if ended { std::mem::take(&mut self.late) } else { Vec::new() };
        if std::mem::take(&mut self.struck) {
            self.spoil(out);
        }
        out.push(0);
        if !late.is_empty() {
            out.extend(late);
            out.push(0);
        }
    }

    fn spoil(&mut self, out: &mut Vec<u8>) {
        let mut packet = std::mem::take(&mut self.held);
        match self.harm {
            PacketHarm::Flip => {
                let bit = self.chance.below(8 * packet.len());
                if let Some(byte) = packet.get_mut(bit / 8) {
                    *byte ^= 1 << (bit % 8);
                }
                out.extend(packet);
            }
            PacketHarm::Drop => {}
            PacketHarm::Lose { least } => {
                if packet.len() < least || !self.begins_struck() {
                    out.extend(packet);
                }
            }
            PacketHarm::Duplicate => {
                out.extend_from_slice(&packet);
                out.push(0);
                out.extend(packet);
            }
            PacketHarm::Reorder => self.late = packet,
            PacketHarm::Truncate => {
                packet.truncate(self.chance.below(packet.len()));
                out.extend(packet);
            }
        }
    }
}
