//! The Verilog against `protocol/WIRE.md`, in all builds that exist for it. Next to every board runs a mock that gets the same
//! bytes and must answer the same.

#![expect(clippy::unwrap_used, reason = "a test helper that cannot go on fails the test")]

mod judged;

use halfrow_conformance::at_speed::{HEIGHT, golden_tables, ready_with};
use halfrow_conformance::frames::{configuration, lean};
use halfrow_conformance::{Boards, Build, Subject};
use halfrow_mock::{BurstBuild, Options, TapCount};
use halfrow_sim::Board;

use judged::Judged;

/// Boards under simulation.
struct Simulated;

/// The builds, as the suite and as the mock describe them.
fn builds() -> [(halfrow_sim::Build, Build, Options); 4] {
    let mock = Options { records: 16, least_frame_blanking: 256, ..Options::default() };
    let four = Build::default();
    [
        (
            halfrow_sim::Build::Shipped,
            Build { row_banks_in: 2, row_banks_out: 2, ..four.clone() },
            Options { row_banks_in: 2, row_banks_out: 2, ..mock.clone() },
        ),
        (
            halfrow_sim::Build::FourRowBanksIn,
            Build { row_banks_out: 2, ..four.clone() },
            Options { row_banks_out: 2, ..mock.clone() },
        ),
        (
            halfrow_sim::Build::FiveTapsOneBank,
            lean(),
            Options {
                taps: TapCount::Five,
                latency: 11,
                table_banks: 1,
                bursts: BurstBuild::Untrapped,
                ..mock.clone()
            },
        ),
        (halfrow_sim::Build::FourRowBanks, four, mock),
    ]
}

impl Boards for Simulated {
    fn offers(&self, build: &Build) -> bool {
        builds().iter().any(|(_, described, _)| described == build)
    }

    fn switched_on(&self, build: &Build) -> Box<dyn Subject> {
        let found = builds().into_iter().find(|(_, described, _)| described == build);
        let (build, _, options) = found.unwrap();
        Box::new(Judged::new(Board::of_build(build, 1), &options))
    }

    /// `scripts/soak` tries more.
    fn cases(&self) -> u32 {
        64
    }
}

halfrow_conformance::conformance!(&crate::Simulated);

/// The suite skips what a board says that it lacks, so this makes sure that no other build lacks it.
#[test]
fn every_build_but_the_lean_one_has_the_trap_that_the_suite_tries() {
    for (_, build, options) in builds() {
        let (_, bursts) = ready_with(&Simulated, &build, configuration(HEIGHT), &golden_tables()).unwrap();
        assert_eq!(bursts.trap, options.bursts == BurstBuild::Trapped);
        assert_eq!(bursts.trap, build != lean());
    }
}
