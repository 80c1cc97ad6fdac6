//! Rows in flight: as many as the board gives credit for, each asked for until it has come back.

mod arrivals;
mod in_flight;
mod late;
mod numbers;
mod traffic;

use std::time::Duration;

use halfrow_protocol::message::{Request, RowPlace};
use halfrow_protocol::samples;

use super::BoardError;
use super::conversation::Conversation;
use super::deadlines::Step;
use arrivals::Arrivals;
use late::LateRows;
use numbers::Numbers;

pub(crate) use traffic::Unjudged;
pub use traffic::{NumberedFrame, ReturnedRow, RowTraffic};

/// Bytes that may be waiting to be written when another row is packed. Two rows keep a link busy.
const QUEUE: usize = 8 * 1024;

/// When a row is never asked for again, it is waited for as long as at this try: by then most late rows have come.
const PATIENT: u32 = 3;

/// A row that did not come back although it was asked for only once.
#[derive(Clone, Debug)]
pub(crate) struct Unreturned {
    /// Its place.
    pub place: RowPlace,
    /// Its samples.
    pub samples: Vec<u16>,
    /// Rows sent in this stream, including this one and those after it.
    pub sent: u32,
    /// Rows that came back, including those after this one.
    pub returned: u32,
}

/// Rows of the next stream that the board was given before it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Given {
    /// How many of its first rows.
    pub rows: u32,
    /// The numbers of the packets.
    pub numbers: Vec<u16>,
}

/// Streams all frames of `traffic` through the board; the board may have been `given` their first rows already. Rows are numbered
/// from `conversation.session.acknowledged` on.
pub(super) fn stream(
    conversation: &mut Conversation,
    traffic: &mut dyn RowTraffic,
    given: Given,
) -> Result<(), BoardError> {
    let rows = given.rows;
    conversation.count_second_answers();
    let mut stream = Stream::new(conversation, traffic, given, Step::Row.deadline().attempts);
    stream.sent += rows;
    stream.run()
}

/// The same, up to the first row that does not come back without being asked for again.
pub(super) fn stream_once(
    conversation: &mut Conversation,
    traffic: &mut dyn RowTraffic,
) -> Result<Option<Unreturned>, BoardError> {
    let first_row = conversation.session.acknowledged;
    let mut stream = Stream::new(conversation, traffic, Given::default(), 1);
    match stream.run() {
        Ok(()) => Ok(None),
        Err(BoardError::RowMissing { place, .. }) => {
            let row = stream.arrivals.in_flight.row(stream.missing());
            Ok(Some(Unreturned {
                place,
                samples: row.map(|row| row.frame.row(row.index).to_vec()).unwrap_or_default(),
                sent: stream.sent - first_row,
                returned: stream.missing() - first_row + stream.arrivals.ahead(),
            }))
        }
        Err(error) => Err(error),
    }
}

struct Stream<'a> {
    conversation: &'a mut Conversation,
    arrivals: Arrivals<'a>,
    /// Whether there are no more frames to fetch.
    exhausted: bool,
    /// The row sequence number of the next row to send for the first time.
    sent: u32,
    /// How often the oldest missing row was asked for.
    attempts: u32,
    /// The most times that it may be asked for.
    most: u32,
    /// When the wait for the oldest missing row began.
    missing_since: Duration,
    progress_at: Duration,
    late: LateRows,
    acknowledgement_sent: u32,
}

impl<'a> Stream<'a> {
    fn new(
        conversation: &'a mut Conversation,
        traffic: &'a mut dyn RowTraffic,
        given: Given,
        most: u32,
    ) -> Self {
        let (first_row, now) = (conversation.session.acknowledged, conversation.waited);
        let numbers = Numbers::new(given, conversation.tally.packets_out);
        Self {
            conversation,
            arrivals: Arrivals::new(traffic, first_row, numbers),
            exhausted: false,
            sent: first_row,
            attempts: 1,
            most,
            missing_since: now,
            progress_at: now,
            late: LateRows::default(),
            acknowledgement_sent: first_row,
        }
    }

    fn run(&mut self) -> Result<(), BoardError> {
        self.go_on();
        while self.arrivals.flow.is_continue() && self.has_more() {
            self.fill();
            self.receive()?;
            if self.overdue() {
                self.ask_again()?;
            }
        }
        // The last acknowledgement frees the board's banks; neither it nor earlier ones are answered.
        self.acknowledge();
        self.conversation.count();
        Ok(())
    }

    /// From now on the oldest missing row is waited for.
    fn go_on(&mut self) {
        // Judging the row that came is no wait for the next one.
        self.conversation.forget_spent();
        self.progress_at = self.conversation.waited;
        self.missing_since = self.progress_at;
    }

    /// Whether a row has still to come back. That a frame was the last is known only when the next one is fetched.
    fn has_more(&mut self) -> bool {
        if self.missing() == self.arrivals.in_flight.end() && !self.exhausted {
            self.fetch();
        }
        self.missing() != self.arrivals.in_flight.end()
    }

