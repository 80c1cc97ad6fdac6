//! Requests, and waiting for their answers.

use std::time::Duration;

use halfrow_protocol::message::{Reply, Request};
use halfrow_protocol::{Kind, Packet};

use super::Conversation;
use super::retry::{Next, Retry};
use super::unclosed::Unclosed;
use crate::board::BoardError;
use crate::board::answer::{OwnedPacket, take_reply};
use crate::board::deadlines::Step;
use crate::board::sent_requests::{LastRequest, Outgoing};

impl Conversation {
    /// Asks until a reply comes that `accept` takes.
    pub(in crate::board) fn ask(
        &mut self,
        asking: &Outgoing<'_>,
        step: Step,
        accept: impl Fn(&Packet<'_>) -> bool,
    ) -> Result<OwnedPacket, BoardError> {
        let retries = self.tally.retries;
        let answer = self.ask_until_answered(asking, step, accept);
        let last = LastRequest { kind: asking.kind(), sequence: self.sequence, payload: asking.payload() };
        let answer = match answer {
            Ok(answer) => answer,
            Err(error) => {
                let error = self.looked_into(error, asking);
                self.last = last;
                return Err(error);
            }
        };
        self.counted.note_had(1);
        if step == Step::Request && asking.kind() != Kind::Status {
            self.count_after(retries);
            self.count_doubled();
        }
        (self.answered, self.last) = (answer.header, last);
        Ok(answer)
    }

    pub(super) fn ask_until_answered(
        &mut self,
        asking: &Outgoing<'_>,
        step: Step,
        accept: impl Fn(&Packet<'_>) -> bool,
    ) -> Result<OwnedPacket, BoardError> {
        let (kind, sequence, begun) = (asking.kind(), self.next_sequence(), self.now());
        let silent = begun.saturating_sub(self.sent_at);
        let attempts = step.deadline().attempts;
        self.session.asked.note_request(asking, sequence, begun);
        let (mut retry, mut bytes) = (Retry::new(attempts), 0);
        loop {
            match retry.next(self.waited) {
                Next::Send => {
                    // While something waits to be taken by the link, the board cannot have the request.
                    if retry.attempt() == 0 || self.queued() == 0 {
                        self.send(asking, sequence, retry.attempt())?;
                    }
                    // The reply may be as long as the longest packet, or follow one of an earlier session.
                    bytes = self.queued() + halfrow_protocol::MAX_PACKET;
                }
                Next::Wait(wait) => {
                    let late = self.tally.late;
                    if let Some(answer) = self.answer_within(wait, asking, sequence, &accept)? {
                        self.note_answer(&answer, kind, retry.attempt(), begun);
                        return Ok(OwnedPacket { silent, ..answer });
                    }
                    if self.tally.late == late {
                        continue;
                    }
                    retry.begin_anew();
                }
                Next::GiveUp => {
                    let (waited, heard) = (self.since(begun), self.heard());
                    return Err(BoardError::NoAnswer { kind, attempts, waited, heard });
                }
            }
            retry.wait_until(self.waited + self.wait_for(step, retry.attempt(), bytes));
        }
    }

    /// Sends `asking`, which was sent `again` times before.
    fn send(&mut self, asking: &Outgoing<'_>, sequence: u16, again: u32) -> Result<(), BoardError> {
        if again > 0 {
            self.note_unclosed()?;
            tracing::info!("{} was not answered; asking again", asking.kind());
            self.session.repeated_changes += u64::from(self.session.asked.note_repeat());
            self.count_retry()?;
        }
        self.queue_packet(asking.kind(), sequence, |payload| asking.write(payload));
        Ok(())
    }

    /// Notes the answer to a request of `kind` that was sent at `begun` and tried `again` times more.
    fn note_answer(&mut self, answer: &OwnedPacket, kind: Kind, again: u32, begun: Duration) {
        self.note_duration(again, self.since(begun));
        if again == 0 {
            self.unclosed = Unclosed::default();
        }
        let is_reply = answer.header.kind == kind.code();
        self.tally.answered += u64::from(is_reply);
        self.refused += u64::from(!is_reply);
    }

    /// Moves bytes once, and returns the answer if it is among them.
    fn answer_within(
        &mut self,
        wait: Duration,
        asking: &Outgoing<'_>,
        sequence: u16,
        accept: impl Fn(&Packet<'_>) -> bool,
    ) -> Result<Option<OwnedPacket>, BoardError> {
        let (mut answer, mut rows) = (None, 0);
        let doing = || format!("waiting for the answer to {}", asking.kind());
        self.exchange(wait, doing, |packet| {
            let header = packet.header;
            // Rows carry the board's own numbers.
            let is_row = header.kind == Kind::RowOut.code();
            rows += u64::from(is_row);
            if !is_row && header.sequence == sequence && accept(packet) {
                answer.get_or_insert_with(|| OwnedPacket {
                    header,
                    payload: packet.payload.to_vec(),
                    silent: Duration::ZERO,
                });
            }
        })?;
        let unwanted = rows.min(self.session.unwanted.into());
        self.session.unwanted -= unwanted as u32;
        self.tally.strays += rows - unwanted;
        let sent = self.header(asking.kind(), sequence);
        match answer {
            Some(answer) if answer.is_echo_of(&sent, asking) => Err(self.echoed()?),
            answer => Ok(answer),
        }
    }

    /// Notes how long something took to come that was asked for `again` more times.
    pub(in crate::board) fn note_duration(&mut self, again: u32, time: Duration) {
        self.lateness.note_duration(again, time);
    }

    /// Asks, and takes the expected part of the reply.
    pub(in crate::board) fn request<T>(
        &mut self,
        request: &Request<'_>,
        step: Step,
        take: impl FnOnce(Reply<'_>) -> Option<T>,
    ) -> Result<T, BoardError> {
        let answer = self.ask(&Outgoing::Request(request), step, |_| true)?;
        take_reply(request.kind(), &answer, take)
    }
}
