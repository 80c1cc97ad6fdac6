//! Links that deliver a second copy of a request late, after newer ones: no sound board is FAIL for it, and no broken one PASS.

use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::Duration;

use halfrow::board::{Board, OpenOptions, Stop};
use halfrow::link::{Candidate, Link, LinkError};
use halfrow::link_test::{self, LinkTestError};
use halfrow::progress::Silent;
use halfrow::result::{CheckName, Finding, Outcome, Report};
use halfrow::run::{Provenance, RunOptions, SessionIds, verify};
use halfrow::verdict::{StoppedBy, Verdict};
use halfrow_protocol::message::{Refusal, RefusalCode, Status};
use halfrow_protocol::{Kind, Reply, Request};
use halfrow_tests::altered::{Altered, Passing, Toward, judge};
use halfrow_tests::system::{System, judge_reconnecting};
use halfrow_tests::through::Through;

/// What a link does to packets that delivers request number `which` of a kind once more, before request number `before` of
/// another that comes after it, and loses the answer to that copy unless `answered`; and whether it has delivered it.
pub(super) fn delivering_late(
    which: (Kind, usize),
    before: (Kind, usize),
    answered: bool,
) -> (impl FnMut(Toward, Passing) -> Vec<Passing> + Send + 'static, Arc<AtomicBool>) {
    let delivered = Arc::new(AtomicBool::new(false));
    let delivers = Arc::clone(&delivered);
    let (mut seen, mut waited) = (0, 0);
    let mut copy: Option<Passing> = None;
    // The answers to be lost, which come in the order of the requests.
    let mut to_lose = VecDeque::new();
    let alter = move |toward, packet: Passing| {
        if toward == Toward::Host {
            let is_answer = to_lose.front() == Some(&(packet.header.kind, packet.header.sequence));
            return if is_answer && to_lose.pop_front().is_some() { Vec::new() } else { vec![packet] };
        }
        let mut passed = Vec::new();
        waited += usize::from(packet.is(before.0) && copy.is_some());
        if waited > before.1
            && let Some(late) = copy.take()
        {
            if !answered {
                to_lose.push_back((late.header.kind, late.header.sequence));
            }
            waited = 0;
            delivers.store(true, Ordering::Relaxed);
            passed.push(late);
        }
        seen += usize::from(packet.is(which.0));
        if packet.is(which.0) && seen == which.1 + 1 {
            copy = Some(packet.clone());
        }
        passed.push(packet);
        passed
    };
    (alter, delivered)
}

/// The report behind a link that is [`delivering_late`], and whether it did.
pub(super) fn late_copy(which: (Kind, usize), before: (Kind, usize), answered: bool) -> (Report, bool) {
    let (alter, delivered) = delivering_late(which, before, answered);
    let report = judge(&System::TINY, alter);
    (report, delivered.load(Ordering::Relaxed))
}

#[test]
fn an_old_copy_of_a_request_makes_no_sound_board_fail() {
    deliver_late(41);
}

#[test]
#[ignore = "a minute long; scripts/soak runs it"]
fn whatever_old_copy_of_a_request_makes_no_sound_board_fail() {
    deliver_late(1);
}

/// Delivers every `step`-th choice of a request late, each in a run of its own.
fn deliver_late(step: usize) {
    let requests = [Kind::Status, Kind::Reset, Kind::TableWrite, Kind::Commit, Kind::Configure];
    let others = [Kind::TableCrc, Kind::Commit, Kind::RowIn, Kind::Status];
    let copies = requests.into_iter().flat_map(|kind| (0..3).map(move |number| (kind, number)));
    let moments: Vec<_> =
        others.into_iter().flat_map(|kind| [0, 3, 40].map(|number| (kind, number))).collect();
    let choices = copies.flat_map(|which| {
        let of_moment = move |&before| [true, false].map(|answered| (which, before, answered));
        moments.iter().flat_map(of_moment)
    });
    let mut ends = Vec::new();
    for (which, before, answered) in choices.step_by(step) {
        let (report, delivered) = late_copy(which, before, answered);
        let what = format!("{which:?} before {before:?}, answered: {answered}: {}", report.headline());
        assert!(delivered && report.verdict() != Verdict::Fail, "{what}");
        ends.push(report.verdict());
    }
    // Most of them do no harm, but some would have.
    let errors = ends.iter().filter(|&&verdict| verdict == Verdict::Error).count();
    assert!(errors > 0 && 2 * errors < ends.len(), "{errors} errors of {}", ends.len());
}

