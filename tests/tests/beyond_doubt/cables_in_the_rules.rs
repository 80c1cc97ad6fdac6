//! Cables that do something to what the rules send: a sound board passes, and what only a cable may have caused is no FAIL.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use halfrow::link::{Candidate, Link};
use halfrow::result::{Counter, Finding, Report};
use halfrow::verdict::Verdict;
use halfrow_protocol::message::{ResetLevel, Status, Welcome};
use halfrow_protocol::{Damage, Decoder, Kind, Reply};
use halfrow_tests::altered::{Passing, Toward};
use halfrow_tests::system::{judge_by_plan, open};
use halfrow_tests::through::Through;

use super::by_the_rules::{altering, plan};

/// Where a greeting says which host it is of (WIRE.md, 00).
const HOST: std::ops::Range<usize> = 4..8;

/// The kind and the payload of what stands between two zeros on the wire, or what is wrong with it.
fn read(piece: &[u8]) -> Option<Result<(u8, Vec<u8>), Damage>> {
    let ended = [piece, &[0]].concat();
    let read =
        Decoder::new().next(&mut &ended[..])?.map(|packet| (packet.header.kind, packet.payload.to_vec()));
    Some(read)
}

/// The report on a sound board over a cable that puts what the host sends, piece by piece without the zeros, as `put` says.
fn over(mut put: impl FnMut(&mut dyn Link, Vec<u8>) -> Option<Vec<u8>> + Send + 'static) -> Report {
    let candidate = open("mock");
    let (mut piece, mut queue) = (Vec::new(), Vec::new());
    let link = Through::boxed(candidate.link, move |link, out, back, wait| {
        for &byte in out {
            if byte != 0 {
                piece.push(byte);
                continue;
            }
            queue.extend(put(link, std::mem::take(&mut piece)).unwrap_or_default());
            queue.push(0);
        }
        let taken = link.exchange(&queue, back, wait)?;
        queue.drain(..taken);
        Ok(out.len())
    });
    judge_by_plan(&plan(), Candidate { link, ..candidate })
}

/// Which of the groups of damaged packets that the rules send the last piece was in, from 1 on; 0 between them.
#[derive(Default)]
struct Groups {
    begun: usize,
    is_inside: bool,
}

impl Groups {
    fn of(&mut self, read: &Option<Result<(u8, Vec<u8>), Damage>>) -> usize {
        match read {
            Some(Err(_)) if !self.is_inside => (self.begun, self.is_inside) = (self.begun + 1, true),
            Some(Ok(_)) => self.is_inside = false,
            _ => {}
        }
        if self.is_inside { self.begun } else { 0 }
    }
}

#[test]
fn packets_that_a_cable_swallows_once_need_not_be_counted() {
    let (mut groups, swallowed) = (Groups::default(), Arc::new(AtomicUsize::new(0)));
    let seen = Arc::clone(&swallowed);
    let report = over(move |_, piece| {
        let read = read(&piece);
        let is_framing = matches!(read, Some(Err(damage)) if damage != Damage::Crc);
        let is_swallowed = groups.of(&read) == 1 && is_framing;
        seen.fetch_add(is_swallowed.into(), Ordering::Relaxed);
        (!is_swallowed).then_some(piece)
    });
    assert_eq!(report.verdict(), Verdict::Pass, "{}", report.headline());
    assert!(swallowed.load(Ordering::Relaxed) > 0);
}

/// The packet that is whole is carried out, and answered.
#[test]
fn a_bit_that_a_cable_flips_back_once_is_no_fault_of_the_board() {
    let (mut groups, flipped) = (Groups::default(), Arc::new(Mutex::new(0)));
    let seen = Arc::clone(&flipped);
    let report = over(move |_, piece| {
        let read = read(&piece);
        let mut flipped = seen.lock().unwrap();
        if groups.of(&read) != 2 || *flipped > 0 || !matches!(read, Some(Err(Damage::Crc))) {
            return Some(piece);
        }
        *flipped += 1;
        Some(mended(&piece))
    });
    assert_eq!((report.verdict(), *flipped.lock().unwrap()), (Verdict::Pass, 1), "{}", report.headline());
}

/// The piece with the one bit flipped that makes it a packet.
fn mended(piece: &[u8]) -> Vec<u8> {
    let flipped = |bit: usize| {
        let mut other = piece.to_vec();
        other[bit / 8] ^= 1 << (bit % 8);
        other
    };
    let is_packet = |other: &Vec<u8>| !other.contains(&0) && matches!(read(other), Some(Ok(_)));
    (0..8 * piece.len()).map(flipped).find(is_packet).unwrap()
}

/// For 10 s of silence a board is its host's (WIRE.md, 00).
#[test]
fn another_host_may_have_the_board_after_a_silence_of_the_cable() {
    let (mut own, silences) = (None, Arc::new(AtomicUsize::new(0)));
    let seen = Arc::clone(&silences);
    let report = over(move |link, piece| {
        if let Some(Ok((kind, payload))) = read(&piece)
            && kind == Kind::Hello.code()
            && *own.get_or_insert(payload[HOST].to_vec()) != payload[HOST]
            && seen.swap(1, Ordering::Relaxed) == 0
        {
            let begun = link.now();
            while link.now() - begun < Duration::from_secs(11) {
                link.exchange(&[], &mut Vec::new(), Duration::from_secs(1)).unwrap();
            }
        }
        Some(piece)
    });
    assert_eq!(
        (report.verdict(), silences.load(Ordering::Relaxed)),
        (Verdict::Pass, 1),
        "{}",
        report.headline()
    );
}

