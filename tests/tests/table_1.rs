//! Table 1 of the paper, with the 24 photographs, by a sound board and a broken one.
//!
//! The photographs are those in the folder `HALFROW_IMAGES`, or in `../shared/kodak` next to the project.

// clippy.toml allows it inside #[test] functions, but not in the functions that several tests call.
#![allow(clippy::unwrap_used)]

use halfrow_tests::photographs;
use halfrow_tests::program::{Ended, Folder};
use serde_json::Value;

/// The folder in which `halfrow paper table1` was called with these arguments, and how it ended, which must be with `code`; none
/// without photographs.
fn table_1(code: i32, arguments: &[&str]) -> Option<(Folder, Ended)> {
    let first = photographs::paths().into_iter().next()?;
    let images = first.parent().unwrap().to_str().unwrap();
    let folder = Folder::new();
    let call = ["paper", "table1", "--quiet", "-o", "out", "--images", images];
    let ended = folder.halfrow(call.into_iter().chain(arguments.iter().copied()));
    assert_eq!(ended.code, Some(code), "{}{}", ended.stdout, ended.stderr);
    Some((folder, ended))
}

/// The claims that such a call writes down.
#[allow(clippy::print_stdout)]
fn claims(code: i32, arguments: &[&str]) -> Option<Vec<Value>> {
    let (folder, ended) = table_1(code, arguments)?;
    println!("{}", ended.stdout);
    let report = folder.json("out/paper.json");
    Some(report["items"][0]["claims"].as_array().unwrap().clone())
}

fn found(claim: &Value) -> f64 {
    claim["found"].as_f64().unwrap_or(f64::NAN)
}

/// The averages of an independent calculation in NumPy, for linear, cubic and Hermite; the paper prints 32.1324, 32.5833 and
/// 34.9660.
const AVERAGES: [f64; 3] = [32.1225, 32.5641, 34.9625];

#[test]
fn table_1_is_the_paper_s_in_reals_in_integers_and_through_a_board() {
    let Some(claims) = claims(0, &["--board", "mock"]) else { return };
    for (claim, average) in claims.iter().zip(AVERAGES) {
        assert!((found(claim) - average).abs() < 5e-4, "{claim}");
    }
    // Besides the averages: the photograph farthest off, integers against reals, four kernels through the board, the board
    // against reals.
    assert_eq!(claims.len(), 3 + 2 + 4 + 1);
    assert!(found(&claims[3]) < 0.2 && found(&claims[4]) < 0.01 && found(&claims[9]) < 0.01);
    assert!(claims[5..9].iter().all(|claim| found(claim) == 0.0), "{claims:?}");
}

#[test]
fn a_board_whose_sums_are_not_rounded_is_found() {
    let Some(claims) = claims(1, &["--board", "mock,fault=no-rounding"]) else { return };
    assert!(claims[5..9].iter().any(|claim| found(claim) > 0.0), "{claims:?}");
}

#[test]
fn a_board_of_five_taps_is_refused_since_cubic_needs_seven() {
    let Some((_, ended)) = table_1(2, &["--board", "mock,taps=five"]) else { return };
    assert!(ended.stderr.contains("needs seven taps"), "{}", ended.stderr);
}
