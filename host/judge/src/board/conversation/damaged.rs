//! Packets that are none: a board must not carry them out.

use halfrow_protocol::message::Request;

use super::Conversation;

/// Where a header has its version and its length (WIRE.md, 1).
const MISNAMED: [usize; 3] = [0, 4, 5];

impl Conversation {
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
