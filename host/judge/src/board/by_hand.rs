//! A board by hand: what the rules of a run send, in any form, and the answers as they come. So do those who look for a lost row or
//! try a window.

use std::iter;
use std::time::Duration;

use halfrow_protocol::message::{
    Burst, Refusal, RefusalCode, Reply, Request, Reset, ResetLevel, RowPlace, Status,
};
use halfrow_protocol::{Header, Kind, Packet, samples};

use super::answer::{OwnedPacket, status_in, take_reply};
use super::deadlines::Step;
use super::sent_requests::{LastRequest, Outgoing};
use super::{Board, BoardError, Given, ReturnedRow, RowTraffic, reset_to, rows};

/// The board's answer to a request.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Response {
    /// It refused.
    Refused(Refusal),
    /// It replied with this payload.
    Replied(Vec<u8>),
}

impl Response {
    /// The content of a packet that is not a row.
    pub(super) fn of(packet: &Packet<'_>) -> Self {
        match Reply::read(packet) {
            Ok(Reply::Refusal(refusal)) => Self::Refused(refusal),
            _ => Self::Replied(packet.payload.to_vec()),
        }
    }
}

/// A row that came again.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct CameAgain {
    /// How often it was sent before, by the board's count.
    pub(crate) repeats: u16,
    /// The generation of the tables that made it.
    pub(crate) generation: u8,
    /// Its samples.
    pub(crate) samples: Vec<u16>,
    /// Its latencies and pauses.
    pub(crate) clocks: [u16; 3],
    /// The CRC-32 of the row as it entered the core, if the board reports it.
    pub(crate) entered: Option<u32>,
}

impl CameAgain {
    /// The same as a row that belongs at `place`.
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

/// The row in `packet`, if it has the number of the one at `place` and was sent before at least `repeats` times.
///
/// # Errors
/// [`BoardError::WrongPlace`] when it names another place.
fn came_again(packet: &Packet<'_>, place: &RowPlace, repeats: u16) -> Option<Result<CameAgain, BoardError>> {
    let Ok(Reply::RowOut(row)) = Reply::read(packet) else { return None };
    if row.place.row_sequence != place.row_sequence || row.repeats < repeats {
        return None;
    }
    if row.place != *place {
        return Some(Err(BoardError::WrongPlace { place: row.place }));
    }
    let mut samples = vec![0; row.place.width.into()];
    samples::unpack(row.packed, &mut samples);
    Some(Ok(CameAgain {
        repeats: row.repeats,
        generation: row.generation,
        samples,
        clocks: [row.first_latency, row.last_latency, row.pauses],
        entered: row.entered,
    }))
}

/// Whether `packet` says that the board no longer knows the session.
fn is_of_no_session(packet: &Packet<'_>) -> bool {
    matches!(Reply::read(packet), Ok(Reply::Refusal(refusal)) if refusal.code == RefusalCode::Session)
}

/// The meaning of `answer` to a request of `kind`.
pub(super) fn said(kind: Kind, answer: &OwnedPacket) -> Result<Response, BoardError> {
    let packet = answer.packet();
    // The caller compares the payload byte by byte.
    if packet.header.kind == kind.code() && kind != Kind::Refusal {
        return Ok(Response::Replied(packet.payload.to_vec()));
    }
    match take_reply(kind, answer, |_| None) {
        Err(BoardError::Refused { refusal, .. }) => Ok(Response::Refused(refusal)),
        said => said,
    }
}

impl Board {
    /// Sends a request of `kind` with any payload, and returns the board's answer.
    ///
    /// # Errors
    /// [`BoardError`] when it does not answer, or its answer does not fit the kind.
    pub(crate) fn ask(&mut self, kind: Kind, payload: &[u8]) -> Result<Response, BoardError> {
        let answer = self.conversation.ask(&Outgoing::Bytes(kind, payload), Step::Request, |_| true)?;
        said(kind, &answer)
    }

    /// The header of the board's last answer.
    pub(crate) fn answered(&self) -> Header {
        self.conversation.answered
    }

    /// The last request that was waited for.
    pub(crate) fn last_request(&self) -> &LastRequest {
        &self.conversation.last
    }

    /// Sends a row without waiting, and returns the number of its packet.
    pub(crate) fn give(&mut self, place: &RowPlace, samples: &[u16]) -> u16 {
        self.conversation.queue_row(place, samples);
        self.conversation.sequence
    }

