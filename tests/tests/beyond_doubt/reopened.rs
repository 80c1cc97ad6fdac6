//! Links that are opened again: what the tries send, and how long they take.

use std::collections::BTreeSet;
use std::io;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use halfrow::link::{Candidate, Link, LinkError, Reopener};
use halfrow::result::{Finding, Report};
use halfrow_protocol::Kind;
use halfrow_protocol::message::{Hello, Request};
use halfrow_tests::altered::{Passing, Toward};
use halfrow_tests::patience::LIMIT;
use halfrow_tests::system::{System, judge_reconnecting, streamed};

use crate::conduct::passes;
use crate::outages::{board, breakable};

/// The sequence numbers and nonces of greetings.
type Greetings = Arc<Mutex<Vec<(u16, u32)>>>;

/// A link that breaks once the board's first packet of `kind` has left it. Greetings are noted.
fn breaking_at(kind: Kind, greetings: &Greetings) -> Candidate {
    let is_cut = Arc::new(AtomicBool::new(false));
    let (cut, greetings) = (Arc::clone(&is_cut), Arc::clone(greetings));
    let alter = move |toward, packet: Passing| {
        if let (Toward::Board, Some(Request::Hello(Hello { nonce, .. }))) = (toward, packet.request()) {
            greetings.lock().unwrap().push((packet.header.sequence, nonce));
        }
        cut.fetch_or(toward == Toward::Host && packet.is(kind), Ordering::Relaxed);
        vec![packet]
    };
    breakable(alter, is_cut)
}

/// The report on the board at `candidate`, which `reopen` opens again within `patience`.
fn report(candidate: Candidate, reopen: Reopener, patience: Duration) -> Report {
    let candidate = Candidate { reopen: Some(reopen), ..candidate };
    judge_reconnecting(&streamed(System::TINY.plan()), Some(patience), candidate)
}

/// A board may have answered a try whose answer never came. It takes the same nonce for the same session (WIRE.md, 01), and a
/// late refusal of a HELLO is known by its number only.
#[test]
fn each_try_to_open_a_board_again_has_numbers_of_its_own() {
    let greetings = Greetings::default();
    let seen = Arc::clone(&greetings);
    let mut tries = 0;
    let reopen = Box::new(move || {
        tries += 1;
        let kind = [Kind::Hello, Kind::Hello, Kind::RowOut].get(tries - 1);
        Ok(kind.map_or_else(|| board(false), |&kind| breaking_at(kind, &seen).link))
    });
    passes(&report(breaking_at(Kind::RowOut, &greetings), reopen, LIMIT));
    let greetings = greetings.lock().unwrap();
    let sequences: BTreeSet<_> = greetings.iter().map(|&(sequence, _)| sequence).collect();
    let nonces: BTreeSet<_> = greetings.iter().map(|&(_, nonce)| nonce).collect();
    assert_eq!([greetings.len(), sequences.len(), nonces.len()], [4; 3], "{greetings:?}");
}

/// A link by the wall's clock, whose first exchange takes a while.
struct Slow {
    link: Box<dyn Link>,
    opened: Instant,
    is_new: bool,
}

/// What the first exchange takes: much more than a run on this board in this process.
const WHILE: Duration = Duration::from_millis(500);

impl Link for Slow {
    fn exchange(
        &mut self,
        outgoing: &[u8],
        incoming: &mut Vec<u8>,
        wait: Duration,
    ) -> Result<usize, LinkError> {
        if std::mem::take(&mut self.is_new) {
            std::thread::sleep(WHILE);
        }
        self.link.exchange(outgoing, incoming, wait)
    }

    fn now(&self) -> Duration {
        self.opened.elapsed()
    }

    fn bytes_per_second(&self) -> Option<f64> {
        None
    }

    fn name(&self) -> String {
        self.link.name()
    }
}

#[test]
fn the_time_in_which_a_board_is_opened_again_counts_once() {
    let begun = Instant::now();
    let slow = |link| Box::new(Slow { link, opened: Instant::now(), is_new: true });
    let first = breaking_at(Kind::RowOut, &Greetings::default());
    let candidate = Candidate { link: slow(first.link), ..first };
    let report = report(candidate, Box::new(move || Ok(slow(board(false)))), LIMIT);
    let all = begun.elapsed().as_secs_f64();
    passes(&report);
    let told = report.link.seconds;
    assert!(told >= 2.0 * WHILE.as_secs_f64() && told <= all, "{told} of {all} s");
}

#[test]
fn the_time_for_which_a_board_stayed_away_counts() {
    let gone = || Err(io::Error::from(io::ErrorKind::NotFound).into());
    let candidate = breaking_at(Kind::RowOut, &Greetings::default());
    let report = report(candidate, Box::new(gone), WHILE);
    assert!(matches!(report.finding, Finding::BoardStayedAway { .. }), "{}", report.headline());
    assert!(report.link.seconds >= WHILE.as_secs_f64(), "{} s", report.link.seconds);
}
