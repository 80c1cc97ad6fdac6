//! Hours at the full pixel clock: everything that was judged is reported, whatever ends them; neither differences nor a board
//! that goes away end them.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::Duration;

use halfrow::board::Stop;
use halfrow::link::{self, Candidate};
use halfrow::progress::{Event, Silent};
use halfrow::report::{self, wording};
use halfrow::result::{
    CheckName, Defect, EqualAtSpeed, Finding, NoBurst, NotExercised, Repetition, Report, SoakDifference,
    SoakInterval, SoakLength, SoakReport,
};
use halfrow::run::{AtSpeed, Plan, RunOptions, verify};
use halfrow::verdict::{Cause, StoppedBy, Verdict};
use halfrow_cli::text;
use halfrow_mock::Options;
use halfrow_protocol::message::{BurstState, Records, Request};
use halfrow_protocol::{Kind, Reply};
use halfrow_tests::altered::{Altered, Passing, Toward};
use halfrow_tests::patience::LIMIT;
use halfrow_tests::program::Folder;
use halfrow_tests::served::{Replug, Served};
use halfrow_tests::system::{System, failed_check};

use crate::stale_packets::delivering_late;

const TINY: System = System::TINY;

fn plan(length: SoakLength) -> Plan {
    Plan { at_speed: AtSpeed::Soak(length), fail_fast: false, ..TINY.plan() }
}

/// A board whose bursts of a minute have 1153 frames: (64·8 + 8) clocks of 10 kHz each.
fn slow() -> Options {
    Options { pixel_clock: 10_000, ..Options::default() }
}

fn frames(frames: u64) -> SoakLength {
    SoakLength::Frames { frames }
}

fn soaked_by(candidate: Candidate, length: SoakLength, options: &RunOptions) -> Report {
    verify(&plan(length), candidate, options, &Silent).unwrap().report
}

fn soaked(target: &str, length: SoakLength) -> Report {
    soaked_by(link::open(&target.parse().unwrap()).unwrap(), length, &RunOptions::default())
}

/// The soak in a report, whose parts must agree.
fn soak(report: &Report) -> &SoakReport {
    let soak = report.soak.as_ref().unwrap();
    let charted = |count: fn(&SoakInterval) -> u64| -> u64 { soak.chart.intervals.iter().map(count).sum() };
    assert_eq!((charted(|it| it.frames), charted(|it| it.wrong)), (soak.frames, soak.wrong), "{soak:?}");
    assert_eq!(report.command(), "soak");
    soak
}

/// The report, and the seeds of the bursts that the host asked for.
fn seeds_of(length: SoakLength) -> (Report, Vec<u32>) {
    let (sender, seeds) = std::sync::mpsc::channel();
    let board = Altered::new(&slow(), move |toward, packet: Passing| {
        if let (Toward::Board, Some(Request::Burst(burst))) = (toward, packet.request()) {
            sender.send(burst.seed).unwrap();
        }
        vec![packet]
    });
    let report = soaked_by(board.candidate(), length, &RunOptions::default());
    (report, seeds.iter().collect())
}

#[test]
fn a_sound_board_passes_with_all_frames_and_other_content_in_each_burst() {
    let (report, mut seeds) = seeds_of(frames(3000));
    assert_eq!(report.verdict(), Verdict::Pass, "{}", report.headline());
    let soak = soak(&report);
    assert_eq!((soak.frames, soak.bursts, soak.wrong), (3000, 3, 0));
    assert_eq!(seeds.len(), 3);
    seeds.sort_unstable();
    seeds.dedup();
    assert_eq!(seeds.len(), 3, "{seeds:x?}");
    let check = report.checks.iter().find(|check| check.name == CheckName::AtSpeed).unwrap();
    assert!(
        matches!(check.finding, Finding::EqualAtSpeed(EqualAtSpeed { frames: 3000, .. })),
        "{}",
        check.detail()
    );
    assert!(!report.not_exercised.contains(&NotExercised::TableChangeAtSpeed {}));
}

