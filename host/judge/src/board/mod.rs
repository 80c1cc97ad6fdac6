//! A board: whatever answers the protocol behind a link. Only this module sends and receives; the rules of a run write requests
//! by hand.

mod answer;
mod bursts;
mod by_hand;
mod conduct;
mod conversation;
mod counted;
mod counters;
pub mod deadlines;
mod error;
mod lateness;
mod legal;
mod nature;
mod open_options;
mod received;
mod retry_limit;
mod rows;
mod sent_requests;
mod session_ids;
mod sessions;
mod stop;
mod tables;
mod tally;

use std::fmt;
use std::time::Duration;

use halfrow_model::{Geometry, GridShape};
use halfrow_protocol::message::{Configuration, Hello, Reply, Request, Reset, ResetLevel};
use halfrow_protocol::{Packet, VERSION};

use answer::take_reply;
use conversation::Conversation;
use counted::Counted;
use deadlines::Step;
use sent_requests::Outgoing;

use crate::link::Link;
pub(crate) use bursts::{Fetched, Trapped};
pub(crate) use by_hand::{CameAgain, Response};
pub(crate) use conduct::Misconduct;
pub(crate) use counted::Miscount;
pub use error::{BoardError, OpenFailed};
pub use legal::MAX_LATENCY;
pub(crate) use legal::{LEAST_ENTRIES, frame_blanking, frame_clocks, grids, possible, row_blanking};
pub(crate) use nature::Shown;
pub use open_options::{OpenOptions, WhenHeld};
pub use received::{Had, Received};
pub use retry_limit::RetryLimit;
pub(crate) use rows::{Given, Unjudged, Unreturned};
pub use rows::{NumberedFrame, ReturnedRow, RowTraffic};
pub(crate) use sent_requests::LastRequest;
pub use session_ids::SessionIds;
pub use stop::Stop;
pub(crate) use tables::{ReadBack, TablePort};
pub use tally::Tally;

pub use halfrow_protocol::Kind;
pub use halfrow_protocol::message::{
    Bank, BoardNature, Bursts, Capabilities, ClockSource, Datapath, Depths, Grids, Malformed, Refusal,
    RefusalCode, RowPlace, Status, Table, UnknownDatapath, Welcome,
};

/// When the core is fed samples. The default is as soon as the board can take them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RowTiming {
    /// Pixel clocks between two rows. For a board that needs more they are as many as it needs.
    pub blanking: u16,
    /// Seed of the gaps in rows and between them; 0 for none.
    pub gap_seed: u32,
}

/// An open session with a board. If dropped without [`Board::close`] it holds the board for 10 s; [`Board::with`] closes it.
#[must_use = "a board whose session is not closed is held for 10 s"]
pub struct Board {
    conversation: Conversation,
    pub(crate) welcome: Welcome,
    pub(crate) capabilities: Capabilities,
    /// How the session was opened, and how the next one will be.
    options: OpenOptions,
    /// The table shape of the last commit, and that of the other bank.
    shapes: [Option<GridShape>; 2],
}

impl fmt::Debug for Board {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { welcome, capabilities, .. } = self;
        f.debug_struct("Board")
            .field("welcome", welcome)
            .field("capabilities", capabilities)
            .finish_non_exhaustive()
    }
}

impl Board {
    /// Opens a session over `link`, runs `act` in it, and closes it whatever the outcome, so that the next host finds the board
    /// free.
    ///
    /// # Errors
    /// Like [`Self::open`].
    pub fn with<T>(
        link: Box<dyn Link>,
        options: &OpenOptions,
        act: impl FnOnce(&mut Self) -> T,
    ) -> Result<T, OpenFailed> {
        let mut board = Self::open(link, options)?;
        let done = act(&mut board);
        board.close();
        Ok(done)
    }

    /// Opens a session over `link`. It stays open until [`Self::close`].
    ///
    /// # Errors
    /// [`OpenFailed`]: nothing answers, it is no halfrow board, it claims impossible capabilities, it speaks another version, or
    /// another host holds it.
    pub fn open(link: Box<dyn Link>, options: &OpenOptions) -> Result<Self, OpenFailed> {
        let mut board = Self::open_any(link, options)?;
        possible(&board.capabilities).map_err(|error| {
            let failed = OpenFailed::of(error, &board.conversation);
            board.close();
            failed
        })?;
        Ok(board)
    }

