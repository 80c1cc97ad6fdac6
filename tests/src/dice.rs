//! The random numbers of campaigns.

use rand_core::{Rng as _, SeedableRng as _};
use rand_pcg::Pcg32;

/// Dice that fall the same way for the same seed.
#[derive(Debug)]
pub struct Dice(Pcg32);

impl Dice {
    /// The dice of `seed`.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self(Pcg32::seed_from_u64(seed))
    }

    /// A number below `end`, all equally likely.
    pub fn below(&mut self, end: usize) -> usize {
        ((u128::from(self.0.next_u64()) * end as u128) >> 64) as usize
    }

    /// True with this probability.
    pub fn comes_up(&mut self, probability: f64) -> bool {
        (self.below(1 << 30) as f64) < probability * f64::from(1 << 30)
    }

    /// One of `choices`.
    pub fn one_of<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[self.below(choices.len())]
    }

    /// A number between 10^`least` and 10^`most`, all orders of magnitude equally likely.
    pub fn magnitude(&mut self, least: f64, most: f64) -> f64 {
        let share = self.below(1 << 20) as f64 / f64::from(1 << 20);
        10_f64.powf(least + (most - least) * share)
    }
}
