//! Additional frames with another optical centre and other depths: a board could otherwise ignore these settings unseen.

use halfrow_model::{BitDepth, Geometry, TableSet};
use serde::{Deserialize, Serialize};

use crate::board::Capabilities;
use crate::run::at_speed::known_bursts;

/// Which settings of its tables a run varies, in additional frames after all others.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Vary {
    /// The column of the optical centre, in one frame.
    pub centre: bool,
    /// The depth, in one frame for each other depth of the board.
    pub depth: bool,
}

/// The capabilities of a board's build on which a plan depends.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Build {
    /// Banks of tables, 1 or 2.
    pub table_banks: u8,
    /// Taps, 5 or 7.
    pub taps: u8,
    /// M, the samples of its line memory.
    pub ring: usize,
    /// Its sample depths.
    pub depths: Vec<BitDepth>,
    /// Whether it makes frames itself, of a content that this program knows.
    pub bursts: bool,
}

impl Build {
    /// The build that these capabilities describe.
    #[must_use]
    pub fn of(capabilities: &Capabilities) -> Self {
        let depths = capabilities.sample_depths();
        Self {
            table_banks: capabilities.table_banks,
            taps: capabilities.taps,
            ring: capabilities.ring.into(),
            depths: BitDepth::ALL.into_iter().filter(|depth| depths.has(depth.bits() as u8)).collect(),
            bursts: known_bursts(capabilities).is_ok(),
        }
    }

    /// A build with everything that a build can have, and with the shortest line memory for rows of `width` samples.
    #[must_use]
    pub fn full(width: usize) -> Self {
        let ring = width.checked_next_power_of_two().unwrap_or(usize::MAX);
        let (table_banks, taps) = (2, 7);
        Self { table_banks, taps, ring, depths: BitDepth::ALL.to_vec(), bursts: true }
    }
}

/// The entries of `tables` under the settings that `vary` names, one changed at a time, each legal for `build`.
pub(crate) fn varied(tables: &TableSet, vary: Vary, build: &Build) -> Vec<TableSet> {
    let own = tables.geometry();
    let of = |depth, centre2| tables.with_settings(depth, centre2).ok();
    let centre = vary.centre.then(|| {
        other_centres(own).find_map(|centre2| {
            of(own.depth(), centre2).filter(|tables| tables.check_ring(build.ring).is_ok())
        })
    });
    let depths = build.depths.iter().filter(|&&depth| vary.depth && depth != own.depth());
    let depths = depths.filter_map(|&depth| of(depth, own.centre2()));
    centre.flatten().into_iter().chain(depths).collect()
}

/// Other values of C, the best first: with every bit inverted that C can have at this width, then with ever fewer of the lower
/// ones. Of two centres that differ in a bit, one shows a board that holds this bit at either level. Centres less than a
/// sixteenth of the width away come last, because tables that stretch little hardly tell them apart.
fn other_centres(geometry: &Geometry) -> impl Iterator<Item = u32> {
    let (centre2, width) = (geometry.centre2(), geometry.width() as u32);
    let most = 2 * width - 2;
    let bits = u32::BITS - most.leading_zeros();
    let inverted = (1..=bits).rev().map(|bits| centre2 ^ ((1 << bits) - 1));
    let mut centres: Vec<_> = inverted.filter(|&other| other <= most).collect();
    centres.sort_by_key(|other| other.abs_diff(centre2) < width / 8);
    centres.into_iter()
}

#[cfg(test)]
mod tests {
    use halfrow_model::{Interpolant, Kernel, RowFactor};

    use super::*;
    use crate::Plan;

    fn tables(width: usize, centre2: u32, factor: u32) -> TableSet {
        let geometry = Geometry::new(width, 1, BitDepth::Twelve, centre2).unwrap();
        TableSet::new(geometry, vec![RowFactor::new(factor).unwrap()]).unwrap()
    }

    fn centre(tables: &TableSet, ring: usize) -> Option<u32> {
        let build = Build { ring, ..Build::full(tables.geometry().width()) };
        let varied = varied(tables, Vary { centre: true, depth: false }, &build);
        varied.first().map(|tables| tables.geometry().centre2())
    }

    /// 1919 is 0111 0111 1111 in the 12 bits of 3838, and 2176 is 1000 1000 0000. The 13 bits of 5182 cannot all be inverted
    /// in 2591, 0 1010 0001 1111: that would be 5600. 12 of them can, which gives 0 0101 1110 0000.
    #[test]
    fn the_other_centre_has_every_bit_inverted_that_can_be() {
        assert_eq!(centre(&tables(1920, 1919, 1 << 23), 2048), Some(2176));
        assert_eq!(centre(&tables(2592, 2591, 1 << 24), 4096), Some(1504));
    }

    /// 127 is 0111 1111 in the 8 bits of 254. With all of them inverted it is 128, half a column away; with 7 inverted it is 0.
    #[test]
    fn a_centre_far_away_comes_before_one_beside_it() {
        assert_eq!(centre(&tables(128, 127, 1 << 24), 128), Some(0));
    }

    /// DATAPATH.md, "Ring", for Q = 1, whose sources all lie at C/2: C = 64 needs column 36 when 35 have come, and 0, 32, 48,
    /// 56 and 60 look 94, 78, 70, 66 and 64 samples back in a ring of 64; 62 looks 63 back.
    #[test]
    fn a_centre_that_the_ring_does_not_allow_is_passed_over() {
        assert_eq!(centre(&tables(64, 63, 1 << 23), 64), Some(0));
        assert_eq!(centre(&tables(64, 63, 1), 64), Some(62));
    }

    /// Nothing else reaches the ends of their range on such a board (DATAPATH.md, "Signed bits that hold every legal case").
    #[test]
    fn without_bursts_the_decoy_has_weights_at_both_ends_of_their_range() {
        let plan = Plan::new(tables(64, 63, 1 << 23), Kernel::from(Interpolant::Hermite));
        let ends = |bursts| {
            let generations = plan.generations(&Build { bursts, ..Build::full(64) });
            let weights = generations[0].kernel.nodes().as_flattened().to_vec();
            [i16::MIN, i16::MAX].map(|end| weights.contains(&end))
        };
        assert_eq!((ends(true), ends(false)), ([false; 2], [true; 2]));
    }

    #[test]
    fn every_other_depth_of_the_board_has_a_turn_at_the_same_centre() {
        let own = tables(64, 63, 1 << 24);
        let build = Build { depths: vec![BitDepth::Eight, BitDepth::Twelve], ..Build::full(64) };
        let varied = varied(&own, Vary { centre: false, depth: true }, &build);
        let found: Vec<_> = varied.iter().map(|tables| *tables.geometry()).collect();
        assert_eq!(found, [Geometry::new(64, 1, BitDepth::Eight, 63).unwrap()]);
        assert_eq!(super::varied(&own, Vary::default(), &build), []);
    }
}
