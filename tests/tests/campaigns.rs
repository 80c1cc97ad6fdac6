//! Campaigns of random faults: small ones here, large ones when `scripts/soak` asks for them.

// clippy.toml allows it inside #[test] functions, but not in the functions that several tests call.
#![allow(clippy::unwrap_used)]

use std::time::Duration;

use halfrow::link;
use halfrow::progress::Silent;
use halfrow::result::{Report, SoakLength, SoakReport};
use halfrow::run::{AtSpeed, Plan, RunOptions, verify};
use halfrow::verdict::Verdict;
use halfrow_tests::campaign::{self, Found, Kind};
use halfrow_tests::poor_links::{self, Case, SavedResults, Way};
use halfrow_tests::program::Folder;
use halfrow_tests::proxy::Suffers;
use halfrow_tests::system::{System, streamed};

/// Any seed will do; a fixed one draws the same cases again.
const SEED: u64 = 20_140_401;

/// Judges `count` faults, prints what found them, and allows none that nothing finds.
#[track_caller]
#[allow(clippy::print_stdout)]
fn every_fault_is_found(system: &System, count: usize) {
    let campaign = campaign::run(system, count, SEED);
    println!("{campaign}");
    assert_eq!(campaign.0.iter().map(|case| case.drawn).sum::<usize>(), count);
    let unfound: Vec<_> = campaign.that_were(Found::ByNothing).collect();
    assert!(unfound.is_empty(), "{unfound:?}");
}

/// How long a run may take, on the virtual clock or in real time: some patience for every answer.
const SOON: Duration = Duration::from_secs(300);

/// Judges the boards of all `cases`, prints the verdicts, and allows no wrong one.
#[track_caller]
#[allow(clippy::print_stdout)]
fn no_verdict_is_false(cases: &[Case], kept: &SavedResults) {
    let links = poor_links::run(cases, SOON, kept);
    println!("{links}");
    let wrong: Vec<_> = links.false_verdicts().chain(links.hangs()).chain(links.needless_errors()).collect();
    assert!(wrong.is_empty(), "{wrong:?}");
    assert_eq!(links.0.len(), cases.len());
}

#[test]
fn every_single_fault_of_a_small_board_is_found() {
    every_fault_is_found(&System::SMALL, 100);
}

/// Where nothing is stretched, no output lies near node 40; and rows of 64 samples never meet in a memory of 2048.
#[test]
fn what_no_streamed_sample_can_show_is_left_to_read_back_or_to_full_speed() {
    let unstretched = System { radius: 1e8, ..System::TINY };
    let searched = |of: fn(Plan) -> Plan| {
        let by = |system: &System, kind: Kind, fault| kind.search(system, &of(system.plan()), fault);
        let word = by(&unstretched, Kind::KernelWord, ",fault=kernel-word,node=40,bit=9");
        (word, by(&System::TINY, Kind::AddressLine, ",fault=stuck-address,bit=10"))
    };
    assert_eq!(searched(streamed), (Found::ByReadBack, Found::ByNothing));
    // Corners at full speed stretch rows, and have rows that meet in the memory.
    assert_eq!(searched(|plan| plan), (Found::BySamples, Found::BySamples));
}

#[test]
fn no_poor_link_gives_a_false_verdict() {
    let mut cases = poor_links::draw(SEED, 0..150, poor_links::virtual_);
    cases.extend(poor_links::draw(SEED, 300..324, poor_links::real_and_short));
    // On a board that swallows rows a run waits some ten seconds, which cost nothing on a virtual clock.
    let is_slow = |case: &Case| !matches!(case.way, Way::Virtual(_)) && case.broken.contains("lost-row");
    cases.retain(|case| !is_slow(case));
    no_verdict_is_false(&cases, &SavedResults::nothing());
}

