//! What a link can do, whatever the board at its other end computes: errors, round trips, throughput.
//!
//! A board answers one request at a time. So each direction alone is measured with full packets and short answers, including the
//! turnaround. Both directions together are measured as a run uses them: with rows, as far as the board gives credit.

mod figures;
mod rows;
mod times;

use std::time::{Duration, Instant};

use halfrow_protocol::MAX_PAYLOAD;
use halfrow_protocol::message::ROW_FACTOR_BYTES;
use rand_core::Rng;
use rand_pcg::Pcg64Mcg;

use crate::board::{Bank, Board, BoardError, RetryLimit, Table, TablePort, Tally};
use crate::result::Problem;
use crate::words::{count, grouped};

pub use figures::{Errors, Figures, Rate, RoundTrips, Throughput};
use times::Times;

/// A link test that did not come to an end.
#[derive(Debug, thiserror::Error)]
pub enum LinkTestError {
    /// The board could not be driven.
    #[error(transparent)]
    Board(#[from] BoardError),
    /// The board could not be driven to the end, and had answered with other bytes than were sent by then. Nothing damaged those
    /// answers after the board or its link chip had made their CRC.
    #[error(
        "the link test broke off after {} had held other bytes than were sent, with a right CRC",
        count(*.wrong, "answer")
    )]
    BrokeOff {
        /// How many answers were wrong.
        wrong: u64,
        /// What broke it off.
        source: BoardError,
    },
    /// The test broke off over a link that had damaged packets, or lost others than the one that never came.
    #[error(
        "the link test broke off, with {} damaged and {} sent again by then; check cable, connectors and rate",
        count(.errors.damaged(), "packet"),
        grouped(.errors.retries)
    )]
    PoorLink {
        /// The link's name, for people.
        link: String,
        /// The errors of all parts until then.
        errors: Box<Errors>,
        /// What broke it off, without what that asks for: such a link explains it.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// The board's capabilities leave no frame that could be streamed to it.
    #[error("the board takes no frame that could be streamed; check its capabilities with `halfrow info`")]
    NoFrame(#[source] Box<dyn std::error::Error + Send + Sync>),
}

/// How many parts a test has: round trips, echoes, to the board, to the host, both ways at once.
pub const PARTS: u32 = 5;

/// Tests the link to `board`. Each of its [`PARTS`] parts takes `seconds`, by the link's clock or the wall's, whichever
/// ends first; the last part streams no more than 1000 frames of 64 rows in that time. What is sent is drawn with `seed`. The board loses its
/// tables and configuration.
///
/// # Errors
/// [`LinkTestError`] when the board stops answering, or the link is too poor.
pub fn run(board: &mut Board, seconds: Duration, seed: u64) -> Result<Figures, LinkTestError> {
    board.start_afresh()?;
    let (before, random) = (board.tally(), Pcg64Mcg::new(u128::from(seed) | 1 << 64));
    let mut test = Test { board, before, damaged_before: 0, seconds, random, wrong: 0, begun: 0 };
    test.figures().map_err(|error| match error {
        LinkTestError::Board(source) if test.wrong > 0 => {
            LinkTestError::BrokeOff { wrong: test.wrong, source }
        }
        LinkTestError::Board(
            source @ (BoardError::NoAnswer { .. }
            | BoardError::DamagedEachTime { .. }
            | BoardError::RowMissing { .. }),
        ) => test.broken_off(source),
        error => error,
    })
}

struct Test<'a> {
    board: &'a mut Board,
    before: Tally,
    /// Packets that reached the board damaged in an earlier session of the test.
    damaged_before: u64,
    seconds: Duration,
    random: Pcg64Mcg,
    /// Answers so far that held other bytes than were sent.
    wrong: u64,
    /// Parts that have begun.
    begun: u32,
}

/// When a part of the test began.
struct Begun {
    on_link: Duration,
    on_wall: Instant,
    tally: Tally,
}

