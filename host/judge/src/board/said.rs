//! Requests of any form, and what a board says to them: for whoever wants to know what it refuses.

use std::iter;

use halfrow_protocol::message::{Burst, Refusal, RefusalCode, Reply, Request, Reset, ResetLevel, RowPlace};
use halfrow_protocol::{Kind, Packet, samples};

use super::answer::{OwnedPacket, take_reply};
use super::asked::Asking;
use super::deadlines::Step;
use super::{Board, BoardError, Given, ReturnedRow, RowTraffic, rows};

/// What a board said to a request.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Said {
    /// It refused.
    Refused(Refusal),
    /// It replied with this payload.
    Replied(Vec<u8>),
}

impl Said {
    /// What a packet says that is no row.
    pub(super) fn of(packet: &Packet<'_>) -> Self {
        match Reply::read(packet) {
            Ok(Reply::Refusal(refusal)) => Self::Refused(refusal),
            _ => Self::Replied(packet.payload.to_vec()),
        }
    }
}

/// A row that came once more.
#[derive(Clone, Debug)]
pub(crate) struct CameAgain {
    /// How often it was sent before, as the board counts.
    pub(crate) repeats: u16,
    /// Of the tables that made it.
    pub(crate) generation: u8,
    /// Its samples.
    pub(crate) samples: Vec<u16>,
    /// Its latencies and pauses.
    pub(crate) clocks: [u16; 3],
    /// The CRC-32 of it as it entered, where the board is one that tells it.
    pub(crate) entered: Option<u32>,
}

impl CameAgain {
    /// It as a row that was at `place`.
    pub(crate) fn row(&self, place: &RowPlace) -> ReturnedRow<'_> {
        let [first_latency, last_latency, pauses] = self.clocks;
        ReturnedRow {
            frame: place.frame,
            row: place.row.into(),
            generation: self.generation,
            first_latency,
            last_latency,
            pauses,
            repeats: self.repeats,
            entered: self.entered,
            samples: &self.samples,
        }
    }
}

/// What `packet` says of the row at `place`, if it is one that was sent so many times before.
fn came_again(packet: &Packet<'_>, place: &RowPlace, repeats: u16) -> Option<CameAgain> {
    let Ok(Reply::RowOut(row)) = Reply::read(packet) else { return None };
    let mut samples = vec![0; row.place.width.into()];
    samples::unpack(row.packed, &mut samples);
    let came = CameAgain {
        repeats: row.repeats,
        generation: row.generation,
        samples,
        clocks: [row.first_latency, row.last_latency, row.pauses],
        entered: row.entered,
    };
    (row.place == *place && row.repeats >= repeats).then_some(came)
}

/// Whether `packet` says that the board no longer knows the session.
fn is_of_no_session(packet: &Packet<'_>) -> bool {
    matches!(Reply::read(packet), Ok(Reply::Refusal(refusal)) if refusal.code == RefusalCode::Session)
}

/// What `answer` says to a request of `kind`.
pub(super) fn said(kind: Kind, answer: &OwnedPacket) -> Result<Said, BoardError> {
    let packet = answer.packet();
    // What a reply says is looked at byte by byte by whoever asks.
    if packet.header.kind == kind.code() && kind != Kind::Refusal {
        return Ok(Said::Replied(packet.payload.to_vec()));
    }
    match take_reply(kind, answer, |_| None) {
        Err(BoardError::Refused { refusal, .. }) => Ok(Said::Refused(refusal)),
        said => said,
    }
}

impl Board {
    /// Sends a request of `kind` with any payload, and returns what the board says to it.
    ///
    /// # Errors
    /// [`BoardError`] when it says nothing, or nothing that its kind can say.
    pub(crate) fn ask(&mut self, kind: Kind, payload: &[u8]) -> Result<Said, BoardError> {
        let answer = self.conversation.ask(&Asking::Bytes(kind, payload), Step::Request, |_| true)?;
        said(kind, &answer)
    }

    /// Sends a row, waits for nothing, and returns the number of its packet.
    pub(crate) fn give(&mut self, place: &RowPlace, samples: &[u16]) -> u16 {
        self.conversation.queue_row(place, samples);
        self.conversation.sequence
    }

