//! Links that lose a packet that nobody misses and deliver another one twice, so that a board receives as many as were sent; and
//! boards that an old greeting opens meanwhile. No sound board is FAIL.

use std::collections::BTreeMap;

use halfrow::result::{Finding, Report};
use halfrow::verdict::Verdict;
use halfrow_protocol::message::{Hello, Reset, ResetLevel};
use halfrow_protocol::{Header, Kind, Request};
use halfrow_tests::altered::{Passing, Toward, judge};
use halfrow_tests::parallel;
use halfrow_tests::system::System;

/// The number of the host in these runs.
const HOST: u32 = 0;

/// A packet toward the board: its kind, and its number among those of that kind, from 0.
type Numbered = (Kind, usize);

/// Counts the packets of each kind.
#[derive(Default)]
struct Numbers(BTreeMap<u8, usize>);

impl Numbers {
    /// Whether `packet`, the next one, is the one meant.
    fn is_next(&self, packet: &Passing, (kind, number): Numbered) -> bool {
        packet.is(kind) && self.0.get(&kind.code()).copied().unwrap_or_default() == number
    }

    fn pass(&mut self, packet: &Passing) {
        *self.0.entry(packet.header.kind).or_default() += 1;
    }
}

/// The report on a sound board behind a link that loses the packet `lost` toward it, and delivers `copied` once more, `later`
/// packets after the original. The answer to the copy is lost, too.
fn lost_and_doubled(lost: Numbered, copied: Numbered, later: usize) -> Report {
    let mut numbers = Numbers::default();
    let (mut copy, mut unanswered): (Option<(Passing, usize)>, Option<u16>) = (None, None);
    judge(&System::TINY, move |toward, packet| {
        if toward == Toward::Host {
            let is_lost = !packet.is(Kind::RowOut) && unanswered == Some(packet.header.sequence);
            return if is_lost && unanswered.take().is_some() { Vec::new() } else { vec![packet] };
        }
        let due = copy.take_if(|(_, left)| *left == 0);
        copy.iter_mut().for_each(|(_, left)| *left -= 1);
        if numbers.is_next(&packet, copied) {
            copy = Some((packet.clone(), later));
        }
        let is_lost = numbers.is_next(&packet, lost);
        numbers.pass(&packet);
        let due = due.map(|(copy, _)| copy);
        if let Some(copy) = due.as_ref().filter(|copy| !copy.is(Kind::RowIn)) {
            unanswered = Some(copy.header.sequence);
        }
        due.into_iter().chain((!is_lost).then_some(packet)).collect()
    })
}

/// None of these links makes a sound board FAIL, and fewer than half end in ERROR.
#[track_caller]
fn no_sound_board_fails(links: &[(Numbered, Numbered, usize)]) {
    let reports = parallel::map(links, |&(lost, copied, later)| lost_and_doubled(lost, copied, later));
    for (link, report) in links.iter().zip(&reports) {
        assert_ne!(report.verdict(), Verdict::Fail, "{link:?}: {}", report.headline());
    }
    let errors = reports.iter().filter(|report| report.verdict() == Verdict::Error).count();
    assert!(2 * errors < links.len(), "{errors} errors of {}", links.len());
}

#[test]
fn a_row_that_comes_twice_is_no_fault_of_a_board_that_missed_an_acknowledgement() {
    let rows = (1..80).step_by(5).map(|row| (Kind::RowIn, row));
    let links: Vec<_> = rows.flat_map(|row| [0, 1].map(|number| ((Kind::RowAck, number), row, 0))).collect();
    no_sound_board_fails(&links);
}

#[test]
fn a_late_request_is_no_fault_of_a_board_that_missed_an_acknowledgement() {
    let kinds = [Kind::Configure, Kind::TableWrite, Kind::Reset, Kind::Expect, Kind::Burst];
    let requests = kinds.into_iter().flat_map(|kind| (0..4).map(move |number| (kind, number)));
    let links: Vec<_> =
        requests.flat_map(|request| [3, 9].map(|later| ((Kind::RowAck, 1), request, later))).collect();
    no_sound_board_fails(&links);
}