#[test]
fn an_hour_is_one_on_the_links_clock() {
    let report = soaked("mock,pixel-clock=10000", SoakLength::Time { seconds: 600.0 });
    assert_eq!(report.verdict(), Verdict::Pass, "{}", report.headline());
    let soak = soak(&report);
    assert!((600.0..601.0).contains(&soak.seconds), "{soak:?}");
    // (64·8 + 8) clocks of 10 kHz each are 52 ms; a burst is a minute at most.
    assert!(soak.bursts >= 10 && (11_530..11_550).contains(&soak.frames), "{soak:?}");
}

/// 20,000 frames have 10 million samples.
#[test]
fn what_comes_once_in_a_while_is_told_each_time_and_ends_nothing() {
    let report = soaked("mock,pixel-clock=10000,fault=slow-path,one-in=1000000", frames(20_000));
    assert_eq!(failed_check(&report), Some(CheckName::AtSpeed), "{}", report.headline());
    let soak = soak(&report);
    assert_eq!(soak.frames, 20_000);
    assert!(soak.wrong > 4 && soak.differences.len() as u64 == soak.wrong, "{soak:?}");
    assert!(report.headline().contains("of 20,000 frames differ"), "{}", report.headline());
    let trapped = |difference: &&SoakDifference| {
        matches!(difference.finding, Finding::DiffersAtSpeed { repetition: Repetition::Trapped { .. }, .. })
    };
    let trapped: Vec<_> = soak.differences.iter().filter(trapped).collect();
    assert!(trapped.first().is_some_and(|first| first.suspects == report.suspects), "{soak:?}");
    for difference in trapped {
        let said = difference.finding.sentence();
        assert!(said.contains("; the same frame had been right ") && !said.contains("repeated"), "{said}");
        let [first, ..] = &difference.suspects[..] else { panic!("{difference:?}") };
        assert!(
            matches!(&first.defect, Defect::SeenAtSpeed { row: Some(_), bits, .. } if bits == &[5]),
            "{first:?}"
        );
    }
    let first_of = |finding: &Finding| match finding {
        Finding::DiffersAtSpeed { first, .. } => *first,
        other => panic!("{other:?}"),
    };
    let firsts: Vec<_> = soak.differences.iter().map(|it| first_of(&it.finding)).collect();
    assert!(firsts.is_sorted() && firsts.first() == Some(&first_of(&report.finding)), "{firsts:?}");
}

#[test]
fn a_miscount_is_told_at_its_frame_of_the_soak_and_when_it_came() {
    let report = soaked("mock,pixel-clock=10000,fault=hidden-pause", frames(2000));
    let [first, second] = &soak(&report).differences[..] else { panic!("{:?}", soak(&report)) };
    assert!(first.seconds < 5.0 && (55.0..65.0).contains(&second.seconds), "{first:?} {second:?}");
    let is_next = matches!(second.finding, Finding::MiscountedAtSpeed { frame: 1153.., .. });
    assert!(first.finding == report.finding && is_next, "{second:?}");
    let page = report::html(&report, &[]).unwrap();
    assert!(page.contains(" have wrong counts.") && page.contains("class=\"wrong\" d=\"M"), "{page}");
}

#[test]
fn a_board_that_is_always_wrong_is_looked_into_so_often_and_then_counted() {
    let report = soaked("mock,pixel-clock=10000,fault=warm-bit,after=1", frames(50_000));
    assert_eq!(failed_check(&report), Some(CheckName::AtSpeed), "{}", report.headline());
    let soak = soak(&report);
    assert_eq!((soak.frames, soak.differences.len()), (50_000, SoakReport::MOST_DIFFERENCES));
    assert!(soak.wrong > 45_000, "{soak:?}");
    let rest = |listed| format!("and {} more differences", soak.bursts as usize - listed);
    let (text, page) = (text::render(&report), report::html(&report, &[]).unwrap());
    assert!(text.contains(&rest(10)), "{text}");
    assert!(page.contains(&rest(SoakReport::MOST_DIFFERENCES)), "{page}");
}

