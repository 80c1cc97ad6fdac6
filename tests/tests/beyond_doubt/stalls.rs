//! Links that only stall: a sound board passes.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use halfrow::link::Candidate;
use halfrow::report::wording;
use halfrow::result::{NotExercised, Report, SoakLength};
use halfrow::run::{AtSpeed, Plan};
use halfrow::verdict::Verdict;
use halfrow_mock::Options;
use halfrow_protocol::Kind;
use halfrow_tests::altered::{Altered, Passing, Toward, judge};
use halfrow_tests::proxy::{Proxy, Suffers};
use halfrow_tests::served::Served;
use halfrow_tests::system::{System, judge_by_plan, open, streamed};
use halfrow_tests::through::Through;

/// A system on which such a link once led to a false FAIL.
const SEEN: System = System { width: 128, height: 72, radius: 73.78, board: "mock", ring: 2048 };

const STALL: Duration = Duration::from_secs(3);

#[track_caller]
fn passes(report: &Report, what: &str) {
    assert_eq!(report.verdict(), Verdict::Pass, "{what}: {}", report.headline());
}

/// Judges a served board through a proxy that stalls both directions after every 12,000 bytes from the host.
#[track_caller]
fn passes_behind_a_proxy(system: &System) {
    let served = Served::on_a_tcp_port("127.0.0.1", "mock");
    let stalls = Suffers::Stalls { every: 12_000, time: STALL, both: true };
    let proxy = Proxy::before(served.address(), stalls, Suffers::Nothing, 0);
    passes(&system.judge_at(proxy.target()), "behind a proxy");
}

#[test]
fn a_proxy_that_stands_still_now_and_then_costs_no_verdict() {
    passes_behind_a_proxy(&System { height: 16, ..SEEN });
}

/// A sound board on a link that only stalls, at the size at which that once led to FAIL.
#[test]
#[ignore = "a minute long; scripts/soak runs it"]
fn the_link_that_gave_a_false_fail_passes() {
    passes_behind_a_proxy(&SEEN);
}

#[test]
fn on_the_virtual_clock_every_stall_within_the_patience_passes() {
    for every in [5000, 8000, 12_000, 24_000] {
        for (toward, longest) in [("board", 9.0), ("host", 9.0), ("both", 5.0)] {
            for seconds in [0.5, 3.0, longest] {
                let options = format!(",fault=stall,every={every},seconds={seconds},toward={toward}");
                passes(&SEEN.judge(&options), &options);
            }
        }
    }
}

/// Of thousands of packets, three in a row get lost at some time. After that, the wait for a lost packet is no longer than it was
/// before.
#[test]
fn a_link_that_only_loses_packets_is_not_waited_for_as_one_that_is_late() {
    let options = ",fault=lose,size=40,rate=0.085,toward=board,seed=87657095";
    let report = System::TINY.judge(options);
    passes(&report, options);
    let seconds_each = report.link.seconds / report.link.retries as f64;
    assert!((0.2..1.0).contains(&seconds_each), "{seconds_each} s on the wire's own clock");
}

/// Each answer to STATUS comes together with the answer to the next try, so the link loses nothing, but each is asked for twice.
#[test]
fn a_link_that_holds_each_count_back_comes_to_an_end() {
    let mut held = None;
    let report = judge(&System::TINY, move |toward, packet| {
        if toward == Toward::Board || !packet.is(Kind::Status) {
            return vec![packet];
        }
        match held.take() {
            None => {
                held = Some(packet);
                Vec::new()
            }
            Some(first) => vec![first, packet],
        }
    });
    assert_eq!(report.verdict(), Verdict::Pass, "{}", report.headline());
}

/// The report by `plan` over a link that takes nothing for 3 s of its own clock, once `before` bytes have gone to the board.
fn taking_nothing_after(before: usize, plan: &Plan) -> Report {
    let candidate = open("mock");
    let (mut sent, mut until) = (0, None);
    let link = Through::boxed(candidate.link, move |link, out, back, wait| {
        if sent >= before && link.now() < *until.get_or_insert(link.now() + STALL) {
            link.exchange(&[], back, wait)?;
            return Ok(0);
        }
        let taken = link.exchange(out, back, wait)?;
        sent += taken;
        Ok(taken)
    });
    judge_by_plan(plan, Candidate { link, ..candidate })
}

/// In the echoes, in the tables and in the rules; and among rows of which more than the host keeps ready wait.
#[test]
fn what_a_link_has_not_taken_yet_is_not_sent_again() {
    let wide = streamed(System { width: 1920, height: 16, radius: 1106.7, ..SEEN }.plan());
    let tiny = System::TINY.plan();
    for (before, plan) in [(1000, &tiny), (10_000, &tiny), (200_000, &tiny), (100_000, &wide)] {
        let report = taking_nothing_after(before, plan);
        passes(&report, &format!("{before} bytes"));
        assert!(report.link.seconds > STALL.as_secs_f64(), "{before} bytes: {:?}", report.link);
        assert_eq!((report.link.retries, report.link.strays), (0, 0), "{before} bytes: {:?}", report.link);
    }
}