    /// Sends `request` damaged so that it is no longer a packet, without waiting: once per byte with a flipped bit in it, and
    /// once with every wrong version and length that differs in one bit. All copies have a number that no valid packet has.
    /// Returns how many of them have a wrong CRC, and how many are broken otherwise.
    pub(crate) fn give_damaged(&mut self, request: &Request<'_>) -> [u32; 2] {
        let number = self.conversation.next_sequence();
        self.conversation.session.conduct.await_answer(number);
        let from = self.conversation.queued();
        self.conversation.queue_damaged(request);
        self.conversation.queue_misnamed(request);
        self.conversation.damage_after(from)
    }

    /// The same with ROW_ACKs that acknowledge all rows before `row_sequence`.
    pub(crate) fn acknowledge_damaged(&mut self, row_sequence: u32) -> [u32; 2] {
        self.acknowledging(row_sequence, |board| board.give_damaged(&Request::RowAck))
    }

    /// Sends a request of `kind` with any payload, without waiting, and returns the number of its packet.
    pub(crate) fn give_bytes(&mut self, kind: Kind, payload: &[u8]) -> u16 {
        self.conversation.tell(&Outgoing::Bytes(kind, payload));
        self.conversation.sequence
    }

    /// Declares the requests that changed the board and reached it more than once to be `changes` in number: further ones cast no
    /// doubt on what was found.
    pub(crate) fn excuse_changes(&mut self, changes: u64) {
        self.conversation.session.repeated_changes =
            changes.saturating_sub(self.conversation.session.doubled_changes);
    }

    /// The board's answer to the damaged packets, if it gave one.
    pub(crate) fn answer_to_damaged(&self) -> Option<Response> {
        self.conversation.session.conduct.answer_to_damaged().cloned()
    }

    /// The requests that were answered, and the further answers to requests sent once.
    pub(crate) fn answers(&self) -> [u64; 2] {
        [self.conversation.tally.answered, self.conversation.session.second_answers]
    }

    /// ROW_OUT packets that came twice.
    pub(crate) fn rows_doubled(&self) -> u32 {
        self.conversation.session.conduct.doubled()
    }

    /// Forgets what reached the board or came back more often than it was sent: it is explained by now, and casts no doubt on
    /// what was found.
    ///
    /// # Errors
    /// [`BoardError`] when the board does not clear its counters.
    pub(crate) fn excuse_repeats(&mut self) -> Result<(), BoardError> {
        self.clear_counters()?;
        (self.conversation.session.repeated_changes, self.conversation.session.doubled_changes) = (0, 0);
        self.conversation.counted.wrong = None;
        Ok(())
    }

    /// Streams frames whose first rows were already `given`, and hands over every row that comes back.
    ///
    /// # Errors
    /// [`BoardError`]; rows that came back before it have been handed over.
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

    /// Drops the rows inside the board. Returns for how many rows the board then gives credit, from the one that it waits for on.
    ///
    /// # Errors
    /// [`BoardError`] when the board refuses or does not answer.
    pub(crate) fn credit_after_reset(&mut self) -> Result<u32, BoardError> {
        self.credit_after_reset_to(self.credit())
    }

    /// The same if the board then waits for row sequence number `next_row`, which may be smaller than any before. With a smaller
    /// one a session is good for no more rows.
    ///
    /// # Errors
    /// Like [`Self::credit_after_reset`].
    pub(crate) fn credit_after_reset_to(&mut self, next_row: u32) -> Result<u32, BoardError> {
        let reset = Reset { level: ResetLevel::Rows, next_row };
        let window = reset_to(&mut self.conversation, reset, Step::Request)?;
        Ok(window.saturating_sub(next_row))
    }

    /// The board's counters, and the window in the same answer.
    ///
    /// # Errors
    /// [`BoardError`] when no answer comes.
    pub(crate) fn status_and_window(&mut self) -> Result<(Status, u32), BoardError> {
        let request = Request::Status { clear: false };
        let answer = self.conversation.ask(&Outgoing::Request(&request), Step::Request, |_| true)?;
        Ok((status_in(&answer)?, answer.header.window))
    }

    /// Drops the rows inside the board, which then waits for a number that no row of the session has had. So whatever is still
    /// under way, no row enters before the answer. Returns for how many rows the board then gives credit.
    ///
    /// # Errors
    /// Like [`Self::credit_after_reset`].
    pub(crate) fn credit_for_new_rows(&mut self) -> Result<u32, BoardError> {
        self.credit_after_reset_to(self.credit().max(self.conversation.session.rows_sent))
    }

