//! What is sent again, how often, and when that is too much: over links that lose, delay or hold back single packets, and links
//! that bring packets of another session.

use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::time::Duration;

use halfrow::board::{Board, BoardError, Datapath, OpenOptions, RetryLimit, RowTiming};
use halfrow::link::Link;
use halfrow::verdict::Verdict;
use halfrow_mock::Options;
use halfrow_protocol::message::Status;
use halfrow_protocol::{Kind, Reply};
use halfrow_tests::altered::{Altered, Passing, Toward, judge};
use halfrow_tests::system::System;
use halfrow_tests::through::Through;

/// The link of a mock board whose packets `alter` rewrites.
fn altered(alter: impl FnMut(Toward, Passing) -> Vec<Passing> + Send + 'static) -> Box<dyn Link> {
    Altered::new(&Options::default(), alter).candidate().link
}

fn opened(link: Box<dyn Link>, retry_limit: RetryLimit) -> Board {
    Board::open(link, &OpenOptions { retry_limit, ..OpenOptions::default() }).unwrap()
}

fn configure(board: &mut Board) -> Result<(), BoardError> {
    board.configure(System::TINY.plan().tables.geometry(), RowTiming::default(), Datapath::RowFactors)
}

#[test]
fn as_many_retries_as_are_allowed_make_no_link_too_poor() {
    let mut answers = 0;
    let link = altered(move |toward, packet| {
        let is_answer = toward == Toward::Host && packet.is(Kind::Configure);
        answers += usize::from(is_answer);
        if is_answer && answers % 2 == 1 { Vec::new() } else { vec![packet] }
    });
    let mut board = opened(link, RetryLimit { fixed: 2, share: 0.0 });
    configure(&mut board).unwrap();
    configure(&mut board).unwrap();
    let refused = configure(&mut board).unwrap_err();
    assert!(matches!(refused, BoardError::TooPoor { retries: 3, limit: 2, .. }), "{refused}");
}

/// The message about a missing answer says "8 tries".
#[test]
fn a_request_is_tried_as_often_as_is_told() {
    let losing = |most: usize| {
        let tries = Arc::new(AtomicUsize::new(0));
        let seen = Arc::clone(&tries);
        let link = altered(move |toward, packet| {
            let is_try = toward == Toward::Board && packet.is(Kind::Configure);
            let before = seen.fetch_add(usize::from(is_try), Ordering::Relaxed);
            if is_try && before < most { Vec::new() } else { vec![packet] }
        });
        (opened(link, RetryLimit::NONE), tries)
    };
    let (mut board, _) = losing(7);
    configure(&mut board).unwrap();
    let (mut board, tries) = losing(usize::MAX);
    let lost = configure(&mut board).unwrap_err();
    assert!(matches!(lost, BoardError::Unanswered { attempts: 8, .. }), "{lost}");
    // Once more than that, between two other requests that are answered.
    assert_eq!(tries.load(Ordering::Relaxed), 9);
}

/// A link that accepts nothing for the next `left` exchanges.
fn full(link: Box<dyn Link>, left: Arc<AtomicUsize>) -> Box<dyn Link> {
    Through::boxed(link, move |link, out, back, wait| {
        let is_full = left.load(Ordering::Relaxed) > 0;
        left.fetch_sub(is_full.into(), Ordering::Relaxed);
        link.exchange(if is_full { &[] } else { out }, back, wait)
    })
}

#[test]
fn what_still_waits_to_be_written_is_not_written_twice() {
    let [left, came] = [(); 2].map(|()| Arc::new(AtomicUsize::new(0)));
    let seen = Arc::clone(&came);
    let link = altered(move |toward, packet| {
        let is_request = toward == Toward::Board && packet.is(Kind::Configure);
        seen.fetch_add(usize::from(is_request), Ordering::Relaxed);
        vec![packet]
    });
    let mut board = opened(full(link, Arc::clone(&left)), RetryLimit::NONE);
    left.store(3, Ordering::Relaxed);
    configure(&mut board).unwrap();
    assert_eq!((left.load(Ordering::Relaxed), came.load(Ordering::Relaxed)), (0, 1));
}

