//! Model and mock, which share no arithmetic, on the same rows: random legal tables, kernels, sizes, depths, builds, blankings
//! and gaps, with another frame, other tables and another kernel following at once.

use halfrow_tests::cases::{Build, Case};
use halfrow_tests::dice::Dice;

#[test]
fn model_and_mock_agree_on_every_sample_and_every_latency() {
    let cases = std::env::var("HALFROW_EQUALITY_CASES").map_or(4000, |text| text.parse().unwrap());
    let (mut samples, mut rows, mut grids) = (0, 0, 0);
    for seed in 0..cases {
        let mut dice = Dice::new(seed);
        let build = Build::draw(&mut dice);
        let case = Case::draw(&mut dice, build, 2);
        let played = case.play_on_mock();
        assert_eq!(played, case.expected(), "case {seed}");
        samples += played.samples.len();
        rows += played.latencies.len() / 2;
        grids += case.frames.iter().filter(|(tables, ..)| tables.shape().is_some()).count();
    }
    assert!(grids > cases as usize / 2, "{grids} frames behind a grid");
    println!(
        "model and mock: {cases} cases, {rows} rows, {samples} samples, {grids} frames behind a grid, all equal"
    );
}
