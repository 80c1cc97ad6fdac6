//! Rows in flight: as many as the board gives credit for, each asked for until it has come back.

use std::collections::{BTreeSet, VecDeque};
use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::Duration;

use halfrow_model::Frame;
use halfrow_protocol::message::{RefusalCode, Reply, Request, RowIn, RowOut, RowPlace};
use halfrow_protocol::{Kind, Packet, samples};

use super::BoardError;
use super::conversation::Conversation;
use super::deadlines::Step;

/// Bytes that may wait to be written before another row is packed. Two rows keep a link busy.
const QUEUE: usize = 8 * 1024;

/// A frame on its way to the board.
#[derive(Clone, Debug)]
pub struct NumberedFrame {
    /// Its number on the wire.
    pub number: u16,
    /// Its samples.
    pub frame: Arc<Frame>,
}

/// A row that came back.
#[derive(Clone, Copy, Debug)]
pub struct ReturnedRow<'a> {
    /// The number of its frame.
    pub frame: u16,
    /// The row of the frame.
    pub row: usize,
    /// The generation of the tables that made it.
    pub generation: u8,
    /// Pixel clocks from first in to first out.
    pub first_latency: u16,
    /// Pixel clocks from last in to last out.
    pub last_latency: u16,
    /// Its samples.
    pub samples: &'a [u16],
}

/// Where rows come from and where they go to.
pub trait RowTraffic {
    /// The next frame to send, all of one size; none at the end.
    fn next_frame(&mut self) -> Option<NumberedFrame>;

    /// Takes a row that came back, each row once; rows of a frame come in order unless the link lost one. Breaking
    /// ends the stream.
    fn returned(&mut self, row: &ReturnedRow<'_>) -> ControlFlow<()>;
}

/// Frames of which only the return matters.
#[derive(Clone, Debug)]
pub struct Unjudged<I>(pub I);

impl<I: Iterator<Item = NumberedFrame>> RowTraffic for Unjudged<I> {
    fn next_frame(&mut self) -> Option<NumberedFrame> {
        self.0.next()
    }

    fn returned(&mut self, _row: &ReturnedRow<'_>) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

/// Streams all frames of `traffic` through the board. Rows are numbered from `conversation.acknowledged` on.
pub(super) fn stream(
    conversation: &mut Conversation,
    traffic: &mut dyn RowTraffic,
) -> Result<(), BoardError> {
    let first_row = conversation.acknowledged;
    let mut stream = Stream {
        first_row,
        conversation,
        traffic,
        height: 0,
        frames: VecDeque::new(),
        frames_done: 0,
        exhausted: false,
        sent: first_row,
        ahead: BTreeSet::new(),
        attempts: 1,
        progress_at: Duration::ZERO,
        acknowledgement_sent: first_row,
        packed: Vec::new(),
        unpacked: Vec::new(),
        flow: ControlFlow::Continue(()),
    };
    stream.run()
}

struct Stream<'a> {
    conversation: &'a mut Conversation,
    traffic: &'a mut dyn RowTraffic,
    /// The row sequence number of the first row.
    first_row: u32,
    height: u32,
    /// Frames of which some row has not come back.
    frames: VecDeque<NumberedFrame>,
    frames_done: u32,
    exhausted: bool,
    /// The row sequence number of the next row to send for the first time.
    sent: u32,
    /// Rows that came back although an earlier one has not.
    ahead: BTreeSet<u32>,
    /// How often the oldest missing row was asked for.
    attempts: u32,
    progress_at: Duration,
    acknowledgement_sent: u32,
    packed: Vec<u8>,
    unpacked: Vec<u16>,
    flow: ControlFlow<()>,
}

impl Stream<'_> {
    fn run(&mut self) -> Result<(), BoardError> {
        self.fetch();
        self.progress_at = self.conversation.now();
        while self.flow.is_continue() && !self.is_complete() {
            self.fill();
            self.receive()?;
            if self.overdue() {
                self.ask_again()?;
            }
        }
        // The last acknowledgement frees the board's banks; nobody waits for it.
        self.acknowledge();
        Ok(())
    }

    fn is_complete(&self) -> bool {
        self.exhausted && self.missing() == self.end()
    }

    /// The oldest row that has not come back.
    fn missing(&self) -> u32 {
        self.conversation.acknowledged
    }

    /// The row sequence number behind the last row of the frames that were fetched.
    fn end(&self) -> u32 {
        self.first_row + (self.frames_done + self.frames.len() as u32) * self.height
    }

    fn fetch(&mut self) {
        match self.traffic.next_frame() {
            Some(frame) => {
                self.height = frame.frame.height() as u32;
                self.frames.push_back(frame);
            }
            None => self.exhausted = true,
        }
    }

    /// Queues rows as far as credit and queue allow, or an acknowledgement when there is none to send.
    fn fill(&mut self) {
        while self.conversation.queued() < QUEUE && self.sent < self.conversation.credit {
            if self.sent == self.end() {
                if !self.exhausted {
                    self.fetch();
                }
                if self.exhausted {
                    break;
                }
            }
            self.send(self.sent);
            self.sent += 1;
        }
        if self.conversation.is_drained() && self.acknowledgement_sent < self.missing() {
            self.acknowledge();
        }
    }

    fn acknowledge(&mut self) {
        let sequence = self.conversation.next_sequence();
        self.conversation.queue(&Request::RowAck, sequence);
        self.acknowledgement_sent = self.missing();
    }