/// A cable may hold a packet back until the session is open whose number it has.
#[test]
fn no_packet_has_the_number_of_a_session_that_is_yet_to_come() {
    let (opened, sent) = (Arc::new(Mutex::new(Vec::new())), Arc::new(Mutex::new(Vec::new())));
    let (opens, sends) = (Arc::clone(&opened), Arc::clone(&sent));
    let report = altering(move |toward, packet| {
        let mut opened = opens.lock().unwrap();
        match packet.reply() {
            Some(Reply::Hello(Welcome { session, .. }))
                if toward == Toward::Host && opened.last() != Some(&session) =>
            {
                opened.push(session);
            }
            _ if toward == Toward::Board => sends.lock().unwrap().push((opened.len(), packet.header.session)),
            _ => {}
        }
        vec![packet]
    });
    assert_eq!(report.verdict(), Verdict::Pass, "{}", report.headline());
    let (opened, sent) = (opened.lock().unwrap(), sent.lock().unwrap());
    assert!(opened.len() > 4 && sent.iter().any(|(_, session)| !opened.contains(session)), "{opened:?}");
    for (before, session) in sent.iter() {
        assert!(!opened[*before..].contains(session), "{session} while {before} of {opened:?} were open");
    }
}

/// Once a session is closed, the greeting that opened it opens another one.
#[test]
fn a_greeting_that_comes_again_behind_each_close_makes_no_sound_board_fail() {
    for is_next in [true, false] {
        let (mut greeting, mut late) = (None, None);
        let report = altering(move |toward, packet| {
            if toward == Toward::Host {
                return vec![packet];
            }
            let is_greeting = packet.is(Kind::Hello);
            let copy = if is_greeting { late.take() } else { None };
            if is_greeting {
                greeting = Some(packet.clone());
            }
            if packet.is(Kind::Reset) && packet.payload[0] == ResetLevel::Session as u8 {
                late.clone_from(&greeting);
            }
            let behind = if is_next { late.take() } else { None };
            copy.into_iter().chain([packet]).chain(behind).collect()
        });
        assert_eq!(report.verdict(), Verdict::Error, "{is_next}: {}", report.headline());
        assert!(report.headline().contains("may have reached it twice"), "{}", report.headline());
    }
}

/// A packet that is doubled where it changes the board, the first of its kind in each of the first `sessions` sessions.
fn doubled(sessions: usize) -> impl FnMut(Toward, &Passing) -> bool {
    let (mut greeted, mut is_done) = (0, false);
    move |toward, packet| {
        if toward == Toward::Host {
            return false;
        }
        if packet.is(Kind::Hello) {
            (greeted, is_done) = (greeted + 1, false);
        }
        packet.is(Kind::Configure) && greeted <= sessions && !std::mem::replace(&mut is_done, true)
    }
}

/// What was written twice in the first session may still be what is wrong in a later one.
#[test]
fn a_doubt_of_an_earlier_session_holds_in_those_that_the_rules_open() {
    let (mut is_doubled, mut first, mut is_spoilt) = (doubled(1), None, false);
    let report = altering(move |toward, packet| {
        if is_doubled(toward, &packet) {
            return vec![packet.clone(), packet];
        }
        let is_row = toward == Toward::Host && packet.is(Kind::RowOut);
        if !is_row || *first.get_or_insert(packet.header.session) == packet.header.session {
            return vec![packet];
        }
        if std::mem::replace(&mut is_spoilt, true) {
            return vec![packet];
        }
        vec![packet.with_row(|row, _| row.generation ^= 1)]
    });
    assert!(matches!(report.finding, Finding::RightInAnotherSession { .. }), "{}", report.headline());
    assert_eq!(report.verdict(), Verdict::Error, "{}", report.headline());
}

/// The copies of one request cannot have done it each time.
#[test]
fn a_count_that_every_reset_clears_fails_also_over_a_cable_that_doubles_a_request() {
    let (mut is_doubled, mut is_reset, mut cleared) = (doubled(usize::MAX), false, 0);
    let report = altering(move |toward, packet| {
        if is_doubled(toward, &packet) {
            return vec![packet.clone(), packet];
        }
        is_reset = match toward {
            Toward::Board => packet.is(Kind::Reset) || is_reset && packet.is(Kind::Status),
            Toward::Host => is_reset,
        };
        let Some(Reply::Status(status)) = packet.reply().filter(|_| toward == Toward::Host) else {
            return vec![packet];
        };
        if is_reset || status.rows_in < cleared {
            cleared = status.rows_in;
        }
        vec![packet.saying(&Reply::Status(Status { rows_in: status.rows_in - cleared, ..status }))]
    });
    let Finding::CounterWrong { counter, .. } = &report.finding else { panic!("{}", report.headline()) };
    assert_eq!((report.verdict(), *counter), (Verdict::Fail, Counter::RowsIn), "{}", report.headline());
}
