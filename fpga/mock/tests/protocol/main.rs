//! The mock against `protocol/WIRE.md`, in any build.

#![expect(clippy::unwrap_used, reason = "a test helper that cannot go on fails the test")]

mod at_speed;
mod first_session;
mod mock_grids;
mod mock_only;

use halfrow_conformance::{Boards, Build, Subject};
use halfrow_mock::{Board, Depth, Options, TapCount};

/// Mock boards.
struct Mock;

/// The build as the mock's options describe it.
fn options(build: &Build) -> Options {
    Options {
        latency: build.latency,
        taps: if build.taps == 5 { TapCount::Five } else { TapCount::Seven },
        table_banks: build.table_banks,
        row_banks_in: build.row_banks_in,
        row_banks_out: build.row_banks_out,
        least_blanking: build.least_blanking,
        max_width: build.max_width,
        max_height: build.max_height,
        depths: build.depths.iter().filter_map(|&bits| Depth::from_bits(bits)).collect(),
        ..Options::default()
    }
}

impl Boards for Mock {
    fn offers(&self, build: &Build) -> bool {
        options(build).check().is_ok()
    }

    fn switched_on(&self, build: &Build) -> Box<dyn Subject> {
        Box::new(Board::new(&options(build), None).unwrap())
    }

    fn cases(&self) -> u32 {
        2000
    }
}

halfrow_conformance::conformance!(&crate::Mock);
