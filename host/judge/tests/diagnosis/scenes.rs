//! Frames to feed a board with.

use halfrow_model::{Frame, Geometry, Phase};

/// What a frame shows.
#[derive(Clone, Copy)]
pub(crate) enum Scene {
    White,
    RampAcross,
    Impulses,
    Extremes,
    Noise,
}

/// The frame; `seed` sets the noise.
pub(crate) fn scene(scene: Scene, geometry: &Geometry, seed: u64) -> Frame {
    let (width, max) = (geometry.width(), geometry.depth().max());
    let mut random = Random::new(seed);
    let sample = |place: usize| {
        let (row, column) = (place / width, place % width);
        match scene {
            Scene::White => max,
            Scene::RampAcross => (column * usize::from(max) / (width - 1)) as u16,
            Scene::Impulses if (column + 3 * row) % 8 == 0 => max,
            Scene::Impulses => 0,
            Scene::Extremes => (random.below(2) as u16) * max,
            Scene::Noise => random.below(u64::from(max) + 1) as u16,
        }
    };
    let samples = (0..width * geometry.height()).map(sample).collect();
    Frame::new(width, geometry.depth(), Phase::Grbg, samples).unwrap()
}

/// SplitMix64 (Steele, Lea, Flood 2014).
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// A number from 0 to `bound` − 1, uniform except for a bias that does not matter here.
    pub(crate) fn below(&mut self, bound: u64) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z ^ (z >> 31)) % bound
    }
}
