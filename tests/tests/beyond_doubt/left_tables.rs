//! What an earlier session has left is nothing to a run, and what a run leaves is a board that is free.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use halfrow::board::{Board, Datapath, NumberedFrame, OpenOptions, ReturnedRow, RowTiming, RowTraffic, Stop};
use halfrow::link::{Candidate, Link, LinkError};
use halfrow::progress::Silent;
use halfrow::result::Report;
use halfrow::run::{RunOptions, verify};
use halfrow::verdict::{Cause, StoppedBy};
use halfrow_mock::Options;
use halfrow_model::{Frame, Kernel, Phase, TableSet};
use halfrow_protocol::message::{Hello, Reset, ResetLevel, Welcome};
use halfrow_protocol::{Reply, Request};
use halfrow_tests::altered::{Altered, Passing, Toward, judge};
use halfrow_tests::patience::LIMIT;
use halfrow_tests::system::{System, open};

use crate::conduct::passes;
use crate::stale_packets::cut_when_told;

/// A link to a board that stays when it is dropped.
#[derive(Clone)]
struct Shared(Arc<Mutex<Box<dyn Link>>>);

impl Shared {
    fn with<T>(&self, act: impl FnOnce(&mut dyn Link) -> T) -> T {
        act(&mut **self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

impl Link for Shared {
    fn exchange(&mut self, out: &[u8], back: &mut Vec<u8>, wait: Duration) -> Result<usize, LinkError> {
        self.with(|link| link.exchange(out, back, wait))
    }

    fn now(&self) -> Duration {
        self.with(|link| link.now())
    }

    fn bytes_per_second(&self) -> Option<f64> {
        self.with(|link| link.bytes_per_second())
    }

    fn name(&self) -> String {
        self.with(|link| link.name())
    }
}

/// One frame, of which only the return matters.
struct One(Option<NumberedFrame>);

impl RowTraffic for One {
    fn next_frame(&mut self) -> Option<NumberedFrame> {
        self.0.take()
    }

    fn returned(&mut self, _: &ReturnedRow<'_>) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

/// Leaves `tables` active as `generation`, and the counters of a frame.
fn leave(link: Shared, tables: &TableSet, kernel: &Kernel, generation: u8) {
    let geometry = tables.geometry();
    let samples = vec![0; geometry.width() * geometry.height()];
    let frame = Frame::new(geometry.width(), geometry.depth(), Phase::Grbg, samples).unwrap();
    Board::with(Box::new(link), &OpenOptions::default(), |board| {
        board.configure(geometry, RowTiming::default(), Datapath::RowFactors).unwrap();
        board.upload(tables, kernel).unwrap();
        board.commit(tables, kernel, 0, generation).unwrap();
        board.stream(&mut One(Some(NumberedFrame { number: 0, frame: Arc::new(frame) }))).unwrap();
    })
    .unwrap();
}

/// By a lens of another radius, under each generation that a run has. A board takes a commit of the active one for a repeated packet.
#[test]
fn tables_that_were_left_under_the_generations_of_a_run_are_dropped() {
    let other = System { radius: System::TINY.radius + 5.0, ..System::TINY }.plan();
    for banks in [1, 2] {
        for generation in 1..=3 {
            let candidate = open(&format!("mock,table-banks={banks}"));
            let shared = Shared(Arc::new(Mutex::new(candidate.link)));
            leave(shared.clone(), &other.tables, &other.kernel, generation);
            passes(&System::TINY.judge_candidate(Candidate { link: Box::new(shared), ..candidate }));
        }
    }
}

/// It has the number of the greeting that the run sends, which it is no answer to, and opens an earlier session.
#[test]
fn an_answer_to_an_old_greeting_opens_no_session() {
    let mut is_done = false;
    passes(&judge(&System::TINY, move |toward, packet| match packet.reply() {
        Some(Reply::Hello(welcome)) if toward == Toward::Host && !std::mem::replace(&mut is_done, true) => {
            let session = welcome.session + 100;
            let mut old = packet.saying(&Reply::Hello(Welcome { nonce: !welcome.nonce, session, ..welcome }));
            old.header.session = session;
            vec![old, packet]
        }
        _ => vec![packet],
    }));
}

/// What a host says of its sessions: its greetings, and how many times it closes one.
fn sessions(options: &RunOptions, is_stopped: Arc<AtomicBool>) -> (Report, Vec<Hello>, usize) {
    let (sender, said) = std::sync::mpsc::channel();
    let alter = move |toward, packet: Passing| {
        match (toward, packet.request()) {
            (Toward::Board, Some(Request::Hello(hello))) => sender.send(Some(hello)).unwrap(),
            (Toward::Board, Some(Request::Reset(Reset { level: ResetLevel::Session, .. }))) => {
                sender.send(None).unwrap();
            }
            (Toward::Board, Some(Request::RowIn(_))) => is_stopped.store(true, Ordering::Relaxed),
            _ => {}
        }
        vec![packet]
    };
    let candidate = Altered::new(&Options::default(), alter).candidate();
    let report = verify(&System::TINY.plan(), candidate, options, &Silent).unwrap().report;
    let said: Vec<_> = said.iter().collect();
    let closed = said.iter().filter(|it| it.is_none()).count();
    (report, said.into_iter().flatten().collect(), closed)
}

/// Whether only the first greeting can take the board from another host. The rules take it over as another host, and take it
/// back with the greeting that follows.
fn takes_over_once(greetings: &[Hello]) -> bool {
    let takes: Vec<_> = (0..greetings.len()).filter(|&at| greetings[at].take_over).collect();
    let [0, other, back] = takes[..] else { return false };
    back == other + 1
        && greetings[other].host != greetings[0].host
        && greetings[back].host == greetings[0].host
}

/// Behind a session that was closed on purpose the board may be another host's.
#[test]
fn a_board_is_taken_over_once() {
    let options = RunOptions { take_over: true, ..RunOptions::default() };
    let (report, greetings, _) = sessions(&options, Arc::default());
    passes(&report);
    assert!(takes_over_once(&greetings), "{greetings:?}");
}

#[test]
fn a_run_that_is_stopped_leaves_a_board_that_is_free() {
    let is_stopped = Arc::new(AtomicBool::new(false));
    let asked = Arc::clone(&is_stopped);
    let stop = Stop::when(move || asked.load(Ordering::Relaxed).then_some(StoppedBy::Person));
    let (report, _, closed) = sessions(&RunOptions { stop, ..RunOptions::default() }, is_stopped);
    assert_eq!(report.cause, Cause::Stopped(StoppedBy::Person), "{}", report.headline());
    assert_eq!(closed, 1);
}

/// It goes away behind its first row. Whoever has it when it comes back came later.
#[test]
fn whoever_has_a_board_that_comes_back_keeps_it() {
    let is_cut = Arc::new(AtomicBool::new(false));
    let (cut, greetings) = (Arc::clone(&is_cut), Arc::new(Mutex::new(Vec::new())));
    let seen = Arc::clone(&greetings);
    let board = move || {
        let (cut, seen) = (Arc::clone(&cut), Arc::clone(&seen));
        let alter = move |toward, packet: Passing| {
            match packet.request() {
                Some(Request::Hello(hello)) if toward == Toward::Board => {
                    seen.lock().unwrap().push(hello);
                }
                Some(Request::RowIn(_)) if toward == Toward::Board => cut.store(true, Ordering::Relaxed),
                _ => {}
            }
            vec![packet]
        };
        Altered::new(&Options::default(), alter).candidate()
    };
    let first = board();
    let link = cut_when_told(first.link, is_cut);
    let candidate = Candidate { link, reopen: Some(Box::new(move || Ok(board().link))), ..first };
    let options = RunOptions { take_over: true, reconnect: Some(LIMIT), ..RunOptions::default() };
    let report = verify(&System::TINY.plan(), candidate, &options, &Silent).unwrap().report;
    passes(&report);
    let greetings = greetings.lock().unwrap();
    assert!(takes_over_once(&greetings), "{greetings:?}");
}
