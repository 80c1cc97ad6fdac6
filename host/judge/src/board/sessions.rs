//! Sessions: opening another one, greeting the board again in the open one, and requests in one that is not open.

use std::mem;

use halfrow_protocol::Kind;
use halfrow_protocol::message::{Hello, Refusal, RefusalCode, Request, ResetLevel, Welcome};

use super::answer::OwnedPacket;
use super::by_hand::{Response, said};
use super::counted::Counted;
use super::deadlines::Step;
use super::sent_requests::Outgoing;
use super::{
    Board, BoardError, OpenOptions, SessionIds, VERSION, WhenHeld, greet, greet_or_take_over, is_for,
};

impl Board {
    /// Number of the open session.
    pub(crate) fn session(&self) -> u8 {
        self.conversation.session.number
    }

    /// The sequence number of the last packet sent.
    pub(crate) fn sequence(&self) -> u16 {
        self.conversation.sequence
    }

    /// Opens another session over the same link, with a nonce that no earlier one had. Whatever is still under way from the
    /// earlier session is ignored. A host that has the board by now came later, and keeps it.
    ///
    /// # Errors
    /// [`BoardError`] like [`Self::open`].
    pub(crate) fn open_another_session(&mut self, nonce: u32) -> Result<(), BoardError> {
        self.open_by(nonce, WhenHeld::Leave)
    }

    /// The same after [`Self::take_over_as_another_host`]: this host takes the board back.
    ///
    /// # Errors
    /// Like [`Self::open_another_session`].
    pub(crate) fn take_back(&mut self, nonce: u32) -> Result<(), BoardError> {
        self.open_by(nonce, WhenHeld::Take)
    }

    fn open_by(&mut self, nonce: u32, when_held: WhenHeld) -> Result<(), BoardError> {
        (self.options.ids.nonce, self.options.when_held) = (nonce, when_held);
        self.conversation.leave_session();
        self.welcome = greet_or_take_over(&mut self.conversation, &self.options)?;
        Ok(())
    }

    /// Sends the greeting of the open session once more, and continues in the session that the board names in its reply.
    ///
    /// # Errors
    /// Like [`Self::open_another_session`].
    pub(crate) fn greet_again(&mut self) -> Result<Welcome, BoardError> {
        let options = OpenOptions { when_held: WhenHeld::Leave, ..self.options.clone() };
        let conversation = &mut self.conversation;
        let before = conversation.tally;
        // An answer in another session must be heard too.
        let welcome = conversation.under_session(0, |conversation| greet(conversation, &options))?;
        if welcome.session == conversation.session.number {
            let answered = conversation.answered;
            conversation.count_after(before.retries);
            conversation.answered = answered;
        } else {
            conversation.leave_session();
            conversation.session.number = welcome.session;
            let sent = conversation.tally.packets_out - before.packets_out;
            conversation.counted = Counted::in_new_session(conversation.tally, sent);
        }
        Ok(welcome)
    }

    /// Greets the board as another host that does not take over, and returns the board's answer. If the board opens a session for
    /// it, that session is closed.
    ///
    /// # Errors
    /// Like [`Self::ask`].
    pub(crate) fn greet_as_another_host(&mut self) -> Result<Response, BoardError> {
        // Of the holder alone it would be the open session's greeting once more.
        let hello = Hello { nonce: self.options.ids.nonce, ..self.hello_of_another_host() };
        self.greet_and_close(hello)
    }

    /// Greets the board as another host that takes it over, and returns the board's answer. The session stays open: nobody else
    /// may take the board before this host has it back.
    ///
    /// # Errors
    /// Like [`Self::ask`].
    pub(crate) fn take_over_as_another_host(&mut self) -> Result<Response, BoardError> {
        let hello = Hello { take_over: true, ..self.hello_of_another_host() };
        said(Kind::Hello, &self.greet_aside(hello)?)
    }

    fn hello_of_another_host(&self) -> Hello {
        Hello { host: !self.options.ids.host, ..self.hello_aside([VERSION; 2]) }
    }

    /// Greets the board as its holder, which wants another session and speaks these versions, from the least to the greatest.
    /// Returns the board's answer. If the board opens the session, it is closed.
    ///
    /// # Errors
    /// Like [`Self::ask`].
    pub(crate) fn greet_in_versions(&mut self, versions: [u8; 2]) -> Result<Response, BoardError> {
        let hello = self.hello_aside(versions);
        self.greet_and_close(hello)
    }

    /// The holder's greeting for another session than the open one.
    fn hello_aside(&self, [version_min, version_max]: [u8; 2]) -> Hello {
        let SessionIds { nonce, host, .. } = self.options.ids;
        Hello { nonce: !nonce, host, version_min, version_max, take_over: false }
    }

    fn greet_and_close(&mut self, hello: Hello) -> Result<Response, BoardError> {
        let answer = self.greet_aside(hello)?;
        if answer.header.kind == Kind::Hello.code() && answer.header.session != self.session() {
            self.close_foreign(answer.header.session);
        }
        said(Kind::Hello, &answer)
    }

    fn greet_aside(&mut self, hello: Hello) -> Result<OwnedPacket, BoardError> {
        self.conversation.queue_zeros(2);
        let request = Request::Hello(hello);
        let asking = Outgoing::Request(&request);
        self.conversation.under_session(0, |conversation| {
            conversation.ask(&asking, Step::Hello, |packet| is_for(packet, hello.nonce))
        })
    }

    fn close_foreign(&mut self, session: u8) {
        let reset = [ResetLevel::Session as u8, 0, 0, 0, 0];
        if let Err(error) = self.ask_in_session(session, Kind::Reset, &reset) {
            tracing::debug!("the session of another host was not closed: {error}");
        }
    }

    /// Closes the session, and continues as if it were open.
    ///
    /// # Errors
    /// [`BoardError`] when the board refuses or does not answer.
    pub(crate) fn close_session(&mut self) -> Result<(), BoardError> {
        match self.reset(ResetLevel::Session, Step::Request) {
            // The board's answer to a repeated RESET when the reply to the first was lost.
            Err(BoardError::SessionLost { .. }) => Ok(()),
            closed => closed,
        }
    }

    /// Sends a request of `kind` under the number of a `session` that is not open, and returns the board's answer.
    ///
    /// # Errors
    /// Like [`Self::ask`].
    pub(crate) fn ask_in_session(
        &mut self,
        session: u8,
        kind: Kind,
        payload: &[u8],
    ) -> Result<Response, BoardError> {
        let answer = self.conversation.under_session(session, |conversation| {
            // In a session that is not open the board's counters cannot be read.
            let counts = mem::take(&mut conversation.counts);
            let answer = conversation.ask(&Outgoing::Bytes(kind, payload), Step::Request, |_| true);
            conversation.counts = counts;
            answer
        });
        match answer.and_then(|answer| said(kind, &answer)) {
            Err(BoardError::SessionLost { .. }) => {
                Ok(Response::Refused(Refusal { code: RefusalCode::Session, kind: kind.code(), detail: 0 }))
            }
            said => said,
        }
    }
}
