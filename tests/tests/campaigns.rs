//! Campaigns of drawn faults: small ones here, large ones when `scripts/soak` asks for them.

use halfrow_tests::campaign::{self, Found, Kind};
use halfrow_tests::poor_links;
use halfrow_tests::system::System;

/// Any drawing will do; this one can be drawn again.
const SEED: u64 = 20_140_401;

/// Judges so many faults, prints what found them, and allows none that nothing finds.
#[track_caller]
#[allow(clippy::print_stdout)]
fn every_fault_is_found(system: &System, count: usize) {
    let campaign = campaign::run(system, count, SEED);
    println!("{campaign}");
    assert_eq!(campaign.0.iter().map(|case| case.drawn).sum::<usize>(), count);
    let unfound: Vec<_> = campaign.that_were(Found::ByNothing).collect();
    assert!(unfound.is_empty(), "{unfound:?}");
}

/// Judges over so many poor links, prints the verdicts, and allows no false one.
#[track_caller]
#[allow(clippy::print_stdout)]
fn no_verdict_is_false(count: usize) {
    let links = poor_links::run(count, SEED);
    println!("{links}");
    let wrong: Vec<_> = links.false_verdicts().collect();
    assert!(wrong.is_empty(), "{wrong:?}");
}

#[test]
fn every_single_fault_of_a_small_board_is_found() {
    every_fault_is_found(&System::SMALL, 200);
}

/// Where nothing is stretched no output lies near node 40, and rows of 64 samples never meet in a memory of 2048.
#[test]
fn what_no_sample_can_show_is_left_to_read_back_or_to_nobody() {
    let unstretched = System { radius: 1e8, ..System::TINY };
    let word = Kind::KernelWord.search(&unstretched, ",fault=kernel-word,node=40,bit=9");
    let line = Kind::AddressLine.search(&System::TINY, ",fault=stuck-address,bit=10");
    assert_eq!((word, line), (Found::ByReadBack, Found::ByNothing));
}

#[test]
fn no_poor_link_gives_a_false_verdict() {
    no_verdict_is_false(200);
}

#[test]
#[ignore = "minutes long; scripts/soak runs it"]
fn every_one_of_a_thousand_faults_is_found_at_the_paper_s_size() {
    every_fault_is_found(&System::PAPER, 1000);
}

#[test]
#[ignore = "minutes long; scripts/soak runs it"]
fn none_of_ten_thousand_poor_links_gives_a_false_verdict() {
    no_verdict_is_false(10_000);
}
