//! Grids that no plan has, by turns with row factors, each for two frames at the full pixel clock.

use std::iter;

use halfrow_model::{Geometry, GridShape, MIN_WIDTH, RowFactor, TableSet};
use halfrow_protocol::message::Grids;
use rand_core::Rng;
use rand_pcg::Pcg64Mcg;

use crate::board::{Capabilities, grids};
use crate::run::drawn::{BY_TURNS, Weights, drawn_factors, drawn_kernel, fit};
use crate::run::plan::variations::Build;
use crate::tables::Generation;

/// About how many samples such a frame has. One frame of each corner goes over the link.
const SAMPLES: usize = 1 << 13;
/// v and k: the finest and the usual grid in long rows, then all others in short ones.
const SHAPES: [(u32, u32); 12] =
    [(1, 5), (5, 6), (2, 6), (3, 5), (4, 6), (6, 5), (1, 6), (2, 5), (3, 6), (4, 5), (5, 5), (6, 6)];
/// How many of these have long rows.
const LONG: usize = 2;
/// How many of these have a v that no earlier one has.
const FIRST_K: usize = 6;
/// The rows after the first grid row in frames with short rows.
const ROWS_BEHIND: usize = 6;
/// How often a grid is drawn, each time half as far from 1.
const TRIES: u32 = 8;

/// For each shape a grid and row factors, as generations from `first` on; none on a board that takes no grids.
///
/// The grid comes first, because a bank gets its shape only from a commit.
pub(super) fn grid_corners(
    capabilities: &Capabilities,
    first: u8,
    draws: &mut Pcg64Mcg,
) -> Vec<Vec<Generation>> {
    let Some(known) = grids(capabilities) else { return Vec::new() };
    let build = Build::of(capabilities);
    let most = usize::from(capabilities.max_width).min(build.ring) & !1;
    let least = MIN_WIDTH.max(known.grid_width.into()).next_multiple_of(2).min(most);
    let corner = |(place, shape): (usize, GridShape)| {
        let v = shape.v();
        let (width, rows) = if place < LONG {
            let width = (fit(BY_TURNS[1 - place], most) & !1).max(least);
            (width, SAMPLES / width)
        } else {
            // The effect of v is seen with its first k.
            (least, if place < FIRST_K { 1 << v } else { 0 } + ROWS_BEHIND)
        };
        let height = rows.clamp(1, capabilities.max_height.into());
        let centre2 = [width - 1, fit(BY_TURNS[0], 2 * width - 2)][place % LONG];
        let geometry = Geometry::new(width, height, *build.depths.last()?, centre2 as u32).ok()?;
        if shape.entries(&geometry) > known.entries.into() {
            return None;
        }
        let tables =
            [drawn_grid(geometry, shape, build.ring, draws), drawn_factors(geometry, build.ring, draws)];
        let made = (first + 2 * place as u8..).zip(tables).take(build.table_banks.into());
        let generation = |(number, tables)| {
            Some(Generation {
                number,
                tables: tables?,
                kernel: drawn_kernel(build.taps, Weights::Calm, draws)?,
            })
        };
        made.map(generation).collect()
    };
    shapes(known).into_iter().enumerate().filter_map(corner).collect()
}

/// The shapes that a board takes, each once. If the board takes only one k, each v has that one.
fn shapes(known: Grids) -> Vec<GridShape> {
    let mut shapes = Vec::new();
    for (v, k) in SHAPES {
        let made = iter::once(k).chain(GridShape::K).filter_map(|k| GridShape::new(v, k).ok());
        let shape = made.into_iter().find(|shape| known.takes(shape.k() as u8));
        shapes.extend(shape.filter(|shape| !shapes.contains(shape)));
    }
    shapes
}

/// A grid whose rows lie in the frame and in a ring of `ring` samples. Its factors have any size; some are above 1.
fn drawn_grid(geometry: Geometry, shape: GridShape, ring: usize, draws: &mut Pcg64Mcg) -> Option<TableSet> {
    (0..TRIES).find_map(|halvings| {
        let entries = drawn_entries(&geometry, shape, halvings, draws);
        let tables = TableSet::from_grid(geometry, shape, &entries).ok()?;
        tables.check_ring(ring).is_ok().then_some(tables)
    })
}