impl Test<'_> {
    fn figures(&mut self) -> Result<Figures, LinkTestError> {
        let round_trips = self.round_trips()?;
        self.echoes()?;
        let to_board = self.outward()?;
        let damaged = self.damaged_out()?;
        // A late copy of what was written would make the tables of a sound board wrong from then on.
        self.board.open_another_session(self.board.welcome.nonce.wrapping_add(1))?;
        self.damaged_before = damaged;
        let to_host = self.inward()?;
        let together = self.together()?;
        let damaged = self.damaged_out()?;
        let errors = self.errors(damaged);
        let limit = self.board.bytes_per_second();
        debug_assert_eq!(self.begun, PARTS, "who waits for a test counts on it");
        Ok(Figures { link: self.board.link_name(), limit, errors, round_trips, to_board, to_host, together })
    }

    /// The errors so far, with the packets that the board counts as damaged in this session.
    fn errors(&self, damaged_out: u64) -> Errors {
        let damaged_out = self.damaged_before + damaged_out;
        Errors::between(self.before, self.board.tally(), damaged_out, self.wrong)
    }

    /// Why the test broke off when `source` came: a link that loses packets explains that something never came. Of a board that then
    /// answers nothing at all, only what came damaged is a matter of the link.
    fn broken_off(&mut self, source: BoardError) -> LinkTestError {
        let (damaged_out, most_lost) = match self.damaged_out() {
            // What never came was itself sent again, less often than that.
            Ok(damaged_out) => (damaged_out, RetryLimit::default().fixed),
            Err(why @ (BoardError::Stopped(_) | BoardError::Link { .. })) => return why.into(),
            Err(_) => (0, u64::MAX),
        };
        let errors = self.errors(damaged_out);
        if errors.damaged() == 0 && errors.lost() <= most_lost {
            return source.into();
        }
        LinkTestError::PoorLink {
            link: self.board.link_name(),
            errors: errors.into(),
            source: Problem::of(&source).unasked().into(),
        }
    }

    /// Begins one of the [`PARTS`].
    fn begin_part(&mut self) -> Begun {
        self.begun += 1;
        self.begin()
    }

    fn begin(&self) -> Begun {
        Begun { on_link: self.board.now(), on_wall: Instant::now(), tally: self.board.tally() }
    }

    /// The time on the link's clock; zero if that went back.
    fn since(&self, begun: &Begun) -> Duration {
        self.board.now().saturating_sub(begun.on_link)
    }

    /// Whether the part's time is over, by either clock: a virtual clock may stand still.
    fn is_over(&self, begun: &Begun) -> bool {
        self.since(begun) >= self.seconds || begun.on_wall.elapsed() >= self.seconds
    }

    fn throughput(&self, begun: &Begun) -> Throughput {
        Throughput::between(begun.tally, self.board.tally(), self.since(begun), self.board.bytes_per_second())
    }

    /// Packets that reached the board damaged in this session.
    fn damaged_out(&mut self) -> Result<u64, BoardError> {
        Ok(self.board.status()?.damaged().into())
    }

    fn round_trips(&mut self) -> Result<RoundTrips, BoardError> {
        let begun = self.begin_part();
        let mut times = Times::beginning(self.board.echo(&[])?.1);
        while !self.is_over(&begun) {
            times.add(self.board.echo(&[])?.1);
        }
        Ok(times.round_trips())
    }

    /// Sends random bytes of random length there and back, and counts the echoes that differ.
    fn echoes(&mut self) -> Result<(), BoardError> {
        let begun = self.begin_part();
        loop {
            let mut bytes = vec![0; self.random.next_u32() as usize % (MAX_PAYLOAD + 1)];
            self.random.fill_bytes(&mut bytes);
            self.wrong += u64::from(!self.board.echo(&bytes)?.0);
            if self.is_over(&begun) {
                return Ok(());
            }
        }
    }

    /// Writes random row factors; no frame is streamed with them.
    fn outward(&mut self) -> Result<Throughput, BoardError> {
        let begun = self.begin_part();
        while !self.is_over(&begun) {
            let entries = self.entries();
            self.board.write(Table::RowFactors, &entries)?;
        }
        Ok(self.throughput(&begun))
    }

    /// Reads row factors back, and counts the packets that differ from what was written.
    fn inward(&mut self) -> Result<Throughput, BoardError> {
        let entries = self.entries();
        self.board.write(Table::RowFactors, &entries)?;
        let begun = self.begin_part();
        let port = TablePort { table: Table::RowFactors, port: 0 };
        while !self.is_over(&begun) {
            let read = self.board.read_entries(Bank::Shadow, port, entries.len() / ROW_FACTOR_BYTES)?;
            self.wrong += u64::from(read != entries);
        }
        Ok(self.throughput(&begun))
    }

    /// A packet of row factors, 1 to 2^24, as many as fit into packet and table.
    fn entries(&mut self) -> Vec<u8> {
        // A packet without entries would test nothing. The capabilities of a board of an unknown datapath are not checked, so its
        // height may be 0.
        let rows = self.board.capabilities.max_height.max(1);
        let count = Board::entries_at_once(Table::RowFactors).min(rows.into());
        (0..count).flat_map(|_| (1 + (self.random.next_u32() >> 8)).to_le_bytes()).collect()
    }
}