    /// Waits until `row`, which was given and is not acknowledged, comes with a count of at least `repeats`. It is asked for
    /// first if `repeats` is not 0. Each retry asks for it again, together with the row `after` it, which pushes it out of the
    /// core.
    ///
    /// # Errors
    /// [`BoardError`] when it does not come, or comes with another place.
    pub(crate) fn again(
        &mut self,
        row: (&RowPlace, &[u16]),
        after: Option<(&RowPlace, &[u16])>,
        repeats: u16,
    ) -> Result<CameAgain, BoardError> {
        let (attempts, place) = (Step::Row.deadline().attempts, row.0);
        for attempt in 0..attempts {
            if attempt > 0 {
                self.conversation.count_retry()?;
            }
            let asked = if attempt > 0 { 2 } else { repeats.min(1).into() };
            for (place, samples) in iter::once(row).chain(after).take(asked) {
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
                    Some(came) => return came,
                    None if is_lost => return Err(BoardError::SessionLost { silent: Duration::ZERO }),
                    None => {}
                }
            }
        }
        Err(BoardError::RowMissing { place: *place, attempts })
    }

    /// From now on packets acknowledge only the rows before `row_sequence`; with none, all that came back.
    pub(crate) fn acknowledge_to(&mut self, row_sequence: Option<u32>) {
        self.conversation.session.acknowledges_to = row_sequence;
    }

    /// Runs `act`, whose packets acknowledge all rows before `row_sequence`. Other packets acknowledge as before.
    fn acknowledging<T>(&mut self, row_sequence: u32, act: impl FnOnce(&mut Self) -> T) -> T {
        let before = self.conversation.session.acknowledges_to.replace(row_sequence);
        let done = act(self);
        self.conversation.session.acknowledges_to = before;
        done
    }

    /// Sends a ROW_ACK of all rows before `row_sequence`, with a byte that a board must skip.
    pub(crate) fn acknowledge_alone(&mut self, row_sequence: u32) {
        self.acknowledging(row_sequence, |board| board.give_bytes(Kind::RowAck, &[0]));
    }

    /// Sends a ROW_ACK without that byte under the number of a `session` that need not be open. This is not answered.
    pub(crate) fn acknowledge_in_session(&mut self, session: u8, row_sequence: u32) {
        self.acknowledging(row_sequence, |board| {
            board.conversation.under_session(session, |conversation| {
                let sequence = conversation.next_sequence();
                conversation.queue(&Request::RowAck, sequence);
            });
        });
    }

    /// Allows this many rows to come while something else is waited for.
    pub(crate) fn disregard_rows(&mut self, rows: u32) {
        self.conversation.session.unwanted = rows;
    }

    /// The ROW_OUT packets that came in this session. Each counts once, however often the link delivers it.
    pub(crate) fn rows_came(&self) -> u32 {
        self.conversation.session.conduct.rows_came()
    }

    /// The refusal of the row that was sent in the packet `number`, if that row is the last that was refused.
    pub(crate) fn refusal_of_row(&self, number: u16) -> Option<Refusal> {
        self.conversation.session.conduct.refused_row(number)
    }

    /// The row sequence number before which the board allows rows to be sent: the greatest that it named.
    pub(crate) fn window(&self) -> u32 {
        self.conversation.session.window
    }

    /// Counts all rows before `row_sequence` as returned.
    pub(crate) fn acknowledge(&mut self, row_sequence: u32) {
        self.conversation.session.acknowledged = row_sequence;
    }

    /// Starts `burst`. Drops it and all rows as soon as `bytes` bytes without meaning have followed it to the board.
    ///
    /// # Errors
    /// [`BoardError`] when the board refuses to drop it, or does not answer.
    pub(crate) fn cut(&mut self, burst: &Burst, bytes: usize) -> Result<(), BoardError> {
        self.conversation.tell(&Outgoing::Request(&Request::Burst(*burst)));
        self.drop_rows_after(bytes, 0)
    }

    /// Drops all rows as soon as `bytes` bytes without meaning have gone to the board. Before that, up to `given` rows may come
    /// back.
    ///
    /// # Errors
    /// [`BoardError`] when the board refuses, or does not answer.
    pub(crate) fn drop_rows_after(&mut self, bytes: usize, given: u32) -> Result<(), BoardError> {
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