/// How many reads and echoes are wrong in the link test of a link that delivers the first TABLE_WRITE once more before the second
/// TABLE_READ, and whether it did so; a `broken` board reads its tables wrongly.
fn wrong_of_link(broken: bool) -> (u64, bool) {
    let (sender, delivered) = std::sync::mpsc::channel();
    let (mut copy, mut reads) = (None, 0);
    let alter = move |toward, mut packet: Passing| {
        if toward == Toward::Host {
            let last =
                packet.payload.last_mut().filter(|_| broken && packet.header.kind == Kind::TableRead.code());
            last.into_iter().for_each(|byte| *byte ^= 1);
            return vec![packet];
        }
        if packet.is(Kind::TableWrite) && copy.is_none() && reads == 0 {
            copy = Some(packet.clone());
        }
        reads += usize::from(packet.is(Kind::TableRead));
        let late = copy.take_if(|_| reads == 2);
        late.iter().for_each(|_| sender.send(()).unwrap());
        late.into_iter().chain([packet]).collect()
    };
    let link = Altered::new(&halfrow_mock::Options::default(), alter).candidate().link;
    let mut board = Board::open(link, &OpenOptions::default()).unwrap();
    let figures = link_test::run(&mut board, Duration::from_millis(50), 1).unwrap();
    (figures.errors.wrong, delivered.try_recv().is_ok())
}

/// What a link test says of a board that answers no TABLE_WRITE, and before that echoes wrong bytes if it is `broken`.
fn broke_off(broken: bool) -> LinkTestError {
    let alter = move |toward, mut packet: Passing| {
        if toward == Toward::Host {
            let last =
                packet.payload.last_mut().filter(|_| broken && packet.header.kind == Kind::Echo.code());
            last.into_iter().for_each(|byte| *byte ^= 1);
        } else if packet.is(Kind::TableWrite) {
            return Vec::new();
        }
        vec![packet]
    };
    let link = Altered::new(&halfrow_mock::Options::default(), alter).candidate().link;
    let mut board = Board::open(link, &OpenOptions::default()).unwrap();
    link_test::run(&mut board, Duration::from_millis(50), 1).unwrap_err()
}

#[test]
fn a_link_test_that_breaks_off_says_what_was_answered_wrong_by_then() {
    let (sound, broken) = (broke_off(false), broke_off(true));
    assert!(matches!(sound, LinkTestError::Board(_)), "{sound}");
    assert!(matches!(broken, LinkTestError::BrokeOff { wrong: 1.., .. }), "{broken}");
    assert!(broken.to_string().contains("held other bytes than were sent"), "{broken}");
}

/// What happens after a host has found something wrong, before the answer to the STATUS by which it asks whether the link is at
/// fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Ends {
    /// Nothing.
    Never,
    /// The link is cut.
    Cut,
    /// The run is stopped.
    Stopped,
    /// The board has lost the session.
    SessionLost,
}

/// A link that breaks when told to.
pub(super) fn cut_when_told(link: Box<dyn Link>, is_cut: Arc<AtomicBool>) -> Box<dyn Link> {
    Through::boxed(link, move |link, out, back, wait| {
        if is_cut.load(Ordering::Relaxed) {
            return Err(LinkError::Closed { link: link.name(), at: link.now() });
        }
        link.exchange(out, back, wait)
    })
}

/// What a link does to the first session with a board.
struct FirstSession {
    /// Whether it delivers a copy of an old CONFIGURE after the one with gaps, and loses the answer to that copy. If not, all
    /// rows after the one with gaps are wrong.
    is_stale: bool,
    /// The number of the STATUS at which the session ends, from 1, and how it ends.
    ends: (usize, Ends),
    is_cut: Arc<AtomicBool>,
    is_stopped: Arc<AtomicBool>,
    /// How often STATUS was asked for in this session.
    asked: Arc<AtomicUsize>,
    greetings: usize,
    before: Option<Passing>,
    /// The number of the CONFIGURE before the one with gaps.
    old: Option<u16>,
}

impl FirstSession {
    fn alter(&mut self, toward: Toward, packet: Passing) -> Vec<Passing> {
        self.greetings += usize::from(toward == Toward::Board && packet.is(Kind::Hello));
        match toward {
            _ if self.greetings > 1 => vec![packet],
            Toward::Board => self.request(packet),
            Toward::Host => self.answer(packet),
        }
    }

    fn request(&mut self, packet: Passing) -> Vec<Passing> {
        if packet.is(Kind::Status) {
            self.asked.fetch_add(1, Ordering::Relaxed);
        }
        let Some(Request::Configure(configuration)) = packet.request() else { return vec![packet] };
        let before = self.before.replace(packet.clone()).filter(|_| configuration.gap_seed != 0);
        self.old = self.old.or(before.as_ref().map(|before| before.header.sequence));
        [packet].into_iter().chain(before.filter(|_| self.is_stale)).collect()
    }

