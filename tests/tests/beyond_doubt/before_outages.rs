//! Links that break right after something wrong outside of the frames that are judged: what was found before is not forgotten when the board comes back.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use halfrow::board::RetryLimit;
use halfrow::link::{Candidate, Link, Reopener};
use halfrow::progress::Silent;
use halfrow::result::{Finding, Report};
use halfrow::run::{RunOptions, verify};
use halfrow::verdict::{Cause, Verdict};
use halfrow_mock::Options;
use halfrow_protocol::message::{Refusal, RefusalCode, Welcome};
use halfrow_protocol::{Kind, Reply};
use halfrow_tests::altered::{Altered, Passing, Toward};
use halfrow_tests::patience::LIMIT;
use halfrow_tests::system::{System, judge_reconnecting};

use crate::outages::{board as sound, breakable};

/// Which replies are meant.
type Meant = fn(&Reply<'_>) -> bool;
/// What becomes of a packet.
type Spoil = fn(&Passing) -> Passing;

/// A board of whose replies that are `meant` number `nth` is as `spoil` makes it, over a link that breaks right after it; it does
/// not come back. With the count of such replies so far.
fn breaking(meant: Meant, spoil: Spoil, nth: usize) -> (Candidate, Arc<AtomicUsize>) {
    let is_cut = Arc::new(AtomicBool::new(false));
    let seen = Arc::new(AtomicUsize::new(0));
    let (cut, counted) = (Arc::clone(&is_cut), Arc::clone(&seen));
    let alter = move |toward, packet: Passing| {
        let is_meant = toward == Toward::Host && packet.reply().is_some_and(|reply| meant(&reply));
        if is_meant && counted.fetch_add(1, Ordering::Relaxed) == nth {
            cut.store(true, Ordering::Relaxed);
            return vec![spoil(&packet)];
        }
        vec![packet]
    };
    (breakable(alter, is_cut), seen)
}

/// The report on `board`, which comes back as one of `others`, and as a sound one after those.
fn report(board: Candidate, mut others: Vec<Box<dyn Link>>) -> Report {
    let reopen: Reopener = Box::new(move || Ok(others.pop().unwrap_or_else(|| sound(false))));
    let candidate = Candidate { reopen: Some(reopen), ..board };
    judge_reconnecting(&System::TINY.plan(), Some(LIMIT), candidate)
}

/// The report on such a board, in whose place a sound one comes back. With how many of the replies there were.
fn wrong_before_an_outage(meant: Meant, spoil: Spoil, nth: usize) -> (Report, usize) {
    let (board, seen) = breaking(meant, spoil, nth);
    let report = report(board, Vec::new());
    (report, seen.load(Ordering::Relaxed))
}

/// The last replies are those to the rules that say what ends a session.
fn is_not_forgotten(meant: Meant, spoil: Spoil) {
    let (sound, replies) = wrong_before_an_outage(meant, spoil, usize::MAX);
    assert_eq!(sound.verdict(), Verdict::Pass, "{}", sound.headline());
    for nth in (0..replies).rev().take(12) {
        let (report, _) = wrong_before_an_outage(meant, spoil, nth);
        let ended = (report.verdict(), report.cause);
        assert_eq!(ended, (Verdict::Error, Cause::Station), "{nth}: {}", report.headline());
        assert!(matches!(report.finding, Finding::RightInAnotherSession { .. }), "{}", report.headline());
    }
}

fn with_another_bit(packet: &Passing) -> Passing {
    let mut packet = packet.clone();
    packet.payload.iter_mut().take(1).for_each(|byte| *byte ^= 1);
    packet
}

/// What a packet of another session did is read before its refusal is judged.
#[test]
fn a_wrong_refusal_is_not_forgotten_when_the_link_breaks_after_it() {
    let is_of_session = |reply: &Reply<'_>| match reply {
        Reply::Refusal(Refusal { code, kind, .. }) => {
            *code == RefusalCode::Session && *kind == Kind::TableWrite.code()
        }
        _ => false,
    };
    is_not_forgotten(is_of_session, with_another_bit);
}

#[test]
fn a_wrong_sum_of_a_table_is_not_forgotten_when_the_link_breaks_after_it() {
    is_not_forgotten(|reply| matches!(reply, Reply::TableCrc(_)), with_another_bit);
}

/// As a board that was never given it would send.
fn never_given(packet: &Passing) -> Passing {
    packet.with_row(|row, _| row.place.row_sequence += 1000)
}

#[test]
fn a_row_that_was_never_given_is_not_forgotten_when_the_link_breaks_after_it() {
    is_not_forgotten(|reply| matches!(reply, Reply::RowOut(_)), never_given);
}

/// A frame of this number makes the tables of a burst active; its samples are not judged.
#[test]
fn nor_is_one_in_front_of_a_burst() {
    let is_of_swap = |reply: &Reply<'_>| matches!(reply, Reply::RowOut(row) if row.place.frame == u16::MAX);
    is_not_forgotten(is_of_swap, never_given);
}

