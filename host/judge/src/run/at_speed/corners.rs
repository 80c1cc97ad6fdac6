//! Settings that no plan has, each for two frames at the full pixel clock: other sizes, depths, centres, factors and
//! kernels, so that every bit of a setting, of an address and of a weight has both levels once; and grids. A burst takes
//! next to no time on a link.

use halfrow_model::{Geometry, MIN_WIDTH};
use rand_pcg::Pcg64Mcg;

use super::grids::grid_corners;
use crate::board::Capabilities;
use crate::run::drawn::{BY_TURNS, Weights, drawn_factors, drawn_kernel, fit};
use crate::run::plan::variations::Build;
use crate::tables::Generation;

/// About how many samples a corner's frame with long rows has.
const SAMPLES: usize = 1 << 15;
/// The generation of the first corner's tables. The others follow; none of them is a plan's.
const FIRST: u8 = 64;
/// The generation of the first grid.
const FIRST_OF_GRIDS: u8 = FIRST + 8;

/// Tables for each corner of a board's settings, one set for each of its table banks, drawn from `seed`.
pub(super) fn corners(capabilities: &Capabilities, seed: u64) -> Vec<Vec<Generation>> {
    let build = Build::of(capabilities);
    let mut draws = Pcg64Mcg::new(u128::from(seed) | 1 << 64);
    let most = usize::from(capabilities.max_width).min(build.ring);
    let rows = usize::from(capabilities.max_height);
    let long = |width: usize| (SAMPLES / width).min(rows);
    let by_turns = BY_TURNS.map(|bits| fit(bits, most).max(MIN_WIDTH) & !1);
    let sizes = [by_turns[0], by_turns[1], most & !1].map(|width| (width, long(width)));
    // One row less than the most has the other level in most bits.
    let tall = (MIN_WIDTH, rows.saturating_sub(1).max(1));
    let corner = |(place, (width, height)): (usize, (usize, usize))| {
        let depth = *build.depths.get(place % build.depths.len().max(1))?;
        let last = 2 * width - 2;
        let centre2 = [fit(BY_TURNS[place % 2], last), fit(BY_TURNS[place % 2], last), last, 0][place];
        let geometry = Geometry::new(width, height, depth, centre2 as u32).ok()?;
        let banks = [Weights::Calm, Weights::Wild].into_iter().take(build.table_banks.into());
        let tables = banks.map(|weights| {
            let number = FIRST + 2 * place as u8 + u8::from(weights == Weights::Wild);
            let kernel = drawn_kernel(build.taps, weights, &mut draws)?;
            Some(Generation { number, tables: drawn_factors(geometry, build.ring, &mut draws)?, kernel })
        });
        tables.collect()
    };
    let mut corners: Vec<_> = sizes.into_iter().chain([tall]).enumerate().filter_map(corner).collect();
    corners.extend(grid_corners(capabilities, FIRST_OF_GRIDS, &mut draws));
    corners
}

/// Sizes, depths and centres of the frames of all corners.
pub(in crate::run) fn geometries_of_corners(capabilities: &Capabilities, seed: u64) -> Vec<Geometry> {
    let made = corners(capabilities, seed).into_iter().flatten();
    made.map(|made| *made.tables.geometry()).collect()
}
