//! The board that the tests are about: here the mock, which can be built in any way.

use halfrow_mock::{Board, BoardFault, Options};

/// Cases of the properties that take longest.
pub(crate) const CASES: u32 = 2000;

/// A board of this build that was just switched on.
pub(crate) fn switched_on(options: &Options, fault: Option<BoardFault>) -> Board {
    Board::new(options, fault).unwrap()
}

/// Those of these builds that there are.
pub(crate) fn offered(builds: impl IntoIterator<Item = Options>) -> Vec<Options> {
    builds.into_iter().collect()
}
