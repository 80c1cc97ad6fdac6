//! Packets over a link: numbered, answered, asked again, counted.

use std::time::Duration;

use halfrow_protocol::message::{RefusalCode, Reply, Request, RowIn, RowPlace};
use halfrow_protocol::{Decoder, Encoder, Header, Kind, Packet};

use super::deadlines::{RetryLimit, Step};
use super::{BoardError, Stop};
use crate::link::{LineErrors, Link, Severed};

/// What a link did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Bytes written.
    pub bytes_out: u64,
    /// Bytes read.
    pub bytes_in: u64,
    /// Packets written.
    pub packets_out: u64,
    /// Packets read whole.
    pub packets_in: u64,
    /// Packets that came damaged since the session began.
    pub damaged_in: u64,
    /// Packets sent again.
    pub retries: u64,
    /// What the link's chip has seen go wrong on the line.
    pub line_errors: LineErrors,
}

impl std::ops::AddAssign for Tally {
    fn add_assign(&mut self, other: Self) {
        self.bytes_out += other.bytes_out;
        self.bytes_in += other.bytes_in;
        self.packets_out += other.packets_out;
        self.packets_in += other.packets_in;
        self.damaged_in += other.damaged_in;
        self.retries += other.retries;
        self.line_errors += other.line_errors;
    }
}

/// A packet that was kept.
pub(super) struct Kept {
    header: Header,
    payload: Vec<u8>,
}

impl Kept {
    pub(super) fn packet(&self) -> Packet<'_> {
        Packet { header: self.header, payload: &self.payload }
    }
}

pub(super) struct Conversation {
    link: Box<dyn Link>,
    encoder: Encoder,
    decoder: Decoder,
    outgoing: Vec<u8>,
    incoming: Vec<u8>,
    sequence: u16,
    /// 0 until a board has answered HELLO.
    pub(super) session: u8,
    /// The row sequence number before which rows may be sent.
    pub(super) credit: u32,
    /// The row sequence number before which every row has come back.
    pub(super) acknowledged: u32,
    pub(super) tally: Tally,
    pub(super) limit: RetryLimit,
    stop: Stop,
}

impl Conversation {
    pub(super) fn new(link: Box<dyn Link>, limit: RetryLimit, stop: Stop) -> Self {
        Self {
            link,
            encoder: Encoder::new(),
            decoder: Decoder::new(),
            outgoing: Vec::new(),
            incoming: Vec::new(),
            sequence: 0,
            session: 0,
            credit: 0,
            acknowledged: 0,
            tally: Tally::default(),
            limit,
            stop,
        }
    }

    /// Closes the link and forgets what it did.
    pub(super) fn hang_up(&mut self) {
        self.link = Box::new(Severed);
        self.tally = Tally::default();
    }

    pub(super) fn now(&self) -> Duration {
        self.link.now()
    }

    pub(super) fn bytes_per_second(&self) -> Option<f64> {
        self.link.bytes_per_second()
    }

    pub(super) fn link_name(&self) -> String {
        self.link.name()
    }

    pub(super) fn is_exclusive(&self) -> bool {
        self.link.is_exclusive()
    }

    /// From now on nothing but a deadline ends a wait.
    pub(super) fn disregard_stop(&mut self) {
        self.stop = Stop::default();
    }

    pub(super) fn wait_for(&self, step: Step, bytes: usize) -> Duration {
        step.wait(bytes, self.link.bytes_per_second())
    }

    /// Whether all that was queued has left.
    pub(super) fn is_drained(&self) -> bool {
        self.outgoing.is_empty()
    }

    /// Bytes that wait to be written.
    pub(super) fn queued(&self) -> usize {
        self.outgoing.len()
    }

    /// Bytes without meaning, so that the board's decoder is at a packet's beginning.
    pub(super) fn queue_zeros(&mut self) {
        self.outgoing.extend_from_slice(&[0, 0]);
    }

    pub(super) fn next_sequence(&mut self) -> u16 {
        self.sequence = self.sequence.wrapping_add(1);
        self.sequence
    }

    /// Queues `request` under `sequence`.
    pub(super) fn queue(&mut self, request: &Request<'_>, sequence: u16) {
        self.queue_packet(request.kind(), sequence, |payload| request.write(payload));
    }

    /// Queues a row under the next number, its samples packed where they go.
    pub(super) fn queue_row(&mut self, place: &RowPlace, samples: &[u16]) {
        let sequence = self.next_sequence();
        self.queue_packet(Kind::RowIn, sequence, |payload| RowIn::write_samples(place, samples, payload));
    }