/// The report on a soak that is stopped when `frames` of its frames are judged.
fn stopped_at(target: &str, frames: u32) -> Report {
    let judged = Arc::new(AtomicU32::new(0));
    let stop = Stop::when({
        let judged = Arc::clone(&judged);
        move || (judged.load(Ordering::Relaxed) >= frames).then_some(StoppedBy::Person)
    });
    let told = |event: Event| {
        if let Event::Soaked(soaked) = event {
            judged.store(soaked.frames as u32, Ordering::Relaxed);
        }
    };
    let options = RunOptions { stop, ..RunOptions::default() };
    let candidate = link::open(&target.parse().unwrap()).unwrap();
    verify(&plan(self::frames(u64::MAX)), candidate, &options, &told).unwrap().report
}

#[test]
fn an_interruption_leaves_what_was_judged_until_then() {
    let report = stopped_at("mock,pixel-clock=10000", 5000);
    assert_eq!((report.verdict(), soak(&report).wrong), (Verdict::Error, 0), "{}", report.headline());
    assert!(report.headline().contains("stopped by hand"), "{}", report.headline());
    assert!(soak(&report).frames >= 5000);
}

#[test]
fn what_differed_is_no_error_for_being_interrupted() {
    let report = stopped_at("mock,pixel-clock=10000,fault=slow-path,one-in=1000000", 10_000);
    assert_eq!(failed_check(&report), Some(CheckName::AtSpeed), "{}", report.headline());
    assert!(soak(&report).wrong > 0);
    let said = wording::soak(soak(&report));
    assert!(said.contains("; it ended early: ") && said.contains("stopped by hand"), "{said}");
}

/// The stop comes before it is checked whether the link may be the cause.
#[test]
fn what_differed_in_the_burst_that_is_interrupted_is_no_error_either() {
    let report = stopped_at("mock,pixel-clock=10000,fault=slow-path,one-in=2", 1);
    assert_eq!(failed_check(&report), Some(CheckName::AtSpeed), "{}", report.headline());
}

#[test]
fn without_bursts_nothing_is_judged() {
    let report = soaked("mock,bursts=no", frames(10));
    assert_eq!(report.cause, Cause::NothingJudged, "{}", report.headline());
    assert_eq!(report.finding, Finding::NothingAtSpeed { reason: NoBurst::BoardMakesNone {} });
    assert_eq!(soak(&report).frames, 0);
}

/// The report on a board that begins every burst, makes no frame, and ends the burst when told to.
fn without_frames(pixel_clock: u32, length: SoakLength) -> Report {
    let mut state = BurstState::UnderWay;
    let options = Options { pixel_clock, ..Options::default() };
    let board = Altered::new(&options, move |toward, packet: Passing| {
        if let (Toward::Board, Some(Request::Burst(burst))) = (toward, packet.request()) {
            state = if burst.frames == 0 { BurstState::Ended } else { BurstState::UnderWay };
        }
        match packet.reply() {
            Some(Reply::Records(found)) => {
                vec![packet.saying(&Reply::Records(Records { state, bytes: &[], ..found }))]
            }
            _ => vec![packet],
        }
    });
    let options = RunOptions { timeout: Some(Duration::from_secs(1000)), ..RunOptions::default() };
    soaked_by(board.candidate(), length, &options)
}

#[test]
fn a_soak_that_is_over_before_any_frame_has_come_judged_nothing() {
    let report = without_frames(96_000_000, SoakLength::Time { seconds: 0.36 });
    assert_eq!(report.cause, Cause::NothingJudged, "{}", report.headline());
    assert_eq!((report.finding.clone(), soak(&report).frames), (Finding::NothingJudged {}, 0));
}

