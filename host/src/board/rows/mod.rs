//! Rows in flight: as many as the board gives credit for, each asked for until it has come back.

mod arrivals;
mod in_flight;
mod traffic;

use std::time::Duration;

use halfrow_protocol::message::Request;
use halfrow_protocol::samples;

use super::BoardError;
use super::conversation::Conversation;
use super::deadlines::Step;
use arrivals::Arrivals;

pub use traffic::{NumberedFrame, ReturnedRow, RowTraffic, Unjudged};

/// Bytes that may wait to be written before another row is packed. Two rows keep a link busy.
const QUEUE: usize = 8 * 1024;

/// Streams all frames of `traffic` through the board. Rows are numbered from `conversation.acknowledged` on.
pub(super) fn stream(
    conversation: &mut Conversation,
    traffic: &mut dyn RowTraffic,
) -> Result<(), BoardError> {
    let first_row = conversation.acknowledged;
    let mut stream = Stream {
        progress_at: conversation.waited,
        conversation,
        arrivals: Arrivals::new(traffic, first_row),
        exhausted: false,
        sent: first_row,
        attempts: 1,
        acknowledgement_sent: first_row,
    };
    stream.run()
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
    progress_at: Duration,
    acknowledgement_sent: u32,
}

impl Stream<'_> {
    fn run(&mut self) -> Result<(), BoardError> {
        self.fetch();
        self.progress_at = self.conversation.waited;
        while self.arrivals.flow.is_continue() && !self.is_complete() {
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
        self.exhausted && self.missing() == self.arrivals.in_flight.end()
    }

    /// The oldest row that has not come back.
    fn missing(&self) -> u32 {
        self.arrivals.missing
    }

    fn fetch(&mut self) {
        match self.arrivals.traffic.next_frame() {
            Some(frame) => self.arrivals.in_flight.add(frame),
            None => self.exhausted = true,
        }
    }

    /// Queues rows as far as credit and queue allow, or an acknowledgement when there is none to send.
    fn fill(&mut self) {
        while self.conversation.queued() < QUEUE && self.sent < self.conversation.credit {
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
        let Some(row) = self.arrivals.in_flight.row(row_sequence) else { return };
        self.conversation.queue_row(&row.place, row.frame.row(row.index));
        self.acknowledgement_sent = self.missing();
    }

    fn receive(&mut self) -> Result<(), BoardError> {
        let wait = self.patience().saturating_sub(self.conversation.waited - self.progress_at);
        let missing = self.missing();
        self.arrivals.gap = false;
        let (arrivals, mut taken) = (&mut self.arrivals, Ok(()));
        self.conversation.exchange(
            wait,
            || format!("waiting for row {missing} of the run"),
            |packet| {
                if taken.is_ok() {
                    taken = arrivals.take(packet);
                }
            },
        )?;
        self.conversation.acknowledged = self.missing();
        taken?;
        if self.missing() > missing {
            self.attempts = 1;
            self.progress_at = self.conversation.waited;
        }
        if self.arrivals.gap && self.attempts == 1 {
            // Rows come in order, so the missing one was made and got lost on the way.
            return self.ask_again();
        }
        Ok(())
    }

    /// How long the oldest missing row may take: all rows in flight travel before it.
    fn patience(&self) -> Duration {
        let in_flight = (self.sent - self.missing()) as usize;
        let row = samples::packed_length(self.arrivals.in_flight.width()) + 64;
        self.conversation.wait_for(Step::Row, self.conversation.queued() + 2 * in_flight * row)
    }

    fn overdue(&self) -> bool {
        self.conversation.waited - self.progress_at >= self.patience()
    }

    fn ask_again(&mut self) -> Result<(), BoardError> {
        let missing = self.missing();
        let Some(place) = self.arrivals.in_flight.row(missing).map(|row| row.place) else { return Ok(()) };
        if self.attempts == Step::Row.deadline().attempts {
            return Err(BoardError::RowMissing { place, attempts: self.attempts });
        }
        tracing::info!("row {} of frame {} is missing; sending it again", place.row, place.frame);
        self.conversation.count_retry()?;
        self.attempts += 1;
        self.progress_at = self.conversation.waited;
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
