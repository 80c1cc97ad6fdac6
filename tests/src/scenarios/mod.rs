//! All scenarios, as data: sound boards, broken boards, poor links, and calls that fit no board.

mod broken_boards;
mod broken_either_way;
mod broken_grids;
mod misfits;
mod poor_links;
mod sound_boards;

pub use broken_boards::BROKEN_BOARDS;
pub use broken_grids::BROKEN_GRIDS;
pub use misfits::MISFITS;
pub use poor_links::{HOPELESS_LINKS, REPAIRED_LINKS, SLOW_LINKS};
pub use sound_boards::SOUND_BOARDS;

use crate::scenario::{On, OnSim, Scenario};

/// Every scenario.
pub fn all() -> impl Iterator<Item = &'static Scenario> {
    let boards = [SOUND_BOARDS, &BROKEN_BOARDS, &BROKEN_GRIDS, MISFITS];
    boards.into_iter().chain([REPAIRED_LINKS, SLOW_LINKS, HOPELESS_LINKS]).flatten()
}

/// How a run ends when nothing is wrong.
const ALL_EQUAL: &str = "all equal to the reference";

/// A sound board, on a link whose errors can be repaired if it has any: PASS.
const fn passes(name: &'static str, options: &'static str, arguments: &'static [&'static str]) -> Scenario {
    expect("PASS", 0, name, options, arguments, ALL_EQUAL)
}

const fn expect(
    verdict: &'static str,
    exit_code: i32,
    name: &'static str,
    options: &'static str,
    arguments: &'static [&'static str],
    sentence: &'static str,
) -> Scenario {
    // Options describe a mock, unless the scenario says otherwise.
    let on = if options.is_empty() { On::AnyBoard } else { On::MockOnly };
    let (is_slow, on_sim) = (false, OnSim::Whole);
    Scenario { name, on, options, arguments, verdict, exit_code, sentence, when_late: &[], is_slow, on_sim }
}
