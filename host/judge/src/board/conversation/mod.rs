//! Packets over a link: numbered, answered, repeated, counted.

mod answered;
mod damaged;
mod retry;
mod silence;
mod unclosed;

use std::mem;
use std::time::Duration;

use halfrow_protocol::message::{Request, RowIn, RowPlace};
use halfrow_protocol::{Decoder, Encoder, Header, Kind, Packet};

use super::conduct::Conduct;
use super::counted::Counted;
use super::deadlines::Step;
use super::lateness::Lateness;
use super::sent_requests::{LastRequest, LastRequests, Outgoing, Stray};
use super::tally::Tally;
use super::{BoardError, OpenOptions, Received, RetryLimit, Stop};
use crate::link::{ClosedLink, Link, LinkError};
use unclosed::Unclosed;

/// The most that an exchange which moved bytes adds to the time waited. An exchange returns as soon as a byte has moved. If it
/// took longer, the host may have been kept from running, and what it has not read yet is not held against the board. Nor is more
/// of the time added that the host took for these bytes: without that, a peer that sends faster than the host reads would never be
/// late.
const BRIEF: Duration = Duration::from_millis(50);

/// How far a board's window can be ahead of the rows that came back: the most banks in each direction, and two rows in the core.
const MOST_AHEAD: u32 = 2 * u8::MAX as u32 + 2;

/// What belongs to a session and is forgotten with it.
#[derive(Default)]
pub(super) struct Session {
    /// 0 until a board has answered HELLO.
    pub(super) number: u8,
    /// The board's window, the greatest of all packets.
    pub(super) window: u32,
    /// The row sequence number before which every row has come back.
    pub(super) acknowledged: u32,
    /// What packets acknowledge instead, if that is not all rows that came back.
    pub(super) acknowledges_to: Option<u32>,
    /// What its rows have shown about the board.
    pub(super) conduct: Conduct,
    /// Requests that change the board and reached it more than once, as far as can be seen.
    pub(super) repeated_changes: u64,
    /// Requests that change the board and were answered twice though sent once. The next count tells whether the request itself
    /// came twice.
    pub(super) doubled_changes: u64,
    /// All requests that were answered twice though sent once.
    pub(super) second_answers: u64,
    /// The row sequence number after that of the last row sent.
    pub(super) rows_sent: u32,
    /// Rows that may still come back although nobody takes them.
    pub(super) unwanted: u32,
    asked: LastRequests,
}

impl Session {
    /// Takes any packet, whatever session it names. In front of the reply to HELLO comes what an earlier board may have said.
    fn any_packet(&mut self, packet: &Packet<'_>) {
        if self.number != 0 {
            self.conduct.any_packet(packet);
        }
    }
}

pub(super) struct Conversation {
    link: Box<dyn Link>,
    encoder: Encoder,
    decoder: Decoder,
    outgoing: Vec<u8>,
    incoming: Vec<u8>,
    /// Number of the last packet.
    pub(super) sequence: u16,
    pub(super) session: Session,
    pub(super) tally: Tally,
    /// What came damaged before the session.
    before: Received,
    unclosed: Unclosed,
    pub(super) limit: RetryLimit,
    /// The time spent waiting for the link, by which deadlines are measured. While the host is kept from running, or is busy
    /// elsewhere, it cannot tell that a board is late.
    pub(super) waited: Duration,
    /// The time spent on what the last exchange brought, which is added with that of the next one.
    spent: Duration,
    /// The requests that were answered by a refusal.
    refused: u64,
    /// What the board counts of the packets sent.
    pub(super) counted: Counted,
    /// The header of the last answer to a request that was waited for.
    pub(super) answered: Header,
    /// That request.
    pub(super) last: LastRequest,
    /// Whether to ask for that count wherever a packet may have been lost unnoticed.
    pub(super) counts: bool,
    lateness: Lateness,
    /// When the last packet came in.
    pub(super) heard_at: Duration,
    /// When bytes last went out.
    sent_at: Duration,
    stop: Stop,
}

impl Conversation {
    pub(super) fn new(link: Box<dyn Link>, options: &OpenOptions) -> Self {
        Self {
            link,
            encoder: Encoder::new(),
            decoder: Decoder::new(),
            outgoing: Vec::new(),
            incoming: Vec::new(),
            sequence: options.ids.sequence,
            session: Session::default(),
            tally: Tally::default(),
            before: Received::default(),
            unclosed: Unclosed::default(),
            limit: options.retry_limit,
            waited: Duration::ZERO,
            spent: Duration::ZERO,
            refused: 0,
            counted: Counted::default(),
            answered: Header::default(),
            last: LastRequest::default(),
            counts: options.counts,
            lateness: Lateness::default(),
            heard_at: Duration::ZERO,
            sent_at: Duration::ZERO,
            stop: options.stop.clone(),
        }
    }

