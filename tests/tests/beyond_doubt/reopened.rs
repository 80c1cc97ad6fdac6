//! Links that are opened again: what the tries send.

use std::collections::BTreeSet;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use halfrow::link::{Candidate, Reopener};
use halfrow::progress::Silent;
use halfrow::result::Report;
use halfrow::run::{RunOptions, verify};
use halfrow_protocol::message::{Hello, Request};
use halfrow_protocol::{Kind, Packet};
use halfrow_tests::altered::{Passing, Toward};
use halfrow_tests::patience::LIMIT;
use halfrow_tests::system::{System, streamed};

use crate::conduct::passes;
use crate::outages::{board, breakable};

/// The sequence numbers and nonces of greetings.
type Greetings = Arc<Mutex<Vec<(u16, u32)>>>;

/// A link that breaks once the board's first packet of `kind` has left it. Greetings are noted.
fn breaking_at(kind: Kind, greetings: &Greetings) -> Candidate {
    let is_cut = Arc::new(AtomicBool::new(false));
    let (cut, greetings) = (Arc::clone(&is_cut), Arc::clone(greetings));
    let alter = move |toward, packet: Passing| {
        let read = Request::read(&Packet { header: packet.header, payload: &packet.payload });
        if let (Toward::Board, Ok(Request::Hello(Hello { nonce, .. }))) = (toward, read) {
            greetings.lock().unwrap().push((packet.header.sequence, nonce));
        }
        cut.fetch_or(toward == Toward::Host && packet.is(kind), Ordering::Relaxed);
        vec![packet]
    };
    breakable(alter, is_cut)
}

/// The report on the board at `candidate`, which `reopen` opens again within `patience`.
fn report(candidate: Candidate, reopen: Reopener, patience: Duration) -> Report {
    let options = RunOptions { reconnect: Some(patience), ..RunOptions::default() };
    let candidate = Candidate { reopen: Some(reopen), ..candidate };
    verify(&streamed(System::TINY.plan()), candidate, &options, &Silent).unwrap().report
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