/// The packet has the number of the request that was sent last.
#[test]
fn what_is_of_another_session_is_no_answer() {
    let report = judge(&System::TINY, |_, packet: Passing| match packet.reply() {
        Some(Reply::Status(status)) => {
            let mut other = packet.saying(&Reply::Status(Status { samples_over: 1, ..status }));
            other.header.session ^= 0x40;
            vec![other, packet]
        }
        _ => vec![packet],
    });
    assert_eq!(report.verdict(), Verdict::Pass, "{}", report.headline());
    assert!(report.link.strays > 0);
}

/// A link brings a copy of an old packet after newer ones; its window is one that the rows have passed.
#[test]
fn a_window_that_comes_late_takes_no_credit_away() {
    let mut old = None;
    let report = judge(&System::TINY, move |toward, packet: Passing| {
        if toward == Toward::Host && packet.is(Kind::Capabilities) {
            old = Some(packet.clone());
        }
        let is_behind = toward == Toward::Host && packet.is(Kind::Configure);
        [Some(packet), old.clone().filter(|_| is_behind)].into_iter().flatten().collect()
    });
    assert_eq!(report.verdict(), Verdict::Pass, "{}", report.headline());
    assert!(report.link.strays > 0);
}

/// A link that delivers one packet every `every` milliseconds, in the order in which they came.
fn one_by_one(link: Box<dyn Link>, every: Arc<AtomicU64>) -> Box<dyn Link> {
    let (mut held, mut next) = (VecDeque::<Vec<u8>>::new(), Duration::ZERO);
    Through::boxed(link, move |link, out, back, wait| {
        let every = Duration::from_millis(every.load(Ordering::Relaxed));
        if every.is_zero() {
            return link.exchange(out, back, wait);
        }
        let until = next.saturating_sub(link.now());
        let (mut came, is_idle) = (Vec::new(), held.is_empty());
        let taken = link.exchange(out, &mut came, if is_idle { wait } else { wait.min(until) })?;
        // Every packet ends in a zero and begins with one.
        held.extend(came.split_inclusive(|&byte| byte == 0).filter(|packet| packet.len() > 1).map(Vec::from));
        if is_idle {
            next = link.now() + every;
        } else if link.now() >= next {
            next += every;
            back.extend(held.pop_front().into_iter().flatten());
        }
        Ok(taken)
    })
}

/// Each of the tries that were sent meanwhile brings an answer, and the answer to the next request comes after all of them.
#[test]
fn a_request_is_waited_for_while_answers_to_the_one_before_still_come() {
    let every = Arc::new(AtomicU64::new(0));
    let link = altered(|_, packet| vec![packet]);
    let mut board = opened(one_by_one(link, Arc::clone(&every)), RetryLimit::NONE);
    // By then, all eight tries of the first request are under way.
    every.store(9800, Ordering::Relaxed);
    configure(&mut board).unwrap();
    configure(&mut board).unwrap();
    assert!(board.tally().late > 0);
}

/// The fourth try comes after 200, 400 and 800 ms; later waits are at least one and a half times these 1.4 s.
#[test]
fn an_answer_to_the_fourth_try_says_how_late_others_may_be() {
    let mut answers = 0;
    let link = altered(move |toward, packet| {
        let is_answer = toward == Toward::Host && packet.is(Kind::Configure);
        answers += usize::from(is_answer);
        if is_answer && [1, 2, 3, 5].contains(&answers) { Vec::new() } else { vec![packet] }
    });
    let mut board = opened(link, RetryLimit::NONE);
    let mut takes = || {
        let begun = board.now();
        configure(&mut board).unwrap();
        (board.now() - begun).as_millis()
    };
    let (first, second) = (takes(), takes());
    assert!(2 * second >= 3 * first, "{first} ms, {second} ms");
}
