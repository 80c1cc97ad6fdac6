//! Runs that are given a time limit.

use std::time::Duration;

use halfrow::progress::Silent;
use halfrow::result::{CheckName, Finding, Report, WithinReport};
use halfrow::run::{AtSpeed, Misfit, Plan, RunOptions, Vary, WithinError, verify};
use halfrow::target::BoardKind;
use halfrow::verdict::Verdict;
use halfrow_tests::system::{System, failed_check, open};

const ROWS: usize = 16;
/// A whole run on this board takes 5.7 s.
const SLOW: &str = "mock,speed=20000";

fn plan(seconds: f64) -> Plan {
    let system = System { height: ROWS, ..System::TINY };
    let vary = Vary { centre: true, depth: true };
    let within = Some(Duration::from_secs_f64(seconds));
    Plan { within, vary, fail_fast: false, ..system.plan() }
}

fn judged(board: &str, plan: &Plan) -> Result<Report, Misfit> {
    verify(plan, open(board), &RunOptions::default(), &Silent).map(|finished| finished.report)
}

fn within(report: &Report) -> &WithinReport {
    report.within.as_ref().unwrap()
}

fn taken(report: &Report, part: &str) -> usize {
    within(report).parts.iter().find(|it| it.part == part).unwrap().taken
}

#[test]
fn a_run_ends_within_its_time_on_the_links_clock_and_takes_more_the_more_it_has() {
    let _alone = crate::RUNS.lock();
    for board in [SLOW, "mock,speed=60000,delay=0.002", "mock,speed=100000,delay=0.0002"] {
        let mut last = (0, 0);
        for seconds in [1.0, 1.5, 2.5, 4.0, 6.0, 12.0, 36.0] {
            let report = judged(board, &plan(seconds)).unwrap();
            assert_eq!(report.verdict(), Verdict::Pass, "{board}: {}", report.headline());
            let within = within(&report);
            assert!(report.link.seconds <= seconds, "{board}: {} of {seconds} s", report.link.seconds);
            assert!(report.link.seconds <= within.expected_seconds, "{board}: {within:?}");
            assert!(within.expected_seconds <= 0.95 * seconds, "{board}: {within:?}");
            let rows: usize = report.frames.iter().map(|frame| frame.rows).sum();
            assert!((within.found, rows) >= last, "{board}: {rows} rows in {seconds} s");
            last = (within.found, rows);
        }
        // 19 frames of 16 rows.
        assert_eq!(last.1, 19 * ROWS, "{board}");
    }
}

#[test]
fn a_link_that_takes_no_time_has_time_for_everything() {
    let _alone = crate::RUNS.lock();
    let report = judged("mock", &plan(1.0)).unwrap();
    let within = within(&report);
    assert!(within.parts.iter().all(|part| part.taken == part.of), "{within:?}");
    assert!(within.bytes_per_second.is_none());
    assert!(report.frames.iter().all(|frame| frame.first_rows.is_none()));
    let points = within.curve.windows(2);
    assert!(
        within.curve.len() > 2 && points.into_iter().all(|two| two[0].found < two[1].found),
        "{within:?}"
    );
    // A whole run also finds faults that no single part is known to find.
    assert!(within.curve.last().is_some_and(|last| last.found == within.found), "{within:?}");
}

/// Where rows are so narrow that several come at once, the link stands still until they are acknowledged; how many come at once
/// changes at a width of 88, and again at 144.
#[test]
fn the_time_is_kept_with_narrow_rows_on_a_link_with_a_long_round_trip() {
    let _alone = crate::RUNS.lock();
    for board in
        ["mock,speed=300000,delay=0.0005", "mock,speed=300000,delay=0.001", "mock,speed=1200000,delay=0.0005"]
    {
        for width in [64, 84, 88, 128, 140, 144, 160] {
            let system = System { width, height: 72, radius: 90.0, ..System::TINY };
            for seconds in [0.5, 1.0] {
                let within = Some(Duration::from_secs_f64(seconds));
                let plan = Plan { within, fail_fast: false, ..system.plan() };
                let report = judged(board, &plan).unwrap();
                let took = report.link.seconds;
                let what = format!("{board}, width {width}: {took} of {seconds} s");
                assert_eq!(report.verdict(), Verdict::Pass, "{what}: {}", report.headline());
                assert!(took <= seconds, "{what}");
            }
        }
    }
}