/// The lost request is sent again, which cannot change a board.
#[test]
fn a_late_request_is_no_fault_of_a_board_that_missed_one_that_asks() {
    let harmless = [0, 2, 4, 6].map(|number| ((Kind::TableCrc, 1), (Kind::Configure, number), 3));
    // The kernel of one corner replaces the next one's, with no stream between the loss and the copy.
    let after_no_stream = ((Kind::TableCrc, 40), (Kind::TableWrite, 19), 11);
    let after_a_stream = ((Kind::TableCrc, 1), (Kind::Expect, 4), 20);
    no_sound_board_fails(&[&harmless[..], &[after_no_stream, after_a_stream]].concat());
}

/// How many sessions are opened until one has the number of the session that was open.
const SESSIONS: usize = 255;

/// Old greetings of this host that arrive late.
fn greetings() -> impl Iterator<Item = Passing> {
    let passing = |request: &Request<'_>| {
        let mut payload = Vec::new();
        request.write(&mut payload);
        let header = Header { kind: request.kind().code(), sequence: 0x4242, ..Header::default() };
        Passing { header, payload }
    };
    (1..=SESSIONS as u32).map(move |nonce| {
        let hello = Hello { nonce, host: HOST, version_min: 1, version_max: 1, take_over: false };
        passing(&Request::Hello(hello))
    })
}

/// The report on a sound board that loses its power before the packet `before`; then so many old greetings open sessions.
fn opened_meanwhile(before: Numbered, sessions: usize) -> Report {
    let mut numbers = Numbers::default();
    let mut awaited = None;
    judge(&System::TINY, move |toward, packet| {
        if toward == Toward::Host {
            // Nobody waits for the answers to the old greetings.
            let is_own = awaited.is_none_or(|sequence| packet.header.sequence == sequence);
            awaited.take_if(|_| is_own);
            return Vec::from_iter(is_own.then_some(packet));
        }
        let is_next = numbers.is_next(&packet, before);
        numbers.pass(&packet);
        if !is_next {
            return vec![packet];
        }
        awaited = Some(packet.header.sequence);
        let mut reset = Vec::new();
        Request::Reset(Reset { level: ResetLevel::Tables, next_row: 0 }).write(&mut reset);
        let header = Header { kind: Kind::Reset.code(), sequence: 0x4242, ..packet.header };
        let forgets = Passing { header, payload: reset };
        [forgets].into_iter().chain(greetings().take(sessions)).chain([packet]).collect()
    })
}

/// A board that was just switched on may open a session of the same number again (WIRE.md, 2.2).
#[test]
fn a_board_that_was_switched_on_and_opened_meanwhile_is_no_fail() {
    let places = [(Kind::TableCrc, 5), (Kind::Commit, 9)];
    let reports = parallel::map(&places, |&before| opened_meanwhile(before, SESSIONS));
    for (before, report) in places.iter().zip(&reports) {
        let is_known = matches!(report.finding, Finding::RightInAnotherSession { .. });
        assert!(is_known, "{before:?}: {}", report.headline());
    }
}

/// WIRE.md, 2.2: the board numbers the sessions, so a greeting in between shows; what the rules of sessions find then is tried again.
#[test]
fn a_board_that_was_switched_on_while_its_sessions_were_judged_passes_and_that_is_told() {
    // Before the greeting that is repeated, and the four that open the next session.
    let places = [4, 7, 8, 9, 10].map(|number| (Kind::Hello, number));
    let reports = parallel::map(&places, |&before| opened_meanwhile(before, 1));
    for (before, report) in places.iter().zip(&reports) {
        let headline = report.headline();
        assert_eq!(report.verdict(), Verdict::Pass, "{before:?}: {headline}");
        assert!(headline.ends_with("; the board went away and came back 1 time"), "{before:?}: {headline}");
    }
}