    /// Like [`Self::open`], whatever capabilities the board claims.
    pub(crate) fn open_any(link: Box<dyn Link>, options: &OpenOptions) -> Result<Self, OpenFailed> {
        let mut conversation = Conversation::new(link, options);
        let welcome = match greet_or_take_over(&mut conversation, options) {
            Ok(welcome) => welcome,
            Err(error) => return Err(OpenFailed::of(error, &conversation)),
        };
        let capabilities = conversation.request(&Request::Capabilities, Step::Request, |reply| match reply {
            Reply::Capabilities(capabilities) => Some(capabilities),
            _ => None,
        });
        match capabilities {
            Ok(capabilities) => {
                let (options, shapes) = (options.clone(), [None; 2]);
                Ok(Self { conversation, welcome, capabilities, options, shapes })
            }
            Err(error) => {
                let failed = OpenFailed::of(error, &conversation);
                close(&mut conversation);
                Err(failed)
            }
        }
    }

    /// The board's reply to HELLO.
    #[must_use]
    pub fn welcome(&self) -> &Welcome {
        &self.welcome
    }

    /// The board's capabilities.
    #[must_use]
    pub fn capabilities(&self) -> &Capabilities {
        &self.capabilities
    }

    /// What the board did in this session that no link can have caused.
    #[must_use]
    pub(crate) fn misconduct(&self) -> Option<&Misconduct> {
        self.conversation.session.conduct.misconduct()
    }

    /// How many requests that change the board reached it more than once in this session, as far as can be seen. A second copy
    /// may have arrived late, after other requests; then the board is not in the state that the host assumes.
    #[must_use]
    pub(crate) fn repeated_changes(&self) -> u64 {
        self.conversation.session.repeated_changes + self.conversation.session.doubled_changes
    }

    /// The row sequence number before which every row has come back.
    #[must_use]
    pub fn acknowledged(&self) -> u32 {
        self.conversation.session.acknowledged
    }

    /// What went over the link so far.
    #[must_use]
    pub fn tally(&self) -> Tally {
        self.conversation.tally
    }

    /// The time on the link's clock.
    #[must_use]
    pub fn now(&self) -> Duration {
        self.conversation.now()
    }

    /// When the last packet came from the board, on the link's clock.
    #[must_use]
    pub(crate) fn heard_at(&self) -> Duration {
        self.conversation.heard_at
    }

    /// The bytes a second that the link carries, if known.
    #[must_use]
    pub fn bytes_per_second(&self) -> Option<f64> {
        self.conversation.bytes_per_second()
    }

    /// The link's name, for people.
    #[must_use]
    pub(crate) fn link_name(&self) -> String {
        self.conversation.link_name()
    }

    /// Closes the link without telling the board, as if the board were gone. Everything after that fails.
    pub(crate) fn hang_up(&mut self) {
        self.conversation.hang_up();
    }

    /// Sends `bytes`. Returns whether they came back unchanged, and how long that took on the link's clock.
    ///
    /// # Errors
    /// [`BoardError`] when no answer comes.
    pub(crate) fn echo(&mut self, bytes: &[u8]) -> Result<(bool, Duration), BoardError> {
        let begun = self.now();
        let same = self.conversation.request(&Request::Echo(bytes), Step::Request, |reply| match reply {
            Reply::Echo(back) => Some(back == bytes),
            _ => None,
        })?;
        Ok((same, self.conversation.since(begun)))
    }

    /// Sets geometry and timing, for rows that `datapath` corrects. If different tables take turns, it is [`Datapath::Grids`] as
    /// soon as one of them is a grid, whose rows may have to be further apart.
    ///
    /// # Errors
    /// [`BoardError`] when the board refuses or does not answer.
    pub fn configure(
        &mut self,
        geometry: &Geometry,
        timing: RowTiming,
        datapath: Datapath,
    ) -> Result<(), BoardError> {
        let least = row_blanking(&self.capabilities, geometry.width(), datapath);
        let configure = Request::Configure(Configuration {
            width: geometry.width() as u16,
            height: geometry.height() as u16,
            centre2: geometry.centre2() as u16,
            blanking: timing.blanking.max(least),
            gap_seed: timing.gap_seed,
            bits: geometry.depth().bits() as u8,
        });
        self.conversation
            .request(&configure, Step::Request, |reply| matches!(reply, Reply::Configure).then_some(()))
    }

    /// Streams frames, and hands over every row that comes back.
    ///
    /// # Errors
    /// [`BoardError`]; rows that came back before it have been handed over.
    pub fn stream(&mut self, traffic: &mut dyn RowTraffic) -> Result<(), BoardError> {
        rows::stream(&mut self.conversation, traffic, Given::default())
    }

    /// Streams frames without ever asking for a row again. Returns the first row that does not come back within its deadline.
    ///
    /// # Errors
    /// Any other [`BoardError`].
    pub(crate) fn stream_once(
        &mut self,
        traffic: &mut dyn RowTraffic,
    ) -> Result<Option<Unreturned>, BoardError> {
        rows::stream_once(&mut self.conversation, traffic)
    }

    /// Drops the rows inside the board, so that another stream can begin.
    ///
    /// # Errors
    /// [`BoardError`] when the board does not answer.
    pub(crate) fn drop_rows(&mut self) -> Result<(), BoardError> {
        self.reset(ResetLevel::Rows, Step::Request)
    }