    /// Sends `request` so that it is none, and waits for nothing: damaged, in each way in which a link can flip a bit of one byte,
    /// and of another version or length. All of them have a number that no packet has. Returns how many of them have a wrong CRC,
    /// and how many are broken otherwise.
    pub(crate) fn give_damaged(&mut self, request: &Request<'_>) -> [u32; 2] {
        let number = self.conversation.next_sequence();
        self.conversation.session.conduct.await_answer(number);
        let from = self.conversation.queued();
        self.conversation.queue_damaged(request);
        self.conversation.queue_misnamed(request);
        self.conversation.damage_behind(from)
    }

    /// The same with ROW_ACKs of all rows before `row_sequence`.
    pub(crate) fn acknowledge_damaged(&mut self, row_sequence: u32) -> [u32; 2] {
        let before = self.conversation.session.acknowledges_to.replace(row_sequence);
        let damaged = self.give_damaged(&Request::RowAck);
        self.conversation.session.acknowledges_to = before;
        damaged
    }

    /// Sends a request of `kind` with any payload, and waits for nothing.
    pub(crate) fn give_bytes(&mut self, kind: Kind, payload: &[u8]) {
        self.conversation.tell(&Asking::Bytes(kind, payload));
    }

    /// Of the requests that changed the board and came to it more than once, those beyond so many cast no doubt on what was found.
    pub(crate) fn excuse_changes(&mut self, changes: u64) {
        self.conversation.session.repeated_changes =
            changes.saturating_sub(self.conversation.session.doubled_changes);
    }

    /// What the board answered those packets with, if it did.
    pub(crate) fn answer_to_damaged(&self) -> Option<Said> {
        self.conversation.session.conduct.answer_to_damaged().cloned()
    }

    /// Requests that were answered, and those that were answered once more though sent once.
    pub(crate) fn answers(&self) -> [u64; 2] {
        [self.conversation.tally.answered, self.conversation.session.second_answers]
    }

    /// ROW_OUT packets that came twice.
    pub(crate) fn rows_doubled(&self) -> u32 {
        self.conversation.session.conduct.doubled()
    }

    /// What came to the board and back more often than it was sent has its reason by now, and casts no doubt on what was found.
    ///
    /// # Errors
    /// [`BoardError`] when the board does not set its counters back.
    pub(crate) fn excuse_repeats(&mut self) -> Result<(), BoardError> {
        self.status(true)?;
        (self.conversation.session.repeated_changes, self.conversation.session.doubled_changes) = (0, 0);
        self.conversation.counted.wrong = None;
        Ok(())
    }

    /// Streams frames of which the first rows were `given`, and hands back every row.
    ///
    /// # Errors
    /// [`BoardError`]; rows that came back before it were handed over.
    pub(crate) fn stream_given(
        &mut self,
        given: Given,
        traffic: &mut dyn RowTraffic,
    ) -> Result<(), BoardError> {
        rows::stream(&mut self.conversation, traffic, given)
    }

    /// The row sequence number before which rows may be sent, as far as the board has said.
    #[must_use]
    pub(crate) fn credit(&self) -> u32 {
        self.conversation.credit()
    }

    /// Drops the rows inside the board, and returns for how many rows beyond the one that it waits for then it gives credit.
    ///
    /// # Errors
    /// [`BoardError`] when the board refuses or does not answer.
    pub(crate) fn credit_behind_reset(&mut self) -> Result<u32, BoardError> {
        let reset = Reset { level: ResetLevel::Rows, next_row: self.credit() };
        let request = Request::Reset(reset);
        let answer = self.conversation.ask(&Asking::Request(&request), Step::Request, |_| true)?;
        take_reply(Kind::Reset, &answer, |reply| matches!(reply, Reply::Reset).then_some(()))?;
        self.conversation.session.acknowledged = reset.next_row;
        Ok(answer.header.window.saturating_sub(reset.next_row))
    }

    /// Drops the rows inside the board, which then waits for row sequence number `next_row`, one that was not sent yet.
    ///
    /// # Errors
    /// [`BoardError`] when the board refuses or does not answer.
    pub(crate) fn go_on_from(&mut self, next_row: u32) -> Result<(), BoardError> {
        self.reset_to(Reset { level: ResetLevel::Rows, next_row }, Step::Request)
    }

