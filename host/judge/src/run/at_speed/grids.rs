//! Grids that no plan has, for two frames at the full pixel clock each, by turns with row factors.

use halfrow_model::{Geometry, GridShape, MIN_WIDTH, RowFactor, TableSet};
use rand_core::Rng;
use rand_pcg::Pcg64Mcg;

use super::corners::{BY_TURNS, CALM, drawn_factors, drawn_kernel, fit};
use crate::board::{Capabilities, grids};
use crate::run::Generation;
use crate::run::variations::Build;

/// Samples that such a frame has about. One of them goes over the link.
const SAMPLES: usize = 1 << 13;
/// v and k, the finest and the usual one.
const SHAPES: [(u32, u32); 2] = [(1, 5), (5, 6)];
/// How often a grid is drawn, the next time half as far from 1.
const TRIES: u32 = 8;

/// For each shape a grid and row factors, under generations from `first` on; none on a board that takes no grids.
///
/// The grid comes first: a bank has its shape from a commit alone.
pub(super) fn grid_corners(
    capabilities: &Capabilities,
    first: u8,
    draws: &mut Pcg64Mcg,
) -> Vec<Vec<Generation>> {
    let Some(known) = grids(capabilities) else { return Vec::new() };
    let build = Build::of(capabilities);
    let most = usize::from(capabilities.max_width).min(build.ring) & !1;
    let least = MIN_WIDTH.max(known.grid_width.into()).next_multiple_of(2).min(most);
    let corner = |(place, (v, k)): (usize, (u32, u32))| {
        let shape = GridShape::new(v, k).ok().filter(|_| known.takes(k as u8))?;
        let width = (fit(BY_TURNS[1 - place], most) & !1).max(least);
        let height = (SAMPLES / width).clamp(1, capabilities.max_height.into());
        let centre2 = [width - 1, fit(BY_TURNS[0], 2 * width - 2)][place];
        let geometry = Geometry::new(width, height, *build.depths.last()?, centre2 as u32).ok()?;
        if shape.entries(&geometry) > known.entries.into() {
            return None;
        }
        let tables =
            [drawn_grid(geometry, shape, build.ring, draws), drawn_factors(geometry, build.ring, draws)];
        let made = (first + 2 * place as u8..).zip(tables).take(build.table_banks.into());
        let generation = |(number, tables)| {
            Some(Generation { number, tables: tables?, kernel: drawn_kernel(build.taps, CALM, draws)? })
        };
        made.map(generation).collect()
    };
    SHAPES.into_iter().enumerate().filter_map(corner).collect()
}

/// A grid whose rows lie in the frame and in a ring of `ring` samples: factors of any size, beyond 1 some of them.
fn drawn_grid(geometry: Geometry, shape: GridShape, ring: usize, draws: &mut Pcg64Mcg) -> Option<TableSet> {
    (0..TRIES).find_map(|halvings| {
        let entries = drawn_entries(&geometry, shape, halvings, draws);
        let tables = TableSet::from_grid(geometry, shape, &entries).ok()?;
        tables.check_ring(ring).is_ok().then_some(tables)
    })
}

/// Entries column by column. The first node is nearer to 1 than most others, so that no row ends behind the frame, and no
/// offset is further to the left than it moves the row to the right.
fn drawn_entries(geometry: &Geometry, shape: GridShape, halvings: u32, draws: &mut Pcg64Mcg) -> Vec<u32> {
    let one = RowFactor::ONE.get();
    let half = one >> 1 >> halvings;
    let (rows, columns) = (shape.rows(geometry), shape.columns(geometry));
    let first: Vec<u32> = (0..rows).map(|_| draws.next_u32() % half).collect();
    let offset = |below: &u32| {
        let most = (u64::from(geometry.centre2()) * u64::from(*below)) >> 12;
        one - ((most * u64::from(draws.next_u32())) >> 32) as u32
    };
    let mut entries: Vec<u32> = first.iter().map(offset).collect();
    entries.extend(first.iter().map(|below| one - below));
    entries.extend((2 * rows..columns * rows).map(|_| {
        let (drawn, is_beyond) = (draws.next_u32() % half, draws.next_u32().is_multiple_of(8));
        if is_beyond { one + drawn } else { one - half - drawn }
    }));
    entries
}

#[cfg(test)]
mod tests {
    use super::*;

    /// DATAPATH.md, "Legal": with every node of a row a distance d below 1 a row begins C·d/2 columns right of its first one.
    /// What is drawn must hold the conditions of the widest and of the narrowest row at every centre.
    #[test]
    fn grids_are_legal_at_any_centre_and_stretch_far() {
        let mut draws = Pcg64Mcg::new(1);
        for (width, ring) in [(144, 256), (682, 1024), (1364, 2048), (2592, 4096)] {
            for centre2 in [0, 1, width as u32 - 1, 2 * width as u32 - 2] {
                for shape in GridShape::all() {
                    let geometry = Geometry::new(width, 9, halfrow_model::BitDepth::Twelve, centre2).unwrap();
                    let tables = drawn_grid(geometry, shape, ring, &mut draws).unwrap();
                    let least = tables.values(4).unwrap().factors().iter().copied().min().unwrap();
                    assert!(least < 1 << 23, "{width}, {centre2}, {shape:?}: {least}");
                }
            }
        }
    }
}
