//! Boards with a slow pixel clock, behind links that insert zeros between packets, which mean nothing: they pass, unless their
//! clock differs from the one that they name.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use halfrow::link::Candidate;
use halfrow::result::{Check, CheckName, Finding, NotExercised, Report};
use halfrow::run::{Part, Plan, Selection};
use halfrow::verdict::Verdict;
use halfrow_mock::Options;
use halfrow_protocol::Reply;
use halfrow_protocol::message::{BurstState, FrameRecord, Records, Request};
use halfrow_tests::altered::{Altered, Passing, Toward};
use halfrow_tests::system::{System, failed_check, judge_by_plan};
use halfrow_tests::through::Through;

/// 10 kHz, in Hz.
const CLOCK: u32 = 10_000;
/// How long such a board takes for up to three frames of the least width, in milliseconds: the longest have 8 rows of some 100
/// clocks.
const TAKES: u64 = 330;
const FEW: u32 = 3;
/// The time between two zeros.
const BETWEEN: Duration = Duration::from_millis(2);

/// `candidate` behind a link that inserts a zero now and then while nothing else comes, and that tells `clock` the time on its own, in
/// milliseconds.
fn trickling(candidate: Candidate, clock: Arc<AtomicU64>) -> Candidate {
    let link = Through::boxed(candidate.link, move |link, out, back, wait| {
        let taken = link.exchange(out, back, wait.min(BETWEEN))?;
        clock.store(link.now().as_millis() as u64, Ordering::Relaxed);
        if taken == 0 && back.is_empty() && wait >= BETWEEN {
            back.push(0);
        }
        Ok(taken)
    });
    Candidate { link, ..candidate }
}

/// A sound board that makes few frames as slowly as its clock demands. The mock alone would take no time.
fn slow_board() -> Candidate {
    board_of(0, |_| TAKES)
}

/// A board that names `source` as its clock source. For few frames it takes as many milliseconds as `takes` returns for the
/// number of bursts begun before.
fn board_of(source: u8, takes: impl Fn(usize) -> u64 + Send + 'static) -> Candidate {
    let clock = Arc::new(AtomicU64::new(0));
    let (now, mut begun) = (Arc::clone(&clock), BTreeMap::new());
    let alter = move |toward, packet: Passing| {
        let now = now.load(Ordering::Relaxed);
        match (toward, packet.request(), packet.reply()) {
            (Toward::Board, Some(Request::Burst(burst)), _) if (1..=FEW).contains(&burst.frames) => {
                let takes = takes(begun.len());
                begun.entry(burst.burst).or_insert((now, takes));
            }
            (Toward::Host, _, Some(Reply::Capabilities(mut capabilities))) => {
                capabilities.clock_source = source;
                return vec![packet.saying(&Reply::Capabilities(capabilities))];
            }
            (Toward::Host, _, Some(Reply::Records(records)))
                if begun.get(&records.burst).is_some_and(|&(begun, takes)| now < begun + takes) =>
            {
                // One frame after a third of the time, another after two thirds.
                let (begun, takes) = begun[&records.burst];
                let made = ((now - begun) * u64::from(FEW) / takes) as usize;
                let come = made.saturating_sub(records.from as usize).min(records.bytes.len());
                let some = Records { state: BurstState::UnderWay, bytes: &records.bytes[..come], ..records };
                return vec![packet.saying(&Reply::Records(some))];
            }
            _ => {}
        }
        vec![packet]
    };
    let options = Options { pixel_clock: CLOCK, ..Options::default() };
    trickling(Altered::new(&options, alter).candidate(), clock)
}

#[track_caller]
fn passes(plan: &Plan) {
    let report = judge_by_plan(plan, slow_board());
    assert_eq!(report.verdict(), Verdict::Pass, "{}", report.headline());
}

#[test]
fn its_frames_at_speed_are_waited_for() {
    passes(&Plan { selection: Some(Selection::least().with(Part::AtSpeed, 3)), ..System::TINY.plan() });
}

#[test]
fn its_bursts_are_waited_for_where_rules_are_tried() {
    passes(&Plan { selection: Some(Selection::least().with(Part::Rules, 1)), ..System::TINY.plan() });
}

/// A simulated board may take far longer for a frame than the clock that it names.
#[test]
fn a_burst_is_waited_for_as_long_as_its_frames_come() {
    let plan = Plan { selection: Some(Selection::least().with(Part::Rules, 1)), ..System::TINY.plan() };
    let report = judge_by_plan(&plan, board_of(0, |_| 12_000));
    assert_eq!(report.verdict(), Verdict::Pass, "{}", report.headline());
}

