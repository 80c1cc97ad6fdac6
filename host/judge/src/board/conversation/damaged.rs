//! Packets that are none: a board must not carry them out.

use halfrow_protocol::message::Request;
use halfrow_protocol::{Damage, Decoder};

use super::Conversation;

/// Where a header has its version and its length (WIRE.md, 1).
const MISNAMED: [usize; 3] = [0, 4, 5];

impl Conversation {
    /// How many packets with a wrong CRC, and how many that are broken otherwise, are queued behind so many bytes.
    pub(in crate::board) fn damage_behind(&self, bytes: usize) -> [u32; 2] {
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

    /// Queues `request` once for each byte that its packet has on the wire between two zeros, with a bit of that byte flipped.
    pub(in crate::board) fn queue_damaged(&mut self, request: &Request<'_>) {
        let from = self.outgoing.len();
        self.queue(request, self.sequence);
        // What is damaged is no packet.
        self.tally.packets_out -= 1;
        let whole = self.outgoing.split_off(from);
        for place in 1..whole.len().saturating_sub(1) {
            self.outgoing.extend_from_slice(&whole);
            let byte = self.outgoing.iter_mut().rev().nth(place);
            byte.into_iter().for_each(|byte| *byte ^= 1 << (place % 8));
        }
    }

    /// Queues `request` with a CRC that is right, once for each bit of its version and of its length, of which that one is wrong.
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