    /// Forgets the session and what belongs to it.
    pub(super) fn leave_session(&mut self) {
        self.session = Session::default();
    }

    /// The row sequence number before which rows may be sent: the board's window, limited to what is possible.
    pub(super) fn credit(&self) -> u32 {
        self.session.window.min(self.session.acknowledged.saturating_add(MOST_AHEAD))
    }

    /// Closes the link and forgets its tally.
    pub(super) fn hang_up(&mut self) {
        self.link = Box::new(ClosedLink);
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

    /// What came so far, and what may have kept more from coming.
    fn heard(&self) -> Received {
        let Tally { bytes_in: bytes, packets_in: packets, damaged_in: damaged, answered, .. } = self.tally;
        let answered = answered + self.refused;
        let waits_for_cts = self.link.waits_for_cts();
        Received { bytes, packets, answered, damaged, waits_for_cts, ..self.before }
    }

    pub(super) fn is_exclusive(&self) -> bool {
        self.link.is_exclusive()
    }

    /// Runs `act`, which is a [`Step::Close`]: whatever was to stop the run, it goes on for its tries, and no longer than twice as
    /// long as these take, since a peer that sends without end stretches them.
    pub(super) fn disregarding_stop<T>(&mut self, act: impl FnOnce(&mut Self) -> T) -> T {
        let tries = self.wait_for(Step::Close, 0, self.queued() + halfrow_protocol::MAX_PACKET)
            * Step::Close.deadline().attempts;
        let last = Stop::default().link_limit(Some(self.now() + 2 * tries));
        let stop = mem::replace(&mut self.stop, last);
        let done = act(self);
        self.stop = stop;
        done
    }

    /// Runs `act` under the number of another session, or under none if it is 0, then returns to the open one.
    pub(super) fn under_session<T>(&mut self, session: u8, act: impl FnOnce(&mut Self) -> T) -> T {
        let own = mem::replace(&mut self.session.number, session);
        let done = act(self);
        self.session.number = own;
        done
    }

    /// The time since `then`; zero if the link's clock went back, as that of a damaged recording may.
    pub(super) fn since(&self, then: Duration) -> Duration {
        self.now().saturating_sub(then)
    }

    /// How long to wait at the try `attempt`, from 0, if `bytes` have to travel, both ways together.
    pub(super) fn wait_for(&self, step: Step, attempt: u32, bytes: usize) -> Duration {
        step.wait(attempt, bytes, self.link.bytes_per_second(), self.lateness.longest())
    }

    /// Adds none of the time that the last exchange's bytes took to the time waited.
    pub(super) fn forget_spent(&mut self) {
        self.spent = Duration::ZERO;
    }

    /// Bytes that are waiting to be written.
    pub(super) fn queued(&self) -> usize {
        self.outgoing.len()
    }

    /// Queues this many zeros. They carry no meaning, and after them the board's decoder is at the beginning of a packet.
    pub(super) fn queue_zeros(&mut self, zeros: usize) {
        self.outgoing.resize(self.outgoing.len() + zeros, 0);
    }

    pub(super) fn next_sequence(&mut self) -> u16 {
        self.sequence = self.sequence.wrapping_add(1);
        self.sequence
    }

    /// Queues `request` under `sequence`.
    pub(super) fn queue(&mut self, request: &Request<'_>, sequence: u16) {
        self.queue_packet(request.kind(), sequence, |payload| request.write(payload));
    }

    /// Sends `asking` without waiting: its answer will be ignored.
    pub(super) fn tell(&mut self, asking: &Outgoing<'_>) {
        let sequence = self.next_sequence();
        self.counted.is_blind = true;
        self.session.asked.note_request(asking, sequence, self.now());
        self.queue_packet(asking.kind(), sequence, |payload| asking.write(payload));
    }

    /// Queues a row under the next number, packing its samples in place.
    pub(super) fn queue_row(&mut self, place: &RowPlace, samples: &[u16]) {
        let sequence = self.next_sequence();
        self.session.rows_sent = self.session.rows_sent.max(place.row_sequence.saturating_add(1));
        self.queue_packet(Kind::RowIn, sequence, |payload| RowIn::write_samples(place, samples, payload));
    }

    fn queue_packet(&mut self, kind: Kind, sequence: u16, write_payload: impl FnOnce(&mut Vec<u8>)) {
        let header = self.header(kind, sequence);
        let queued = self.encoder.encode(&header, write_payload, &mut self.outgoing);
        debug_assert!(queued.is_ok(), "a request is built to fit a packet");
        self.tally.packets_out += 1;
        self.counted.is_blind |= !is_missed(kind);
    }

    fn header(&self, kind: Kind, sequence: u16) -> Header {
        let session = if kind == Kind::Hello { 0 } else { self.session.number };
        let window = self.session.acknowledges_to.unwrap_or(self.session.acknowledged);
        Header { kind: kind.code(), sequence, reply: false, session, window }
    }

    /// Counts a retry. Retries after which nothing proved to be lost are no sign of a poor link.
    pub(super) fn count_retry(&mut self) -> Result<(), BoardError> {
        self.tally.retries += 1;
        let (packets, retries) = (self.tally.packets_out, self.tally.lost());
        if self.limit.is_exceeded(packets, retries) {
            return Err(BoardError::TooPoor { retries, packets, limit: self.limit.of(packets) });
        }
        Ok(())
    }

    /// Notes a retry that was needless: the first answer came `took` after its request.
    pub(super) fn note_late(&mut self, took: Duration) {
        self.tally.late += 1;
        self.lateness.note_needless(took);
    }

    /// Moves bytes both ways, at most for `wait`, and counts them and the time. A recording, whose clock stands still between its
    /// exchanges, counts what was spent there with the next one too.
    fn move_bytes(&mut self, wait: Duration) -> Result<(), LinkError> {
        self.incoming.clear();
        let begun = self.link.now();
        let moved = self.link.exchange(&self.outgoing, &mut self.incoming, wait);
        let is_idle = self.incoming.is_empty() && matches!(moved, Ok(0));
        let counts = if is_idle { wait } else { wait.min(BRIEF) };
        self.waited += (self.since(begun) + mem::take(&mut self.spent)).min(counts);
        self.tally.line_errors = self.link.line_errors();
        // A link of the caller's own may count what it adds.
        let taken = moved?.min(self.outgoing.len());
        self.outgoing.drain(..taken);
        if taken > 0 {
            self.sent_at = begun;
        }
        self.tally.bytes_out += taken as u64;
        self.tally.bytes_in += self.incoming.len() as u64;
        Ok(())
    }

    /// Moves bytes both ways, at most for `wait`, and hands every whole packet of this session to `take`.
    pub(super) fn exchange(
        &mut self,
        wait: Duration,
        doing: impl FnOnce() -> String,
        mut take: impl FnMut(&Packet<'_>),
    ) -> Result<(), BoardError> {
        self.stop.check(self.now(), self.since(self.heard_at))?;
        self.move_bytes(wait).map_err(|source| BoardError::of_link(doing(), source))?;
        let now = self.link.now();
        let mut strays = Vec::new();
        let mut bytes = self.incoming.as_slice();
        while let Some(packet) = self.decoder.next(&mut bytes) {
            packet.iter().for_each(|packet| self.session.any_packet(packet));
            match packet {
                Ok(packet) if packet.header.session == self.session.number || self.session.number == 0 => {
                    self.heard_at = now;
                    self.tally.packets_in += 1;
                    if self.session.number != 0 {
                        self.session.window = self.session.window.max(packet.header.window);
                        self.session.conduct.packet(&packet, self.session.rows_sent);
                        if let Some(stray) = self.session.asked.take_answer(&packet, now) {
                            strays.push(stray);
                            continue;
                        }
                    }
                    take(&packet);
                }
                Ok(stale) => {
                    tracing::debug!("a stale packet of session {}", stale.header.session);
                    self.tally.strays += 1;
                }
                Err(damage) => {
                    tracing::debug!("a damaged packet: {damage}");
                    if self.session.number == 0 {
                        self.before.note(damage);
                    } else {
                        self.tally.damaged_in += 1;
                    }
                }
            }
        }
        if !self.incoming.is_empty() {
            self.spent = self.since(now).min(BRIEF);
        }
        strays.into_iter().for_each(|stray| self.count_stray(stray));
        Ok(())
    }

    fn count_stray(&mut self, Stray { needless, changed, is_second }: Stray) {
        self.tally.strays += 1;
        self.session.second_answers += u64::from(is_second);
        let changes =
            if is_second { &mut self.session.doubled_changes } else { &mut self.session.repeated_changes };
        *changes += u64::from(changed);
        needless.into_iter().for_each(|took| self.note_late(took));
    }
}

/// Whether the host notices when a packet of `kind` is lost, because an answer of its own does not come.
fn is_missed(kind: Kind) -> bool {
    match kind {
        Kind::RowIn | Kind::RowAck => false,
        Kind::Hello
        | Kind::Capabilities
        | Kind::Status
        | Kind::Reset
        | Kind::Echo
        | Kind::TableWrite
        | Kind::TableRead
        | Kind::TableCrc
        | Kind::Commit
        | Kind::Configure
        | Kind::RowOut
        | Kind::Burst
        | Kind::Records
        | Kind::Expect
        | Kind::Trap
        | Kind::Refusal => true,
    }
}