/// The report on a board that begins a frame only `late` milliseconds after the one before has its record, by the link's
/// clock. So it holds none back that may begin earlier.
fn beginning_late(late: u64) -> Report {
    let clock = Arc::new(AtomicU64::new(0));
    let options = Options::default();
    let (now, kept) = (Arc::clone(&clock), u32::from(options.records));
    let (mut of, mut full_since, mut in_time) = ((0, 0), None, BTreeSet::new());
    let alter = move |toward, packet: Passing| {
        let now = now.load(Ordering::Relaxed);
        match (toward, packet.request(), packet.reply()) {
            (Toward::Board, Some(Request::Records { from }), _)
                if from > of.1
                    && from <= of.1 + kept
                    && full_since.take().is_some_and(|since| now - since < late) =>
            {
                in_time.insert((of.0, of.1 + kept));
            }
            (Toward::Host, _, Some(Reply::Records(records))) => {
                of = (records.burst, records.from);
                if records.bytes.len() == kept as usize {
                    full_since.get_or_insert(now);
                }
                let said = records.bytes.iter().zip(records.from..).map(|(&record, n)| {
                    let record = FrameRecord::from(record);
                    let held_back = record.held_back && !in_time.contains(&(records.burst, n));
                    FrameRecord { held_back, ..record }.to_bytes()
                });
                let bytes: Vec<_> = said.collect();
                return vec![packet.saying(&Reply::Records(Records { bytes: &bytes, ..records }))];
            }
            _ => {}
        }
        vec![packet]
    };
    let candidate = trickling(Altered::new(&options, alter).candidate(), clock);
    let plan = Plan { selection: Some(Selection::least().with(Part::Rules, 1)), ..System::TINY.plan() };
    judge_by_plan(&plan, candidate)
}

#[test]
fn a_frame_that_could_begin_before_a_record_was_wanted_need_not_say_that_it_was_held_back() {
    for late in [30, 1000] {
        let report = beginning_late(late);
        assert_eq!(report.verdict(), Verdict::Pass, "{late} ms: {}", report.headline());
    }
    let never = beginning_late(u64::from(u32::MAX));
    assert_eq!(failed_check(&never), Some(CheckName::Rules), "{}", never.headline());
    assert!(never.headline().contains("RECORDS"), "{}", never.headline());
}

/// Values of clock_source (WIRE.md, 01).
const PIXCLK: u8 = 1;
const PLL: u8 = 2;

/// The report on a board of which only frames at speed are judged.
fn judged(source: u8, takes: impl Fn(usize) -> u64 + Send + 'static) -> Report {
    let selection = Some(Selection::least().with(Part::AtSpeed, 3));
    judge_by_plan(&Plan { selection, ..System::TINY.plan() }, board_of(source, takes))
}

/// 3 frames of 520 clocks at 10 kHz are 156 ms.
#[test]
fn a_board_s_own_clock_is_the_one_that_it_names() {
    let right = judged(PLL, |_| 156);
    assert_eq!(right.verdict(), Verdict::Pass, "{}", right.headline());
    for (takes, sentence) in [(0, " or more"), (3000, " Hz to ")] {
        let wrong = judged(PLL, move |_| takes);
        assert_eq!(wrong.verdict(), Verdict::Fail, "{takes} ms: {}", wrong.headline());
        assert!(
            matches!(wrong.finding, Finding::ClockNotAsNamed { clock_hz: CLOCK, .. }),
            "{}",
            wrong.headline()
        );
        assert!(wrong.headline().contains(sentence), "{}", wrong.headline());
    }
}

fn is_named(part: &NotExercised) -> bool {
    matches!(part, NotExercised::NamedClock { clock_hz: CLOCK, .. })
}

/// Whoever feeds PIXCLK is not judged.
#[test]
fn another_clock_from_outside_is_named_beside_a_pass() {
    let report = judged(PIXCLK, |_| 3000);
    assert_eq!(report.verdict(), Verdict::Pass, "{}", report.headline());
    assert!(report.not_exercised.iter().any(is_named), "{:?}", report.not_exercised);
    let details: Vec<_> = report.checks.iter().map(Check::detail).collect();
    assert!(details.iter().any(|detail| detail.contains("at a claimed 10.0 kHz")), "{details:?}");
}

/// It can never be FAIL.
#[test]
fn a_clock_from_outside_is_looked_at_once() {
    let most = Arc::new(AtomicU64::new(0));
    let begun = Arc::clone(&most);
    judged(PIXCLK, move |before| {
        begun.fetch_max(before as u64 + 1, Ordering::Relaxed);
        3000
    });
    assert_eq!(most.load(Ordering::Relaxed), 1);
}

/// A host that is frozen together with its clock sees a burst end before it can. Three short frames give neither bound that would
/// clear it, nor do they for a clock that was seen to be slow.
#[test]
fn what_is_seen_once_of_a_clock_is_looked_at_again() {
    for takes in [0, 3000] {
        let report = judged(PLL, move |before| if before == 0 { takes } else { 156 });
        assert_eq!(report.verdict(), Verdict::Pass, "{takes} ms: {}", report.headline());
        assert!(report.not_exercised.iter().any(is_named), "{takes} ms: {:?}", report.not_exercised);
    }
}

/// A mock does not keep to its clock.
#[test]
fn a_clock_that_is_the_host_s_own_is_not_looked_at() {
    let report = judged(0, |_| 3000);
    assert_eq!(report.verdict(), Verdict::Pass, "{}", report.headline());
}
