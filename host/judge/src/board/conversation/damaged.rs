//! Damaged packets, which a board must not carry out.

use halfrow_protocol::message::Request;
use halfrow_protocol::{Damage, Decoder};

use super::Conversation;

/// The bytes of version and length in a header (WIRE.md, 1).
const MISNAMED: [usize; 3] = [0, 4, 5];

impl Conversation {
    /// How many packets with a wrong CRC, and how many broken otherwise, are queued after the first `bytes` bytes.
    pub(in crate::board) fn damage_after(&self, bytes: usize) -> [u32; 2] {
        let (mut decoder, [mut crc, mut framing]) = (Decoder::new(), [0; 2]);
        let mut queued = &self.outgoing[bytes..];
        while let Some(packet) = decoder.next(&mut queued) {
            match packet {
                Ok(_) => {}
                Err(Damage::Crc) => crc += 1,
                Err(_) => framing += 1,
            }
        }
        [crc, framing]
    }

    /// Queues `request` once for each byte of its packet on the wire, without the zeros around it, with one bit of that byte
    /// flipped.
    pub(in crate::board) fn queue_damaged(&mut self, request: &Request<'_>) {
        let from = self.outgoing.len();
        self.queue(request, self.sequence);
        // A damaged packet does not count as a packet.
        self.tally.packets_out -= 1;
        let whole = self.outgoing.split_off(from);
        for place in 1..whole.len().saturating_sub(1) {
            self.outgoing.extend_from_slice(&whole);
            let byte = self.outgoing.iter_mut().rev().nth(place);
            byte.into_iter().for_each(|byte| *byte ^= 1 << (place % 8));
        }
    }

    /// Queues `request` with a right CRC once for each bit of its version and its length, with that bit wrong.
    pub(in crate::board) fn queue_misnamed(&mut self, request: &Request<'_>) {
        let header = self.header(request.kind(), self.sequence);
        for (byte, bit) in MISNAMED.into_iter().flat_map(|byte| (0..u8::BITS).map(move |bit| (byte, bit))) {
            let alter = |packet: &mut [u8]| packet[byte] ^= 1 << bit;
            let write = |payload: &mut Vec<u8>| request.write(payload);
            let queued = self.encoder.encode_altered(&header, write, alter, &mut self.outgoing);
            debug_assert!(queued.is_ok(), "a request is built to fit a packet");
        }
    }
}