/// A board that comes back at the end of a run is given a frame that brings it to where the run was.
#[test]
fn nor_is_one_while_the_board_is_brought_back() {
    let is_sum: Meant = |reply| matches!(reply, Reply::TableCrc(_));
    let is_row: Meant = |reply| matches!(reply, Reply::RowOut(_));
    let (_, sums) = wrong_before_an_outage(is_sum, Passing::clone, usize::MAX);
    let spoilers: [(Spoil, Verdict); 2] = [(Passing::clone, Verdict::Pass), (never_given, Verdict::Error)];
    for (spoil, expected) in spoilers {
        let (away_at_rules, _) = breaking(is_sum, Passing::clone, sums - 1);
        let (away_again, rows) = breaking(is_row, spoil, 0);
        let report = report(away_at_rules, vec![away_again.link]);
        assert!(rows.load(Ordering::Relaxed) > 0, "no frame brought it back");
        assert_eq!(report.verdict(), expected, "{}", report.headline());
    }
}

/// The first answer with the capabilities is lost, and the link breaks at the second one.
#[test]
fn what_went_over_a_link_that_broke_as_the_board_was_opened_is_reported_too() {
    let judged = |first: Candidate| {
        let candidate = Candidate { reopen: Some(Box::new(|| Ok(sound(false)))), ..first };
        let retry_limit = RetryLimit { fixed: 1, share: 0.0 };
        let options = RunOptions { reconnect: Some(LIMIT), retry_limit, ..RunOptions::default() };
        let report = verify(&System::TINY.plan(), candidate, &options, &Silent).unwrap().report;
        assert_eq!(report.verdict(), Verdict::Pass, "{}", report.headline());
        report.link
    };
    let whole = judged(breakable(|_, packet| vec![packet], Arc::default()));
    let (is_cut, mut answers) = (Arc::new(AtomicBool::new(false)), 0);
    let cut = Arc::clone(&is_cut);
    let broken = judged(breakable(
        move |toward, packet: Passing| {
            let is_answer = toward == Toward::Host && packet.is(Kind::Capabilities);
            answers += usize::from(is_answer);
            cut.store(answers == 2, Ordering::Relaxed);
            if is_answer { Vec::new() } else { vec![packet] }
        },
        is_cut,
    ));
    assert_eq!((whole.reconnections.len(), broken.reconnections.len()), (0, 1));
    // HELLO and two requests for the capabilities, the second after 200 ms.
    assert_eq!((broken.packets_out, broken.retries), (whole.packets_out + 3, 1), "{broken:?}");
    assert!(broken.seconds >= whole.seconds + 0.2, "{broken:?}");
    // Each link may use one.
    assert_eq!((whole.retry_limit, broken.retry_limit), (1, 2));
}

#[test]
fn a_row_that_a_link_broke_at_is_told_by_its_frame() {
    let is_fifth: Meant = |reply| matches!(reply, Reply::RowOut(row) if row.place.row == 4);
    let (candidate, _) = breaking(is_fifth, Passing::clone, 0);
    let report = verify(&System::TINY.plan(), candidate, &RunOptions::default(), &Silent).unwrap().report;
    let [frame] = &report.frames[..] else { panic!("{:?}", report.frames) };
    let waited_for = format!("waiting for row {} of frame {}", frame.rows, frame.number);
    assert!(report.headline().contains(&waited_for), "{}", report.headline());
}

/// The packet as a board with another number says it.
fn of_another_board(packet: Passing) -> Passing {
    match packet.reply() {
        Some(Reply::Hello(welcome)) => {
            packet.saying(&Reply::Hello(Welcome { serial: !welcome.serial, ..welcome }))
        }
        _ => packet,
    }
}

/// A board whose rows are wrong until it is exchanged without a sign: another one answers the greeting of the second look, which it
/// has since a CONFIGURE came twice. The link breaks at the next CONFIGURE.
fn exchanged_before_an_outage() -> Candidate {
    let is_cut = Arc::new(AtomicBool::new(false));
    let (cut, mut greetings, mut configured) = (Arc::clone(&is_cut), 0, false);
    let alter = move |toward, packet: Passing| {
        if toward == Toward::Host {
            let packet = if greetings > 1 { of_another_board(packet) } else { packet };
            return vec![packet.with_row(|_, packed| packed[0] ^= 1)];
        }
        greetings += usize::from(packet.is(Kind::Hello));
        cut.store(greetings > 1 && packet.is(Kind::Configure), Ordering::Relaxed);
        let is_first = packet.is(Kind::Configure) && !std::mem::replace(&mut configured, true);
        let twice = is_first.then(|| packet.clone());
        twice.into_iter().chain([packet]).collect()
    };
    breakable(alter, is_cut)
}

/// The board that comes back is the one that was greeted last, and not the one that was judged.
#[test]
fn a_board_that_was_exchanged_before_an_outage_is_another_board() {
    let other = || Altered::new(&Options::default(), |_, packet| vec![of_another_board(packet)]);
    let reopen: Reopener = Box::new(move || Ok(other().candidate().link));
    let candidate = Candidate { reopen: Some(reopen), ..exchanged_before_an_outage() };
    let report = judge_reconnecting(&System::TINY.plan(), Some(LIMIT), candidate);
    assert_eq!(report.verdict(), Verdict::Error, "{}", report.headline());
    let Finding::SecondLookBrokenOff(broken_off) = &report.finding else { panic!("{}", report.headline()) };
    assert_eq!(broken_off.reason, Finding::BoardExchanged {});
}
