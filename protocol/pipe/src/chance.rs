//! When a fault strikes, and its random numbers.

use std::num::NonZeroU64;

use rand_core::{Rng, SeedableRng};
use rand_pcg::Pcg32;

/// When a fault strikes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Occurrence {
    /// Once, at the byte or packet of this number, from 0.
    At(u64),
    /// Repeatedly, each time after this many bytes or packets.
    Every(NonZeroU64),
    /// At each byte or packet with this probability, 0 to 1.
    Rate(f64),
}

/// The numbers of the bytes or packets that a fault strikes, in rising order.
#[derive(Debug)]
pub(super) struct Chance {
    random: Pcg32,
    rate: f64,
    every: Option<NonZeroU64>,
    next: Option<u64>,
}

impl Chance {
    pub(super) fn new(occurrence: Occurrence, seed: u64) -> Self {
        let mut chance = Self { random: Pcg32::seed_from_u64(seed), rate: 0.0, every: None, next: None };
        match occurrence {
            Occurrence::At(number) => chance.next = Some(number),
            Occurrence::Every(every) => (chance.every, chance.next) = (Some(every), Some(every.get())),
            Occurrence::Rate(rate) => {
                chance.rate = rate;
                chance.next = chance.first_from(0);
            }
        }
        chance
    }

    /// The number that is struck next; none if no more are.
    pub(super) fn next(&self) -> Option<u64> {
        self.next
    }

    /// Whether `number` is struck. If so, moves on to the next number to strike.
    pub(super) fn strikes(&mut self, number: u64) -> bool {
        let strikes = self.next == Some(number);
        if strikes {
            self.next = match self.every {
                Some(every) => number.checked_add(every.get()),
                None => number.checked_add(1).and_then(|number| self.first_from(number)),
            };
        }
        strikes
    }

    /// Draws the first number struck from `number` on. The gap before it has a geometric distribution, so one draw is
    /// enough: P(gap ≥ n) = (1 − rate)^n is inverted at a uniform variate. What is not struck costs nothing.
    fn first_from(&mut self, number: u64) -> Option<u64> {
        const UNIT: f64 = 1.0 / (1_u64 << 53) as f64;
        if self.rate <= 0.0 {
            return None;
        }
        let uniform = ((self.random.next_u64() >> 11) + 1) as f64 * UNIT;
        let gap = uniform.ln() / (-self.rate).ln_1p();
        number.checked_add(gap as u64)
    }

    /// A random number from 0 to `end`, exclusive; 0 if `end` is 0.
    pub(super) fn below(&mut self, end: usize) -> usize {
        ((u128::from(self.random.next_u64()) * end as u128) >> 64) as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn struck(occurrence: Occurrence, seed: u64, end: u64) -> Vec<u64> {
        let mut chance = Chance::new(occurrence, seed);
        (0..end).filter(|&number| chance.strikes(number)).collect()
    }

    #[test]
    fn a_number_is_struck_once() {
        assert_eq!(struck(Occurrence::At(7), 0, 100), [7]);
    }

    #[test]
    fn every_so_many_are_struck_behind_the_first_so_many() {
        let every = Occurrence::Every(NonZeroU64::new(30).unwrap());
        assert_eq!(struck(every, 0, 100), [30, 60, 90]);
    }

    #[test]
    fn rate_1_strikes_everything_and_rate_0_nothing() {
        assert_eq!(struck(Occurrence::Rate(1.0), 3, 5), [0, 1, 2, 3, 4]);
        assert_eq!(struck(Occurrence::Rate(0.0), 3, 1000), []);
    }

    #[test]
    fn the_number_of_strikes_is_that_of_a_binomial_distribution() {
        // 10^6 trials: mean 10^6 p, standard deviation sqrt(10^6 p (1 − p)); five of them either way.
        for (rate, mean, deviation) in
            [(0.001, 1000.0, 31.6), (0.1, 100_000.0, 300.0), (0.7, 700_000.0, 458.3)]
        {
            let count = struck(Occurrence::Rate(rate), 1, 1_000_000).len() as f64;
            assert!((count - mean).abs() < 5.0 * deviation, "{count} strikes at rate {rate}");
        }
    }

    #[test]
    fn strikes_do_not_shun_or_seek_each_other() {
        // A strike follows a strike as often as anything else: 0.3 of some 300,000, deviation 251.
        let struck = struck(Occurrence::Rate(0.3), 2, 1_000_000);
        let pairs = struck.windows(2).filter(|pair| pair[1] == pair[0] + 1).count() as f64;
        assert!((pairs - 0.3 * struck.len() as f64).abs() < 5.0 * 251.0, "{pairs} pairs of {}", struck.len());
    }

    #[test]
    fn a_seed_gives_the_same_strikes_again_and_another_seed_others() {
        let strikes = |seed| struck(Occurrence::Rate(0.01), seed, 10_000);
        assert_eq!(strikes(5), strikes(5));
        assert_ne!(strikes(5), strikes(6));
    }

    #[test]
    fn dice_fall_on_every_side_equally() {
        let mut chance = Chance::new(Occurrence::At(0), 4);
        let mut counts = [0_i32; 6];
        (0..60_000).for_each(|_| counts[chance.below(6)] += 1);
        // Mean 10,000, deviation sqrt(60,000 · 5/36) = 91.
        assert!(counts.iter().all(|count| (count - 10_000).abs() < 456), "{counts:?}");
    }
}