    fn queue_packet(&mut self, kind: Kind, sequence: u16, write_payload: impl FnOnce(&mut Vec<u8>)) {
        let header = Header {
            kind: kind.code(),
            sequence,
            reply: false,
            session: if kind == Kind::Hello { 0 } else { self.session },
            window: self.acknowledged,
        };
        let queued = self.encoder.encode(&header, write_payload, &mut self.outgoing);
        debug_assert!(queued.is_ok(), "a request is built to fit a packet");
        self.tally.packets_out += 1;
    }

    /// Counts a retry.
    pub(super) fn count_retry(&mut self) -> Result<(), BoardError> {
        self.tally.retries += 1;
        let limit = self.limit.of(self.tally.packets_out);
        if self.tally.retries > limit {
            let (retries, packets) = (self.tally.retries, self.tally.packets_out);
            return Err(BoardError::TooPoor { retries, packets, limit });
        }
        Ok(())
    }

    /// Moves bytes both ways, for `wait` at most, and hands every whole packet of this session to `take`.
    pub(super) fn exchange(
        &mut self,
        wait: Duration,
        doing: impl FnOnce() -> String,
        mut take: impl FnMut(&Packet<'_>),
    ) -> Result<(), BoardError> {
        self.stop.check(self.link.now())?;
        self.incoming.clear();
        let moved = self.link.exchange(&self.outgoing, &mut self.incoming, wait);
        self.tally.line_errors = self.link.line_errors();
        let taken = moved.map_err(|source| BoardError::Link { doing: doing(), source: Box::new(source) })?;
        self.outgoing.drain(..taken);
        self.tally.bytes_out += taken as u64;
        self.tally.bytes_in += self.incoming.len() as u64;
        let mut bytes = self.incoming.as_slice();
        while let Some(packet) = self.decoder.next(&mut bytes) {
            match packet {
                Ok(packet) if packet.header.session == self.session || self.session == 0 => {
                    self.tally.packets_in += 1;
                    if self.session != 0 {
                        self.credit = self.credit.max(packet.header.window);
                    }
                    take(&packet);
                }
                Ok(stale) => tracing::debug!("a stale packet of session {}", stale.header.session),
                Err(damage) => {
                    tracing::debug!("a damaged packet: {damage}");
                    self.tally.damaged_in += u64::from(self.session != 0);
                }
            }
        }
        Ok(())
    }

    /// Asks until a reply that `accept` takes has come.
    pub(super) fn ask(
        &mut self,
        request: &Request<'_>,
        step: Step,
        accept: impl Fn(&Packet<'_>) -> bool,
    ) -> Result<Kept, BoardError> {
        let kind = request.kind();
        let sequence = self.next_sequence();
        let begun = self.now();
        let attempts = step.deadline().attempts;
        for attempt in 0..attempts {
            if attempt > 0 {
                tracing::info!("{kind:?} was not answered; asking again");
                self.count_retry()?;
            }
            if attempt == 0 || self.is_drained() {
                self.queue(request, sequence);
            }
            // The reply may be as long as the longest packet.
            let bytes = self.outgoing.len() + halfrow_protocol::MAX_PACKET;
            let deadline = self.now() + self.wait_for(step, bytes);
            while self.now() < deadline {
                let mut answer = None;
                let wait = deadline - self.now();
                self.exchange(
                    wait,
                    || format!("waiting for the answer to {kind:?}"),
                    |packet| {
                        let header = packet.header;
                        // Rows count their own sequence numbers, and bit 0 of the flags is not looked at.
                        let is_reply = header.kind != Kind::RowOut.code();
                        if is_reply && header.sequence == sequence && accept(packet) {
                            answer = Some(Kept { header, payload: packet.payload.to_vec() });
                        }
                    },
                )?;
                if let Some(answer) = answer {
                    return Ok(answer);
                }
            }
        }
        Err(BoardError::NoAnswer { kind, attempts, waited: self.now() - begun })
    }

    /// Asks, and takes the expected part of the reply.
    pub(super) fn request<T>(
        &mut self,
        request: &Request<'_>,
        step: Step,
        take: impl FnOnce(Reply<'_>) -> Option<T>,
    ) -> Result<T, BoardError> {
        let answer = self.ask(request, step, |_| true)?;
        take_reply(request.kind(), &answer, take)
    }
}

/// The expected part of a reply, or the error that stands in its place.
pub(super) fn take_reply<T>(
    kind: Kind,
    answer: &Kept,
    take: impl FnOnce(Reply<'_>) -> Option<T>,
) -> Result<T, BoardError> {
    match Reply::read(&answer.packet()).map_err(|source| BoardError::Malformed { kind, source })? {
        Reply::Refusal(refusal) if refusal.code == RefusalCode::Session => Err(BoardError::SessionLost),
        Reply::Refusal(refusal) => Err(BoardError::Refused { kind, refusal }),
        reply => take(reply).ok_or(BoardError::Unexpected { kind }),
    }
}