    /// Closes the session, also when the run was stopped, so that another host finds the board free. Waits a limited time for the
    /// board's answer: a board that does not answer is free after 10 s of silence.
    pub fn close(&mut self) {
        close(&mut self.conversation);
    }

    fn reset(&mut self, level: ResetLevel, step: Step) -> Result<(), BoardError> {
        // Beyond every row that can be under way: credit is never further ahead than the board has banks.
        let next_row = self.conversation.credit();
        reset_to(&mut self.conversation, Reset { level, next_row }, step)?;
        if level == ResetLevel::Tables {
            self.shapes = [None; 2];
        }
        Ok(())
    }
}

/// Returns the window in the board's answer.
fn reset_to(conversation: &mut Conversation, reset: Reset, step: Step) -> Result<u32, BoardError> {
    let request = Request::Reset(reset);
    let answer = conversation.ask(&Outgoing::Request(&request), step, |_| true)?;
    take_reply(Kind::Reset, &answer, |reply| matches!(reply, Reply::Reset).then_some(()))?;
    conversation.session.acknowledged = reset.next_row;
    Ok(answer.header.window)
}

fn close(conversation: &mut Conversation) {
    let reset = Reset { level: ResetLevel::Session, next_row: conversation.credit() };
    match conversation.disregarding_stop(|conversation| reset_to(conversation, reset, Step::Close)) {
        // The board answers a repeated RESET so when the reply to the first was lost: the session is closed.
        Ok(_) | Err(BoardError::SessionLost { .. }) => {}
        Err(error) => tracing::debug!("the session was not closed: {error}"),
    }
}

/// Opens a session.
fn greet_or_take_over(conversation: &mut Conversation, options: &OpenOptions) -> Result<Welcome, BoardError> {
    let sent = conversation.tally.packets_out;
    let takes_from_killed = options.when_held == WhenHeld::TakeFromKilled && conversation.is_exclusive();
    let greeted = match greet(conversation, options) {
        Err(BoardError::Held { .. }) if takes_from_killed => {
            tracing::warn!("the board is held by a run that was killed, and is taken over");
            greet(conversation, &OpenOptions { when_held: WhenHeld::Take, ..options.clone() })
        }
        greeted => greeted,
    };
    greeted.inspect(|welcome| {
        conversation.session.number = welcome.session;
        let tally = conversation.tally;
        conversation.counted = Counted::in_new_session(tally, tally.packets_out - sent);
    })
}

fn greet(conversation: &mut Conversation, options: &OpenOptions) -> Result<Welcome, BoardError> {
    let hello = Hello {
        nonce: options.ids.nonce,
        host: options.ids.host,
        version_min: VERSION,
        version_max: VERSION,
        take_over: options.when_held == WhenHeld::Take,
    };
    conversation.queue_zeros(2);
    let request = Request::Hello(hello);
    let asking = Outgoing::Request(&request);
    let answer = conversation.ask(&asking, Step::Hello, |packet| is_for(packet, hello.nonce))?;
    let welcome = take_reply(Kind::Hello, &answer, |reply| match reply {
        Reply::Hello(welcome) => Some(welcome),
        _ => None,
    });
    match welcome.map_err(|error| not_greeted(error, hello.take_over))? {
        welcome @ Welcome { version: VERSION, session: 1.., .. } => Ok(welcome),
        Welcome { version: VERSION, .. } => Err(BoardError::NotABoard),
        Welcome { version, .. } => Err(BoardError::Version { board: version.into(), ours: VERSION }),
    }
}

/// Whether `packet`, whose sequence number is that of a HELLO with this nonce, answers that HELLO. A packet of an earlier session
/// may have the same number.
fn is_for(packet: &Packet<'_>, nonce: u32) -> bool {
    match Reply::read(packet) {
        Ok(Reply::Refusal(refusal)) => refusal.kind == Kind::Hello.code(),
        // The nonce comes first, even if the rest makes no sense.
        _ => packet.header.kind == Kind::Hello.code() && packet.payload.starts_with(&nonce.to_le_bytes()),
    }
}

/// What an error means that came in place of the reply to a HELLO that `takes_over`.
fn not_greeted(error: BoardError, takes_over: bool) -> BoardError {
    match error {
        BoardError::Refused { refusal, .. } if refusal.code == RefusalCode::Held => {
            let seconds = f64::from(refusal.detail) / 10.0;
            if takes_over { BoardError::NotGivenUp { seconds } } else { BoardError::Held { seconds } }
        }
        BoardError::Refused { refusal, .. } if refusal.code == RefusalCode::Version => {
            BoardError::Version { board: refusal.detail, ours: VERSION }
        }
        BoardError::Malformed { .. } | BoardError::Unexpected { .. } => BoardError::NotABoard,
        other => other,
    }
}