/// (64·8 + 8) clocks of 100 Hz are 5.2 s a frame: 20 frames take more than the minute of a burst.
#[test]
fn a_soak_ends_with_a_burst_of_a_minute_without_a_frame() {
    for length in [frames(10), SoakLength::Time { seconds: 3600.0 }] {
        let report = without_frames(100, length);
        let is_stalled = matches!(report.finding, Finding::BurstStalled { frame: 0, seconds: 60.0, .. });
        assert!(is_stalled && report.cause == Cause::Station, "{}", report.headline());
    }
}

/// The mock makes the frames of a burst of a minute all at once.
#[test]
fn a_time_limit_ends_a_soak_amid_a_minute_in_which_nothing_comes() {
    let options = RunOptions { timeout: Some(Duration::from_secs(30)), ..RunOptions::default() };
    let board = link::open(&"mock,pixel-clock=10000".parse().unwrap()).unwrap();
    let report = soaked_by(board, frames(3000), &options);
    assert_eq!((report.verdict(), soak(&report).wrong), (Verdict::Error, 0), "{}", report.headline());
    assert!((30.0..31.0).contains(&report.link.seconds), "{}", report.link.seconds);
}

#[test]
fn with_one_bank_tables_change_between_bursts() {
    let report = soaked("mock,pixel-clock=10000,table-banks=1,bursts=untrapped", frames(3000));
    assert_eq!(report.verdict(), Verdict::Pass, "{}", report.headline());
    assert!(report.not_exercised.contains(&NotExercised::TableChangeAtSpeed {}));
}

/// The report on a board that is unplugged amid its bursts, after `byte` bytes.
fn unplugged(byte: u64, replug: Replug) -> Report {
    let folder = Folder::new();
    let served = Served::unplugged_once("mock", &folder.path().join("board"), byte, Some(replug));
    let candidate = link::open(&served.target().parse().unwrap()).unwrap();
    let options = RunOptions { reconnect: Some(LIMIT), ..RunOptions::default() };
    soaked_by(candidate, frames(4000), &options)
}

#[test]
fn a_board_that_was_unplugged_is_judged_on_and_whether_it_had_its_power_is_said() {
    // Frames that are streamed take some 50,000 bytes, and 4000 records 72,000.
    for (replug, kept) in [
        (Replug::Powered, true),
        (Replug::Switched("mock".to_owned()), false),
        (Replug::Reset("mock".to_owned()), false),
    ] {
        let what = format!("{replug:?}");
        let report = unplugged(80_000, replug);
        assert_eq!(report.verdict(), Verdict::Pass, "{what}: {}", report.headline());
        assert_eq!(soak(&report).frames, 4000, "{what}");
        assert!(soak(&report).bursts >= 2, "{what}");
        let kept_tables: Vec<_> = report.link.reconnections.iter().map(|away| away.kept_tables).collect();
        assert_eq!(kept_tables, [Some(kept)], "{what}");
    }
}

/// The report behind a link that is [`delivering_late`], and whether it did.
fn late_copy(which: (Kind, usize), before: (Kind, usize)) -> (Report, bool) {
    let (alter, delivered) = delivering_late(which, before, true);
    let options = RunOptions { timeout: Some(Duration::from_secs(1000)), ..RunOptions::default() };
    let report = soaked_by(Altered::new(&slow(), alter).candidate(), frames(3000), &options);
    (report, delivered.load(Ordering::Relaxed))
}