    /// Waits for `row`, which was given and is not acknowledged, as it comes when it was sent `repeats` times before or more often. It
    /// is asked for again, first of all if that is not the first time, and then with the one `behind` it that pushes it out.
    ///
    /// # Errors
    /// [`BoardError`] when it does not come.
    pub(crate) fn again(
        &mut self,
        row: (&RowPlace, &[u16]),
        behind: Option<(&RowPlace, &[u16])>,
        repeats: u16,
    ) -> Result<CameAgain, BoardError> {
        let (attempts, place) = (Step::Row.deadline().attempts, row.0);
        for attempt in 0..attempts {
            let asked = if attempt > 0 { 2 } else { repeats.min(1).into() };
            for (place, samples) in iter::once(row).chain(behind).take(asked) {
                self.conversation.queue_row(place, samples);
            }
            let bytes = self.conversation.queued() + halfrow_protocol::MAX_PACKET;
            let deadline = self.conversation.waited + self.conversation.wait_for(Step::Row, attempt, bytes);
            while let Some(wait) =
                deadline.checked_sub(self.conversation.waited).filter(|wait| !wait.is_zero())
            {
                let (mut came, mut is_lost) = (None, false);
                let doing = || format!("waiting for row {} once more", place.row);
                self.conversation.exchange(wait, doing, |packet| {
                    came = came.take().or(came_again(packet, place, repeats));
                    is_lost |= is_of_no_session(packet);
                })?;
                match came {
                    Some(came) => return Ok(came),
                    None if is_lost => return Err(BoardError::SessionLost),
                    None => {}
                }
            }
            self.conversation.count_retry()?;
        }
        Err(BoardError::RowMissing { place: *place, attempts })
    }

    /// From now on packets acknowledge the rows before `row_sequence` alone, or all that came back if it is none.
    pub(crate) fn acknowledge_to(&mut self, row_sequence: Option<u32>) {
        self.conversation.session.acknowledges_to = row_sequence;
    }

    /// Sends a ROW_ACK of all rows before `row_sequence`, which no other packet acknowledges thereby.
    pub(crate) fn acknowledge_alone(&mut self, row_sequence: u32) {
        let before = self.conversation.session.acknowledges_to.replace(row_sequence);
        let sequence = self.conversation.next_sequence();
        self.conversation.queue(&Request::RowAck, sequence);
        self.conversation.session.acknowledges_to = before;
    }

    /// So many rows may come while something else is waited for.
    pub(crate) fn disregard_rows(&mut self, rows: u32) {
        self.conversation.session.unwanted = rows;
    }

    /// The ROW_OUT packets that came in this session, each counted once however often the link delivers it.
    pub(crate) fn rows_came(&self) -> u32 {
        self.conversation.session.conduct.came()
    }

    /// What the board refused the row with that was sent in the packet `number`, if that was the last that it refused.
    pub(crate) fn refusal_of_row(&self, number: u16) -> Option<Refusal> {
        self.conversation.session.conduct.refused_row(number)
    }

    /// The row sequence number before which the board lets rows be sent, the greatest that it said.
    pub(crate) fn window(&self) -> u32 {
        self.conversation.session.window
    }

    /// Counts all rows before `row_sequence` as come back.
    pub(crate) fn acknowledge(&mut self, row_sequence: u32) {
        self.conversation.session.acknowledged = row_sequence;
    }

    /// Starts `burst`, and drops it and all rows as soon as so many bytes without meaning have gone to the board behind it.
    ///
    /// # Errors
    /// [`BoardError`] when the board refuses to drop it, or does not answer.
    pub(crate) fn cut(&mut self, burst: &Burst, bytes: usize) -> Result<(), BoardError> {
        self.conversation.tell(&Asking::Request(&Request::Burst(*burst)));
        self.drop_rows_behind(bytes, 0)
    }

    /// Drops all rows as soon as so many bytes without meaning have gone to the board. So many of those that it was given may come
    /// back before.
    ///
    /// # Errors
    /// [`BoardError`] when the board refuses, or does not answer.
    pub(crate) fn drop_rows_behind(&mut self, bytes: usize, given: u32) -> Result<(), BoardError> {
        self.conversation.session.unwanted = given;
        self.conversation.queue_zeros(bytes);
        let dropped = self.drop_rows();
        self.conversation.session.unwanted = 0;
        dropped
    }

    /// Drops rows, configuration and tables.
    ///
    /// # Errors
    /// [`BoardError`] when the board refuses or does not answer.
    pub(crate) fn forget(&mut self) -> Result<(), BoardError> {
        self.reset(ResetLevel::Tables, Step::Request)
    }
}