    /// Ends the session instead of answering STATUS.
    fn end(&self, packet: &Passing) -> Vec<Passing> {
        let refusal = Refusal { code: RefusalCode::Session, kind: Kind::Status.code(), detail: 0 };
        let lost = packet.saying(&Reply::Refusal(refusal));
        self.is_cut.store(self.ends.1 == Ends::Cut, Ordering::Relaxed);
        self.is_stopped.store(self.ends.1 == Ends::Stopped, Ordering::Relaxed);
        Vec::from_iter((self.ends.1 == Ends::SessionLost).then_some(lost))
    }

    fn answer(&self, packet: Passing) -> Vec<Passing> {
        let ends = self.ends.0 == self.asked.load(Ordering::Relaxed) && packet.is(Kind::Status);
        match packet.reply() {
            Some(Reply::Status(_)) if ends => self.end(&packet),
            Some(Reply::Configure) if self.is_stale && self.old == Some(packet.header.sequence) => Vec::new(),
            Some(Reply::RowOut(_)) if self.old.is_some() && !self.is_stale => {
                vec![packet.with_row(|_, packed| packed[0] ^= 1)]
            }
            _ => vec![packet],
        }
    }
}

/// The report on a board behind such a link, and how often STATUS was asked for in the first session.
fn first_session(is_stale: bool, ends: (usize, Ends)) -> (Report, usize) {
    let [is_cut, is_stopped] = [(); 2].map(|()| Arc::new(AtomicBool::new(false)));
    let asked = Arc::new(AtomicUsize::new(0));
    let mut first = FirstSession {
        is_stale,
        ends,
        is_cut: Arc::clone(&is_cut),
        is_stopped: Arc::clone(&is_stopped),
        asked: Arc::clone(&asked),
        greetings: 0,
        before: None,
        old: None,
    };
    let alter = move |toward, packet: Passing| first.alter(toward, packet);
    let candidate = Altered::new(&halfrow_mock::Options::default(), alter).candidate();
    let link = cut_when_told(candidate.link, is_cut);
    let stop = Stop::when(move || is_stopped.load(Ordering::Relaxed).then_some(StoppedBy::Person));
    let options = RunOptions { stop, ..RunOptions::default() };
    let report = verify(&System::TINY.plan(), Candidate { link, ..candidate }, &options, &Silent);
    (report.unwrap().report, asked.load(Ordering::Relaxed))
}

/// The last STATUS of the first session is the one that asks whether a request came twice.
#[test]
fn an_end_amid_the_question_whether_a_request_came_twice_makes_no_sound_board_fail() {
    let (report, last) = first_session(true, (0, Ends::Never));
    let is_known = matches!(report.finding, Finding::RightInAnotherSession { .. });
    assert!(is_known, "{}", report.headline());
    for ends in [Ends::Cut, Ends::Stopped, Ends::SessionLost] {
        let (report, _) = first_session(true, (last, ends));
        assert_eq!(report.verdict(), Verdict::Error, "{ends:?}: {}", report.headline());
    }
}

/// After a stop the board still answers.
#[test]
fn a_stop_amid_that_question_makes_no_error_of_a_board_that_is_wrong() {
    let (report, last) = first_session(false, (0, Ends::Never));
    assert_eq!(report.verdict(), Verdict::Fail, "{}", report.headline());
    let (report, _) = first_session(false, (last, Ends::Stopped));
    assert_eq!(report.verdict(), Verdict::Fail, "{}", report.headline());
}

/// What a host knows of a session that ended amid a segment still holds for what came back in it. The frames after the old copy
/// are wrong, and in the next session all are right.
#[test]
fn an_old_copy_of_a_request_makes_no_sound_board_fail_that_goes_away_later() {
    let is_cut = Arc::new(AtomicBool::new(false));
    let (cuts, mut before, mut left) = (Arc::clone(&is_cut), None, None);
    let alter = move |toward, packet: Passing| {
        let (Toward::Board, Some(Request::Configure(configuration))) = (toward, packet.request()) else {
            left = left.map(|left: u32| left.saturating_sub(u32::from(packet.is(Kind::RowOut))));
            cuts.fetch_or(left == Some(0), Ordering::Relaxed);
            return vec![packet];
        };
        let old = before.replace(packet.clone()).filter(|_| configuration.gap_seed != 0 && left.is_none());
        left = left.or(old.as_ref().map(|_| 3));
        [packet].into_iter().chain(old).collect()
    };
    let sound = || Altered::new(&halfrow_mock::Options::default(), |_, packet| vec![packet]).candidate().link;
    let candidate = Altered::new(&halfrow_mock::Options::default(), alter).candidate();
    let link = cut_when_told(candidate.link, is_cut);
    let candidate = Candidate { link, reopen: Some(Box::new(move || Ok(sound()))), ..candidate };
    let report = judge_reconnecting(&System::TINY.plan(), Some(Duration::from_secs(1000)), candidate);
    assert_eq!(report.link.reconnections.len(), 1);
    let is_known = matches!(report.finding, Finding::RightInAnotherSession { .. });
    assert!(is_known, "{}", report.headline());
}