/// A link that recomputes CRCs is the one thing that a judge cannot see through. The campaign must report it, or it reports
/// nothing.
#[test]
fn a_campaign_reports_false_verdicts_and_hangs() {
    let mut cases = poor_links::draw(SEED, 0..4, poor_links::real);
    for case in &mut cases {
        case.way = Way::Tcp { to_board: Suffers::Nothing, to_host: Suffers::Forges };
        case.broken.clear();
    }
    let forged = poor_links::run(&cases, SOON, &SavedResults::nothing());
    assert_eq!((forged.false_verdicts().count(), forged.hangs().count()), (4, 0), "{forged}");
    assert!(forged.to_string().contains("false FAIL: 4 of 4"), "{forged}");
    assert!(forged.0.iter().all(|run| run.headline.contains("samples differ")), "{forged}");
    let given_no_time = poor_links::run(&cases, Duration::ZERO, &SavedResults::nothing());
    assert_eq!(given_no_time.hangs().count(), 4);
}

#[test]
fn a_campaign_goes_on_where_it_stopped() {
    let folder = Folder::new();
    let file = folder.path().join("kept").join("runs.jsonl");
    let cases = poor_links::draw(SEED, 0..6, poor_links::virtual_);
    let half = poor_links::run(&cases[..3], SOON, &SavedResults::in_file(&file));
    // As if killed in the middle of a line.
    let mut text = std::fs::read_to_string(&file).unwrap();
    text.push_str("{\"index\": 3, \"came\": \"FA");
    std::fs::write(&file, &text).unwrap();
    let kept = SavedResults::in_file(&file);
    assert_eq!((kept.len(), half.0.len()), (3, 3));
    // Known results are not judged again: with no time at all, only the others do not end.
    let rest = poor_links::run(&cases, Duration::ZERO, &kept);
    assert_eq!(rest.hangs().map(|run| run.case.index).collect::<Vec<_>>(), [3, 4, 5]);
    // Runs that did not end are not kept, and are judged again.
    assert_eq!(SavedResults::in_file(&file).len(), 3);
}

#[test]
#[ignore = "minutes long; scripts/soak runs it"]
fn every_one_of_a_thousand_faults_is_found_at_the_paper_s_size() {
    every_fault_is_found(&System::PAPER, 1000);
}

#[test]
#[ignore = "minutes long; scripts/soak runs it"]
fn none_of_twenty_thousand_poor_links_gives_a_false_verdict() {
    let kept = SavedResults::of_campaign("campaign", SEED);
    println!("{} runs are known from earlier", kept.len());
    let mut cases = poor_links::draw(SEED, 0..19_000, poor_links::virtual_);
    cases.extend(poor_links::draw(SEED, 19_000..20_000, poor_links::real));
    no_verdict_is_false(&cases, &kept);
}

/// Eight hours on the mock's clock, at which a burst has 2307 frames of 64 x 8 samples and the host asks every 250 ms.
#[allow(clippy::print_stdout)]
fn soaked_for_eight_hours(target: &str) -> Report {
    let plan = Plan {
        at_speed: AtSpeed::Soak(SoakLength::Time { seconds: 28_800.0 }),
        fail_fast: false,
        ..System::TINY.plan()
    };
    let candidate = link::open(&target.parse().unwrap()).unwrap();
    let report = verify(&plan, candidate, &RunOptions::default(), &Silent).unwrap().report;
    let soak = report.soak.as_ref().unwrap();
    println!(
        "{target}: {} in {} bursts, {} wrong; {}",
        soak.frames,
        soak.bursts,
        soak.wrong,
        report.headline()
    );
    assert!((28_800.0..28_801.0).contains(&soak.seconds), "{}", soak.seconds);
    assert!(soak.frames > 1_000_000 && soak.bursts >= 480, "{soak:?}");
    report
}

#[test]
#[ignore = "minutes long; scripts/soak runs it"]
fn eight_hours_are_judged_frame_by_frame() {
    let sound = soaked_for_eight_hours("mock,pixel-clock=20000");
    assert_eq!(sound.verdict(), Verdict::Pass, "{}", sound.headline());
    // 1.1 million frames have some 570 million samples.
    let broken = soaked_for_eight_hours("mock,pixel-clock=20000,fault=slow-path,one-in=50000000");
    assert_eq!(broken.verdict(), Verdict::Fail, "{}", broken.headline());
    let soak = broken.soak.unwrap();
    assert!((1..40).contains(&soak.wrong), "{soak:?}");
    assert_eq!(soak.differences.len() as u64, soak.wrong.min(SoakReport::MOST_DIFFERENCES as u64));
}