    /// The oldest row that has not come back.
    fn missing(&self) -> u32 {
        self.arrivals.missing
    }

    /// A number that grows with each row that comes.
    fn came(&self) -> u32 {
        self.missing() + self.arrivals.ahead()
    }

    fn fetch(&mut self) {
        match self.arrivals.traffic.next_frame() {
            Some(frame) => self.arrivals.in_flight.add(frame),
            None => self.exhausted = true,
        }
    }

    /// Queues rows as far as credit and queue allow, or an acknowledgement if there is no row to send.
    fn fill(&mut self) {
        while self.conversation.queued() < QUEUE && self.sent < self.conversation.credit() {
            if self.sent == self.arrivals.in_flight.end() {
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
        if self.conversation.queued() == 0 && self.acknowledgement_sent < self.missing() {
            self.acknowledge();
        }
    }

    fn acknowledge(&mut self) {
        let sequence = self.conversation.next_sequence();
        self.conversation.queue(&Request::RowAck, sequence);
        self.acknowledgement_sent = self.missing();
    }

    fn send(&mut self, row_sequence: u32) {
        let Some(row) = self.arrivals.in_flight.row(row_sequence) else { return };
        self.conversation.queue_row(&row.place, row.frame.row(row.index));
        self.acknowledgement_sent = self.missing();
    }

    fn receive(&mut self) -> Result<(), BoardError> {
        let wait = self.patience().saturating_sub(self.conversation.waited.saturating_sub(self.progress_at));
        let (missing, came) = (self.missing(), self.came());
        let waited_for = self.arrivals.in_flight.row(missing).map(|row| row.place);
        self.arrivals.gap = false;
        self.arrivals.numbers.go_on(self.conversation.tally.packets_out, self.conversation.sequence);
        let (arrivals, mut taken) = (&mut self.arrivals, Ok(()));
        self.conversation.exchange(
            wait,
            || match waited_for {
                Some(RowPlace { row, frame, .. }) => format!("waiting for row {row} of frame {frame}"),
                None => "waiting for a row".to_owned(),
            },
            |packet| {
                if taken.is_ok() {
                    taken = arrivals.take(packet);
                }
            },
        )?;
        self.conversation.session.acknowledged = self.missing();
        self.conversation.tally.strays += std::mem::take(&mut self.arrivals.old_refusals);
        self.conversation.counted.note_had((self.came() - came).into());
        taken?;
        if self.missing() > missing {
            self.note_progress(missing);
        }
        self.note_copies();
        if self.arrivals.gap && self.attempts == 1 && self.most > 1 {
            // Rows come in order, so the missing one was made and got lost on the way back.
            return self.ask_again();
        }
        Ok(())
    }

    /// The row `missing`, which was waited for, has come.
    fn note_progress(&mut self, missing: u32) {
        let took = self.conversation.waited.saturating_sub(self.missing_since);
        self.conversation.note_duration(self.attempts - 1, took);
        self.late.came(missing, self.attempts - 1, took);
        self.attempts = 1;
        // A row that is asked for again is sent even without credit, so `missing` may pass `sent`.
        self.sent = self.sent.max(self.missing());
        self.go_on();
    }

    /// Takes the rows that came once more.
    fn note_copies(&mut self) {
        for row in std::mem::take(&mut self.arrivals.copies) {
            self.conversation.tally.strays += 1;
            if let Some(took) = self.late.came_again(row) {
                self.conversation.note_late(took);
                // An earlier copy is still being answered, and the missing row waits in the queue after it.
                self.progress_at = self.conversation.waited;
                self.attempts = self.attempts.min(2);
            }
        }
    }

    /// How long the oldest missing row may take: all rows in flight travel before it.
    fn patience(&self) -> Duration {
        let in_flight = (self.sent - self.missing()) as usize;
        let row = samples::packed_length(self.arrivals.in_flight.width()) + 64;
        let attempt = if self.most == 1 { PATIENT } else { self.attempts - 1 };
        self.conversation.wait_for(Step::Row, attempt, self.conversation.queued() + 2 * in_flight * row)
    }

    fn overdue(&self) -> bool {
        self.conversation.waited.saturating_sub(self.progress_at) >= self.patience()
    }

    fn ask_again(&mut self) -> Result<(), BoardError> {
        let missing = self.missing();
        let Some(place) = self.arrivals.in_flight.row(missing).map(|row| row.place) else { return Ok(()) };
        if self.attempts == self.most {
            return Err(BoardError::RowMissing { place, attempts: self.attempts });
        }
        self.attempts += 1;
        self.progress_at = self.conversation.waited;
        if self.conversation.queued() < QUEUE {
            tracing::info!("row {} of frame {} is missing; sending it again", place.row, place.frame);
            self.conversation.count_retry()?;
            self.send(missing);
            // A row leaves the core while its successor enters, so the successor may be the one that was lost.
            if missing + 1 < self.sent {
                self.send(missing + 1);
            }
        }
        Ok(())
    }
}