#[test]
fn an_old_copy_of_a_request_makes_no_link_test_call_a_sound_board_wrong() {
    assert_eq!(wrong_of_link(false), (0, true));
    assert!(wrong_of_link(true).0 > 0);
}

/// A request comes twice, and the counters are wrong after frames that are right. In the session in which that is judged again,
/// nothing comes back.
#[test]
fn no_check_of_a_doubtful_session_is_told_of_the_next_one() {
    let (mut first, mut is_lost) = (None, false);
    let report = judge(&System::TINY, move |toward, packet: Passing| {
        let session = packet.header.session;
        if packet.is(Kind::Echo) && *first.get_or_insert(session) != session {
            return Vec::new();
        }
        if toward == Toward::Host && packet.is(Kind::TableWrite) && !is_lost {
            is_lost = true;
            return Vec::new();
        }
        match packet.reply() {
            Some(Reply::Status(status)) => {
                vec![packet.saying(&Reply::Status(Status { samples_over: 1, ..status }))]
            }
            _ => vec![packet],
        }
    });
    assert_eq!(report.verdict(), Verdict::Error, "{}", report.headline());
    let told = report.checks.iter().filter(|check| check.outcome != Outcome::Skipped);
    let told: Vec<_> = told.map(|check| (check.name, check.outcome)).collect();
    let passed = [CheckName::Judge, CheckName::Identity].map(|name| (name, Outcome::Passed));
    assert_eq!(told, [&passed[..], &[(CheckName::Link, Outcome::Error)]].concat());
}

/// The report behind a link that brings a packet of an earlier session, with the number of HELLO, before the answer to HELLO.
fn after_stale(reply: &'static Reply<'static>) -> Report {
    judge(&System::TINY, move |toward, packet: Passing| {
        if toward == Toward::Board || !packet.is(Kind::Hello) {
            return vec![packet];
        }
        let mut stale = packet.saying(reply);
        stale.header.session = 77;
        vec![stale, packet]
    })
}

/// WIRE.md, 2.1: a host that greets takes nothing but its own reply or refusal.
#[test]
fn what_is_of_an_earlier_session_is_no_answer_to_a_greeting() {
    const BUSY: Refusal = Refusal { code: RefusalCode::Busy, kind: Kind::Configure.code(), detail: 0 };
    const ACK: Refusal = Refusal { code: RefusalCode::Session, kind: Kind::RowAck.code(), detail: 0 };
    for reply in [&Reply::Reset, &Reply::Refusal(BUSY), &Reply::Refusal(ACK)] {
        let report = after_stale(reply);
        assert_eq!(report.verdict(), Verdict::Pass, "{reply:?}: {}", report.headline());
    }
}

/// Without a random first number every program's first packet would have number 1, and a refusal names no nonce.
#[test]
fn a_refusal_that_an_earlier_program_was_told_is_not_this_one_s() {
    let session_ids = SessionIds { nonce: 5, host: 6, sequence: 0xfffe };
    let alter = |toward, packet: Passing| {
        if toward == Toward::Board || !packet.is(Kind::Hello) {
            return vec![packet];
        }
        let refusal = Refusal { code: RefusalCode::Held, kind: Kind::Hello.code(), detail: 37 };
        let mut stale = packet.saying(&Reply::Refusal(refusal));
        stale.header.sequence = 1;
        vec![stale, packet]
    };
    let candidate = Altered::new(&halfrow_mock::Options::default(), alter).candidate();
    let provenance = Provenance { session_ids, ..Provenance::default() };
    let options = RunOptions { provenance, ..RunOptions::default() };
    let report = verify(&System::TINY.plan(), candidate, &options, &Silent).unwrap().report;
    assert_eq!(report.verdict(), Verdict::Pass, "{}", report.headline());
}
