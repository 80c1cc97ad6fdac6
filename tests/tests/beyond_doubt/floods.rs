//! Peers that send without end, faster than the host reads: what was asked of them is given up all the same.

use std::mem;
use std::sync::Mutex;
use std::time::Duration;

use halfrow::board::{Board, BoardError, OpenOptions};
use halfrow::link::{Candidate, Link, LinkError};
use halfrow_mock::Options;
use halfrow_protocol::{Encoder, Header, Kind};
use halfrow_tests::altered::Altered;

/// What the host takes for everything that it does with what came.
const BUSY: Duration = Duration::from_millis(20);
/// Exchanges after which nobody has given up.
const ENDLESS: usize = 10_000;

/// A link to a board that answers `sound` requests, and from then on sends rows that nobody asked for. An exchange takes no time,
/// and whatever the host does between two of them [`BUSY`].
struct Flood {
    link: Box<dyn Link>,
    sound: usize,
    exchanges: usize,
    clock: Mutex<Clock>,
}

#[derive(Default)]
struct Clock {
    now: Duration,
    /// Whether the host has done nothing since the last exchange.
    is_fresh: bool,
}

impl Flood {
    fn of(sound: usize) -> Box<Self> {
        let Candidate { link, .. } = Altered::new(&Options::default(), |_, packet| vec![packet]).candidate();
        Box::new(Self { link, sound, exchanges: 0, clock: Mutex::default() })
    }
}

impl Link for Flood {
    fn exchange(&mut self, out: &[u8], back: &mut Vec<u8>, wait: Duration) -> Result<usize, LinkError> {
        self.clock.get_mut().unwrap().is_fresh = true;
        self.exchanges += 1;
        if self.exchanges == ENDLESS {
            return Err(LinkError::Closed { link: self.name(), at: self.now() });
        }
        if self.sound > 0 {
            let taken = self.link.exchange(out, back, wait)?;
            self.sound -= usize::from(!back.is_empty());
            return Ok(taken);
        }
        let header = Header { kind: Kind::RowOut.code(), sequence: 3, reply: false, session: 1, window: 0 };
        Encoder::new().encode(&header, |payload| payload.extend([0; 20]), back).unwrap();
        Ok(out.len())
    }

    fn now(&self) -> Duration {
        let mut clock = self.clock.lock().unwrap();
        if !mem::take(&mut clock.is_fresh) {
            clock.now += BUSY;
        }
        clock.now
    }

    fn bytes_per_second(&self) -> Option<f64> {
        None
    }

    fn name(&self) -> String {
        "a flood".to_owned()
    }
}

#[test]
fn a_request_that_a_flood_does_not_answer_is_given_up() {
    let failed = Board::open(Flood::of(0), &OpenOptions::default()).unwrap_err();
    assert!(matches!(failed.error, BoardError::NoAnswer { kind: Kind::Hello, .. }), "{failed}");
    let told = failed.to_string();
    assert!(
        told.contains("whole packets came, none of them the reply") && !told.contains("before"),
        "{told}"
    );
    let failed = Board::open(Flood::of(1), &OpenOptions::default()).unwrap_err();
    assert!(matches!(failed.error, BoardError::NoAnswer { kind: Kind::Capabilities, .. }), "{failed}");
    assert!(failed.to_string().contains("though the board had answered before"), "{failed}");
}

/// A user has asked the program to end, and waits.
#[test]
fn a_session_is_left_although_the_peer_goes_on_sending() {
    let mut board = Board::open(Flood::of(2), &OpenOptions::default()).unwrap();
    let begun = board.now();
    board.close();
    assert!(board.now() - begun < Duration::from_secs(10), "{:?}", board.now() - begun);
}