/// Entries column by column. The first node is nearer to 1 than most others, so that no row ends beyond the frame, and no
/// offset moves a row further to the left than this node moves it to the right. Where the first node is nearer still, the
/// offset is to the right, by as much as that makes room for.
fn drawn_entries(geometry: &Geometry, shape: GridShape, halvings: u32, draws: &mut Pcg64Mcg) -> Vec<u32> {
    let one = RowFactor::ONE.get();
    let half = one >> 1 >> halvings;
    let (rows, columns) = (shape.rows(geometry), shape.columns(geometry));
    let first: Vec<_> = (0..rows)
        .map(|_| {
            let is_right = draws.next_u32() % 2 == 1;
            (draws.next_u32() % if is_right { half / 4 } else { half }, is_right)
        })
        .collect();
    let mut offset = |&(below, is_right): &(u32, bool)| {
        let drawn = u64::from(draws.next_u32());
        // In units of 2^-13 column, from factors in units of 2^-24.
        let to_left = (u64::from(geometry.centre2()) * u64::from(below)) >> 12;
        let to_right = (geometry.width() as u64 * u64::from(half)) >> 13;
        let part = |most: u64| ((most * drawn) >> 32) as u32;
        if is_right { one + part(to_right) } else { one - part(to_left) }
    };
    let mut entries: Vec<u32> = first.iter().map(&mut offset).collect();
    entries.extend(first.iter().map(|(below, _)| one - below));
    entries.extend((2 * rows..columns * rows).map(|place| {
        let (drawn, is_beyond) = (draws.next_u32() % half, draws.next_u32().is_multiple_of(8));
        // As a second node, a factor above 1 has no room in short rows.
        if is_beyond && place >= 3 * rows { one + drawn } else { one - half - drawn }
    }));
    entries
}

#[cfg(test)]
mod tests {
    use super::*;

    /// DATAPATH.md, "Legal": if every node is d below 1, a row begins C·d/2 columns to the right of its first column.
    /// What is drawn must be legal in the widest and in the narrowest row, at every centre.
    #[test]
    fn grids_are_legal_at_any_centre_and_stretch_far() {
        let (mut draws, mut left, mut right) = (Pcg64Mcg::new(1), 0, 0);
        for (width, ring) in [(64, 64), (144, 256), (682, 1024), (1364, 2048), (2592, 4096)] {
            for centre2 in [0, 1, width as u32 - 1, 2 * width as u32 - 2] {
                for shape in GridShape::all() {
                    let height = (1 << shape.v()) + ROWS_BEHIND;
                    let geometry =
                        Geometry::new(width, height, halfrow_model::BitDepth::Twelve, centre2).unwrap();
                    let tables = drawn_grid(geometry, shape, ring, &mut draws).unwrap();
                    let offsets: Vec<_> = tables.entries().take(shape.rows(&geometry)).collect();
                    let one = RowFactor::ONE.get();
                    right += usize::from(offsets.iter().any(|&offset| offset > one));
                    left += usize::from(offsets.iter().any(|&offset| offset < one));
                    let least = tables.values(4).unwrap().factors().iter().copied().min().unwrap();
                    // The narrowest rows have room for less.
                    let most = if width > 64 { 1 << 23 } else { 3 << 22 };
                    assert!(least < most, "{width}, {centre2}, {shape:?}: {least}");
                }
            }
        }
        // Of 240 grids, a quarter of which have their centre at column 0 and no room to the left.
        assert!(right > 200 && left > 120, "{left}, {right}");
    }

    #[test]
    fn every_v_has_a_corner_with_each_k_that_a_board_takes() {
        let plan = crate::run::Plan::new(
            TableSet::new(
                Geometry::centred(64, 1, halfrow_model::BitDepth::Twelve).unwrap(),
                vec![RowFactor::ONE],
            )
            .unwrap(),
            halfrow_model::Interpolant::Hermite.into(),
        );
        for (ks, others) in [(0x20, vec![]), (0x40, vec![]), (0x60, (1..=6).collect())] {
            let mut board = crate::run::usual_capabilities(&plan, crate::board::BoardNature::Mock);
            board.max_height = 128;
            let grids = Grids { further_datapath: 2, entries: 2048, ks, grid_blanking: 0, grid_width: 0 };
            board.grids = Some(grids);
            let corners = grid_corners(&board, 1, &mut Pcg64Mcg::new(1));
            let vs: Vec<_> = corners.iter().filter_map(|it| it[0].tables.shape()).map(GridShape::v).collect();
            assert_eq!(vs, [vec![1, 5, 2, 3, 4, 6], others].concat(), "{ks:x}");
        }
    }
}