    fn send(&mut self, row_sequence: u32) {
        let Some((number, frame, row)) = self.row(row_sequence) else { return };
        let place = place(row_sequence, number, row, &frame);
        self.packed.clear();
        samples::pack(frame.row(row), &mut self.packed);
        let sequence = self.conversation.next_sequence();
        self.conversation.queue(&Request::RowIn(RowIn { place, packed: &self.packed }), sequence);
        self.acknowledgement_sent = self.missing();
    }

    /// The frame and the row with this number, unless it came back long ago.
    fn row(&self, row_sequence: u32) -> Option<(u16, Arc<Frame>, usize)> {
        let index = row_sequence.checked_sub(self.first_row)?;
        let frame = index.checked_div(self.height)?.checked_sub(self.frames_done)?;
        let frame = self.frames.get(frame as usize)?;
        Some((frame.number, Arc::clone(&frame.frame), (index % self.height) as usize))
    }

    fn receive(&mut self) -> Result<(), BoardError> {
        let wait = self.patience().saturating_sub(self.conversation.now() - self.progress_at);
        let missing = self.missing();
        let mut rows = Vec::new();
        let mut refusal = None;
        self.conversation.exchange(
            wait,
            || format!("waiting for row {missing} of the run"),
            |packet| match read(packet) {
                Ok(Some(row)) => rows.push(row),
                Ok(None) => {}
                Err(error) => refusal = Some(error),
            },
        )?;
        if let Some(error) = refusal {
            return Err(error);
        }
        rows.into_iter().try_for_each(|row| self.take(&row))
    }

    fn take(&mut self, row: &OwnedRow) -> Result<(), BoardError> {
        let row_sequence = row.place.row_sequence;
        let Some((number, frame, index)) = self.row(row_sequence) else { return Ok(()) };
        if row_sequence < self.missing() || self.flow.is_break() || !self.ahead.insert(row_sequence) {
            return Ok(());
        }
        if row.place != place(row_sequence, number, index, &frame) {
            return Err(BoardError::WrongPlace { place: row.place });
        }
        self.unpacked.resize(frame.width(), 0);
        samples::unpack(&row.packed, &mut self.unpacked);
        let returned = ReturnedRow {
            frame: number,
            row: index,
            generation: row.generation,
            first_latency: row.first_latency,
            last_latency: row.last_latency,
            samples: &self.unpacked,
        };
        self.flow = self.traffic.returned(&returned);
        if row_sequence > self.missing() && self.attempts == 1 {
            // Rows come in order, so the missing one was made and got lost on the way.
            return self.ask_again();
        }
        self.advance();
        Ok(())
    }

    fn advance(&mut self) {
        let before = self.missing();
        while self.ahead.remove(&self.conversation.acknowledged) {
            self.conversation.acknowledged += 1;
        }
        if self.missing() > before {
            self.attempts = 1;
            self.progress_at = self.conversation.now();
        }
        while self.frames.len() > 1 && self.missing() - self.first_row >= (self.frames_done + 1) * self.height
        {
            self.frames.pop_front();
            self.frames_done += 1;
        }
    }

    /// How long the oldest missing row may take: all rows in flight travel before it.
    fn patience(&self) -> Duration {
        let in_flight = (self.sent - self.missing()) as usize;
        let width = self.frames.front().map_or(0, |frame| frame.frame.width());
        let row = samples::packed_length(width) + 64;
        self.conversation.wait_for(Step::Row, self.conversation.queued() + 2 * in_flight * row)
    }

    fn overdue(&self) -> bool {
        self.conversation.now() - self.progress_at >= self.patience()
    }

    fn ask_again(&mut self) -> Result<(), BoardError> {
        let missing = self.missing();
        let Some((number, frame, row)) = self.row(missing) else { return Ok(()) };
        if self.attempts == Step::Row.deadline().attempts {
            let place = place(missing, number, row, &frame);
            return Err(BoardError::RowMissing { place, attempts: self.attempts });
        }
        tracing::info!("row {row} of frame {number} is missing; sending it again");
        self.conversation.count_retry()?;
        self.attempts += 1;
        self.progress_at = self.conversation.now();
        if self.conversation.queued() < QUEUE {
            self.send(missing);
            // A row leaves the core while its successor enters, so the successor may be the one that was lost.
            if missing + 1 < self.sent {
                self.send(missing + 1);
            }
        }
        Ok(())
    }
}

fn place(row_sequence: u32, frame: u16, row: usize, of: &Frame) -> RowPlace {
    RowPlace { row_sequence, frame, row: row as u16, width: of.width() as u16, last: row + 1 == of.height() }
}

struct OwnedRow {
    place: RowPlace,
    generation: u8,
    first_latency: u16,
    last_latency: u16,
    packed: Vec<u8>,
}

fn read(packet: &Packet<'_>) -> Result<Option<OwnedRow>, BoardError> {
    if ![Kind::RowOut.code(), Kind::Refusal.code()].contains(&packet.header.kind) {
        return Ok(None);
    }
    let malformed = |source| BoardError::Malformed { kind: Kind::RowIn, source };
    match Reply::read(packet).map_err(malformed)? {
        Reply::RowOut(RowOut { place, generation, first_latency, last_latency, packed, .. }) => {
            Ok(Some(OwnedRow { place, generation, first_latency, last_latency, packed: packed.to_vec() }))
        }
        Reply::Refusal(refusal) if refusal.code == RefusalCode::Session => Err(BoardError::SessionLost),
        Reply::Refusal(refusal) if refusal.kind == Kind::RowIn.code() => {
            Err(BoardError::Refused { kind: Kind::RowIn, refusal })
        }
        _ => Ok(None),
    }
}