#[test]
fn an_old_copy_of_a_request_makes_no_sound_board_fail() {
    let moments = [(Kind::Burst, 0), (Kind::Records, 3), (Kind::Records, 30), (Kind::TableCrc, 2)];
    for which in [Kind::Burst, Kind::TableWrite, Kind::Commit, Kind::Configure, Kind::Reset] {
        for before in moments {
            let (report, delivered) = late_copy((which, 1), before);
            let what = format!("{which:?} {before:?}: {}", report.headline());
            // RESET ends a burst, and takes away the tables of the next one.
            let right = if which == Kind::Reset { Verdict::Error } else { Verdict::Pass };
            assert!(delivered, "{what}");
            assert_eq!(report.verdict(), right, "{what}");
        }
    }
}

/// The report on a board behind a link that loses every `every`-th answer, with every signature `spoilt`, or none.
fn over_a_link_that_loses(every: usize, spoilt: bool) -> Report {
    let mut answers = 0;
    let board = Altered::new(&slow(), move |toward, packet: Passing| {
        if toward == Toward::Board {
            return vec![packet];
        }
        answers += 1;
        if answers % every == 0 {
            return Vec::new();
        }
        if !spoilt {
            return vec![packet];
        }
        vec![packet.with_records(|_, records| records.iter_mut().for_each(|record| record.signature ^= 1))]
    });
    soaked_by(board.candidate(), frames(5000), &RunOptions::default())
}

/// The first BURST arrives once more before the third, which the board then refuses.
#[test]
fn what_a_board_says_after_an_old_burst_does_not_end_a_soak() {
    let (mut bursts, mut first) = (0, None);
    let board = Altered::new(&slow(), move |toward, packet: Passing| {
        let is_burst = toward == Toward::Board && packet.is(Kind::Burst);
        bursts += u32::from(is_burst);
        if is_burst && bursts == 1 {
            first = Some(packet.clone());
        }
        let old = first.take_if(|_| bursts == 3);
        old.into_iter().chain([packet]).collect()
    });
    let report = soaked_by(board.candidate(), frames(3000), &RunOptions::default());
    assert_eq!(soak(&report).frames, 3000, "{}", report.headline());
    assert_eq!(report.verdict(), Verdict::Error, "{}", report.headline());
    assert!(matches!(report.finding, Finding::RightInAnotherSession { .. }), "{}", report.headline());
    assert!(!report.headline().contains("stop whatever else"), "{}", report.headline());
}

/// Lost answers make requests come twice, which raises doubt. A fault that stays is not the link's.
#[test]
fn over_a_link_that_loses_answers_sound_boards_do_not_fail_and_broken_ones_do_not_pass() {
    for every in [31, 53, 211] {
        let sound = over_a_link_that_loses(every, false);
        assert_eq!(sound.verdict(), Verdict::Pass, "{every}: {}", sound.headline());
        let broken = over_a_link_that_loses(every, true);
        assert_eq!(failed_check(&broken), Some(CheckName::AtSpeed), "{every}: {}", broken.headline());
    }
    // Each burst has a request that comes twice.
    let doubtful = over_a_link_that_loses(7, true);
    assert_ne!(doubtful.verdict(), Verdict::Pass, "{}", doubtful.headline());
}

/// A board that sends what its host did not ask for gives no verdict, and what was judged before is reported.
#[test]
fn records_that_end_too_soon_are_no_verdict() {
    let mut left = 3;
    let board = Altered::new(&Options::default(), move |_, packet: Passing| match packet.reply() {
        Some(Reply::Records(found)) if left > 0 => {
            left -= 1;
            vec![packet.saying(&Reply::Records(found))]
        }
        Some(Reply::Records(found)) => {
            let state = BurstState::Ended;
            vec![packet.saying(&Reply::Records(Records { state, bytes: &[], ..found }))]
        }
        _ => vec![packet],
    });
    let report = soaked_by(board.candidate(), frames(10_000), &RunOptions::default());
    assert_eq!(report.cause, Cause::Station, "{}", report.headline());
    assert!(
        matches!(report.finding, Finding::BurstEndedEarly { frames: 10_000, .. }),
        "{}",
        report.headline()
    );
    assert!(soak(&report).frames > 0);
}
