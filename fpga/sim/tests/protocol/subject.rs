//! The board that the tests are about: here the Verilog under simulation, in the builds that there are.

use halfrow_mock::{BoardFault, Options, TapCount};
use halfrow_sim::{Board, Build};

use crate::judged::Judged;

/// Cases of the properties that take longest. `scripts/soak` tries more.
pub(crate) const CASES: u32 = 64;

/// The builds, as the mock describes them.
fn builds() -> [(Build, Options); 4] {
    let four = Options::default();
    let two = Options { row_banks_in: 2, row_banks_out: 2, ..four.clone() };
    let four_in = Options { row_banks_out: 2, ..four.clone() };
    let lean = Options { taps: TapCount::Five, latency: 11, table_banks: 1, ..four.clone() };
    [
        (Build::Shipped, two),
        (Build::FourRowBanks, four),
        (Build::FourRowBanksIn, four_in),
        (Build::FiveTapsOneBank, lean),
    ]
}

fn build(options: &Options) -> Option<Build> {
    builds().into_iter().find(|(_, described)| described == options).map(|(build, _)| build)
}

/// A board of this build that was just switched on, and the mock beside it.
pub(crate) fn switched_on(options: &Options, fault: Option<BoardFault>) -> Judged {
    assert_eq!(fault, None, "the Verilog has no faults to be asked for");
    let build = build(options).unwrap_or_else(|| panic!("no such build: {options:?}"));
    Judged::new(Board::of_build(build, 1), options)
}

/// Those of these builds that there are.
pub(crate) fn offered(builds: impl IntoIterator<Item = Options>) -> Vec<Options> {
    builds.into_iter().filter(|options| build(options).is_some()).collect()
}