#[test]
fn what_is_covered_is_found_and_what_is_left_out_passes_and_is_named() {
    let _alone = crate::RUNS.lock();
    let Err(Misfit::Within(WithinError::TooFew { least, .. })) = judged(SLOW, &plan(0.2)) else { panic!() };
    let short = plan(least + 0.15);
    let sound = judged(SLOW, &short).unwrap();
    // Samples of every kind meet the stuck line in the first row.
    let found = judged(&format!("{SLOW},fault=stuck-data"), &short).unwrap();
    assert_eq!(failed_check(&found), Some(CheckName::Frames), "{}", found.headline());

    let most = report_rows(&sound);
    assert!((1..ROWS).contains(&most), "{:?}", within(&sound));
    let behind = format!("{SLOW},entered=no,fault=spoilt-row,row={most}");
    let unseen = judged(&behind, &short).unwrap();
    assert_eq!(unseen.verdict(), Verdict::Pass, "{}", unseen.headline());
    let told = halfrow::report::wording::within(within(&unseen));
    let cut = format!("({most} of {ROWS})");
    assert!(told[1].starts_with("covers ") && told[1].contains(&cut), "{told:?}");
    assert!(told[2].starts_with("leaves out ") && told[2].contains("8 bits"), "{told:?}");
    let seen = judged(&behind, &plan(30.0)).unwrap();
    assert_eq!(failed_check(&seen), Some(CheckName::Frames), "{}", seen.headline());
}

/// The largest number of rows of any frame.
fn report_rows(report: &Report) -> usize {
    report.frames.iter().map(|frame| frame.rows).max().unwrap_or_default()
}

#[test]
fn a_time_that_does_not_suffice_is_refused_with_the_least_that_does() {
    let _alone = crate::RUNS.lock();
    let refused = |plan: &Plan| match judged(SLOW, plan) {
        Err(Misfit::Within(error)) => error,
        other => panic!("{:?}", other.map(|report| report.headline())),
    };
    let WithinError::TooFew { seconds, least } = refused(&plan(0.2)) else { panic!() };
    assert!(seconds == 0.2 && (0.8..1.1).contains(&least), "{least}");
    let report = judged(SLOW, &plan(least)).unwrap();
    assert_eq!((report.verdict(), report.frames.len()), (Verdict::Pass, 1));
    assert!(report.link.seconds <= least);
    assert!(judged(SLOW, &plan(least - 0.002)).is_err());

    let at_speed = |seconds| Plan { at_speed: AtSpeed::For(Duration::from_millis(10)), ..plan(seconds) };
    // 10 ms are 930 frames of 1,024 clocks and 8; their records of 18 bytes take 0.84 s.
    let WithinError::AtSpeed { least, .. } = refused(&at_speed(1.8)) else { panic!() };
    assert!((1.8..3.0).contains(&least), "{least}");
    let report = judged(SLOW, &at_speed(least)).unwrap();
    assert!(report.link.seconds <= least, "{} of {least} s", report.link.seconds);
    assert_eq!(taken(&report, "at speed"), 930, "{:?}", within(&report));
}

#[test]
fn no_share_of_faults_is_told_of_a_board_that_they_were_not_measured_in() {
    let _alone = crate::RUNS.lock();
    let plan = System { height: ROWS, radius: 40.0, ..System::TINY }.plan();
    let vary = Vary { centre: true, depth: true };
    let plan = Plan { within: Some(Duration::from_secs(1)), vary, ..plan };
    let report = judged("mock", &plan).unwrap();
    let told = halfrow::report::wording::within(within(&report)).pop().unwrap();
    assert!(told.starts_with("how many faults this selection finds was not measured"), "{told}");
    assert!(told.ends_with("64 x 16"), "{told}");
    let page = halfrow::report::html(&report, &[]).unwrap();
    let measured = |page: &str| page.contains("), as measured at 64 x 16 against time on this link");
    assert!(measured(&page), "{page}");
}

/// What the board is does not depend on the time.
#[test]
fn a_board_that_is_not_the_required_one_is_said_to_be_so_however_short_the_time() {
    let _alone = crate::RUNS.lock();
    let options = RunOptions { require_hardware: true, ..RunOptions::default() };
    let report = verify(&plan(0.2), open(SLOW), &options, &Silent).unwrap().report;
    assert_eq!(report.finding, Finding::HardwareRequired { board: BoardKind::Mock });
}
