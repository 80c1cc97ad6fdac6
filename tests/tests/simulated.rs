//! The Verilog core against model and mock: every sample and every latency.

use std::collections::BTreeMap;

use halfrow_sim::{Core, CoreBuild};
use halfrow_tests::cases::{Case, Played};
use halfrow_tests::dice::Dice;
use halfrow_tests::simulated_core;

/// Plays so many cases on each build of the core.
fn all_agree(cases: u64) {
    let mut counts = BTreeMap::new();
    for core_build in CoreBuild::ALL {
        let mut core = Core::new(core_build, 1);
        let (mut samples, mut rows) = (0, 0);
        for seed in 0..cases {
            let mut dice = Dice::new(seed);
            let case = Case::draw(&mut dice, simulated_core::build(core_build), 3);
            let played = simulated_core::play(&mut core, &case, &mut dice);
            let expected = case.expected();
            assert!(played == expected, "{core_build:?}, case {seed}: {}", difference(&played, &expected));
            assert!(case.play_on_mock() == expected, "the mock on case {seed}");
            samples += played.samples.len();
            rows += played.latencies.len() / 2;
        }
        counts.insert(format!("{core_build:?}"), (cases, rows, samples));
    }
    println!("model, mock and Verilog agree; cases, rows, samples: {counts:?}");
}

fn difference(found: &Played, expected: &Played) -> String {
    let first = |a: &[u16], b: &[u16]| a.iter().zip(b).position(|(a, b)| a != b);
    format!(
        "{} of {} samples, the first that differs is {:?}; {} of {} latencies, {:?}",
        found.samples.len(),
        expected.samples.len(),
        first(&found.samples, &expected.samples),
        found.latencies.len(),
        expected.latencies.len(),
        first(&found.latencies, &expected.latencies),
    )
}

#[test]
fn model_mock_and_verilog_agree_on_every_sample_and_every_latency() {
    all_agree(1500);
}

#[test]
#[ignore = "minutes long; scripts/soak runs it"]
fn model_mock_and_verilog_agree_on_a_hundred_thousand_cases() {
    all_agree(100_000);
}
