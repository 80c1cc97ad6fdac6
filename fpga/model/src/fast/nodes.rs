//! The kernel in the order in which the fast paths look it up: by tap instead of by node.

use crate::{Kernel, NODES, Taps, WEIGHT_ONE};

/// Intervals between nodes.
pub(super) const INTERVALS: usize = NODES - 1;

/// The taps' places in [`Nodes`]; the three of a five-tap kernel come first.
pub(super) const G4: usize = 0;
pub(super) const R1: usize = 1;
pub(super) const R5: usize = 2;
pub(super) const G0: usize = 3;
pub(super) const G6: usize = 4;

/// The places of the taps of [`Nodes`] in a kernel's node, g0 r1 g4 r5 g6.
const STORED: [usize; 5] = [2, 1, 3, 0, 4];

/// One tap's weights over all 64 intervals.
///
/// w = low + ((difference · t + 2^7) >> 8), where the difference of two nodes takes 17 bits. It is stored as `rise` + `wrap` ·
/// 2^16, so that w = low + ((`rise` · t + 2^7) >> 8) + `wrap` · 256 · t. Modulo 2^16 is enough, as w fits 16 bits.
#[repr(align(64))]
pub(super) struct Tap {
    /// The weight at each interval's left node.
    pub(super) low: [i16; INTERVALS],
    /// The difference to the right node, modulo 2^16.
    pub(super) rise: [i16; INTERVALS],
    /// What the modulus removed from the difference, in units of 2^16: −1 to 1.
    pub(super) wrap: [i16; INTERVALS],
}

/// A kernel, tap by tap.
pub(super) struct Nodes {
    /// G4 R1 R5 G0 G6.
    pub(super) taps: [Tap; 5],
    /// Whether G0 and G6 have weights other than 0.
    #[cfg_attr(not(target_arch = "x86_64"), allow(dead_code))]
    pub(super) outer: bool,
    /// Whether a difference of two nodes, or a weight of G2 or R3, takes more than 16 bits.
    pub(super) wild: bool,
}

impl Nodes {
    pub(super) fn new(kernel: &Kernel) -> Self {
        let taps = STORED.map(|stored| Tap::new(kernel, stored));
        let steep = taps.iter().any(|tap| tap.wrap.iter().any(|&wrap| wrap != 0));
        Self { taps, outer: kernel.taps() == Taps::Seven, wild: steep || !derived_fit(kernel) }
    }
}

/// Whether g2 = 1 − g0 − g4 − g6 and r3 = −r1 − r5 fit 16 bits at every distance. Between two nodes each of the five stored
/// weights lies between its values at those nodes.
fn derived_fit(kernel: &Kernel) -> bool {
    let fits = |one: i32, stored: &[usize], pair: &[[i16; 5]]| {
        let sum = |choose: fn(i32, i32) -> i32| -> i32 {
            stored.iter().map(|&tap| choose(pair[0][tap].into(), pair[1][tap].into())).sum()
        };
        [sum(i32::min), sum(i32::max)].iter().all(|sum| i16::try_from(one - sum).is_ok())
    };
    kernel.nodes().windows(2).all(|pair| fits(WEIGHT_ONE, &[0, 2, 4], pair) && fits(0, &[1, 3], pair))
}

impl Tap {
    fn new(kernel: &Kernel, stored: usize) -> Self {
        let weight = |node: usize| kernel.nodes()[node][stored];
        let difference = |node: usize| i32::from(weight(node + 1)) - i32::from(weight(node));
        Self {
            low: std::array::from_fn(weight),
            rise: std::array::from_fn(|node| difference(node) as i16),
            wrap: std::array::from_fn(|node| {
                ((difference(node) - i32::from(difference(node) as i16)) >> 16) as i16
            }),
        }
    }

    /// The weight at distance `x`, below 2^14.
    pub(super) fn weight(&self, x: usize) -> i16 {
        let (node, t) = (x >> 8, (x & 255) as i32);
        let rise = i32::from(self.rise[node]) + (i32::from(self.wrap[node]) << 16);
        (i32::from(self.low[node]) + ((rise * t + 128) >> 8)) as i16
    }
}