/// The zero behind an answer is the first byte that the stall keeps back.
#[test]
fn a_link_that_stalls_before_a_zero_is_not_called_a_board_without_zeros() {
    let candidate = open("mock");
    let (mut came, mut last, mut held, mut until) = (0, 0, Vec::new(), None);
    let link = Through::boxed(candidate.link, move |link, out, back, wait| {
        let mut new = Vec::new();
        let taken = link.exchange(out, &mut new, wait)?;
        let now = link.now();
        for byte in new {
            came += 1;
            if came > 2000 && byte == 0 && last != 0 {
                until.get_or_insert(now + STALL);
            }
            last = byte;
            held.push(byte);
            if until.is_none_or(|until| now >= until) {
                back.append(&mut held);
            }
        }
        Ok(taken)
    });
    let report = judge_by_plan(&System::TINY.plan(), Candidate { link, ..candidate });
    passes(&report, "before a zero");
    assert!(report.link.seconds > STALL.as_secs_f64(), "{:?}", report.link);
}

/// The report on a board of 10 kHz whose host stands still for the time `still` right after the first answer of this `kind` that comes
/// with or after the one that its first burst has begun.
fn standing_still_after(kind: Kind, still: Duration, at_speed: AtSpeed) -> Report {
    let begun = Arc::new(AtomicBool::new(false));
    let begins = Arc::clone(&begun);
    let mut has_burst = false;
    let alter = move |toward, packet: Passing| {
        has_burst |= packet.is(Kind::Burst);
        begins.fetch_or(has_burst && toward == Toward::Host && packet.is(kind), Ordering::Relaxed);
        vec![packet]
    };
    let options = Options { pixel_clock: 10_000, ..Options::default() };
    let candidate = Altered::new(&options, alter).candidate();
    let mut stood = false;
    let link = Through::boxed(candidate.link, move |link, out, back, wait| {
        let taken = link.exchange(out, back, wait)?;
        if begun.load(Ordering::Relaxed) && !std::mem::replace(&mut stood, true) {
            let until = link.now() + still;
            while link.now() < until {
                link.exchange(&[], back, until - link.now())?;
            }
        }
        Ok(taken)
    });
    judge_by_plan(&Plan { at_speed, ..System::TINY.plan() }, Candidate { link, ..candidate })
}

/// A board ends a burst and its session when it hears nothing for 10 s (AT-SPEED.md, Ends).
#[test]
fn a_host_that_stood_still_while_its_board_made_frames_says_so_of_itself() {
    let after = |still| {
        let long = AtSpeed::For(Duration::from_secs(30));
        standing_still_after(Kind::Burst, Duration::from_secs(still), long).headline()
    };
    let own = "the board no longer knows this session: this computer sent it nothing for 14.0 s";
    let said = after(14);
    assert!(said.contains(own), "{said}");
    let said = after(9);
    assert!(!said.contains("no longer knows"), "{said}");
}

/// Of 90 s, 12 s pass before the second burst, while its tables are uploaded; that itself takes less than a second.
#[test]
fn a_soak_says_for_how_long_no_frames_were_made() {
    let soaked = |still| {
        let length = AtSpeed::Soak(SoakLength::Time { seconds: 90.0 });
        let report = standing_still_after(Kind::Commit, Duration::from_secs(still), length);
        passes(&report, "a soak");
        let idle = |part: &NotExercised| match part {
            NotExercised::IdleTime { seconds } => Some(*seconds),
            _ => None,
        };
        let said = wording::soak(report.soak.as_ref().unwrap());
        (report.not_exercised.iter().find_map(idle), said)
    };
    let (idle, said) = soaked(12);
    assert_eq!(idle, Some(12), "{said}");
    assert!(said.starts_with("1 min 30 s of 1 min 30 s, with frames in 1 min 18 s of it: "), "{said}");
    let (idle, said) = soaked(0);
    assert!(idle.is_none() && said.starts_with("1 min 30 s of 1 min 30 s: "), "{idle:?}, {said}");
}

/// Whoever asks for frames has them all, however long they took.
#[test]
fn a_soak_of_so_many_frames_is_none_the_shorter_for_time_without_frames() {
    let length = AtSpeed::Soak(SoakLength::Frames { frames: 1200 });
    let report = standing_still_after(Kind::Commit, Duration::from_secs(12), length);
    passes(&report, "a soak");
    let soak = report.soak.as_ref().unwrap();
    assert!(soak.frames == 1200 && soak.idle_seconds > soak.seconds / 10.0, "{soak:?}");
    assert!(!report.not_exercised.iter().any(|part| matches!(part, NotExercised::IdleTime { .. })));
}
