//! Round-trip times, in memory that does not grow with their number.

use std::time::Duration;

use rand_core::Rng;
use rand_pcg::Pcg64Mcg;

use super::RoundTrips;

/// Times that are kept. A percentile of such a sample is off by less than 0.5 % of the times in 99 of 100 samples.
const KEPT: usize = 100_000;

/// The least, the most, and a random sample of the times, each with the same chance of being in it (Vitter 1985, algorithm R).
pub(super) struct Times {
    kept: Vec<Duration>,
    count: usize,
    least: Duration,
    most: Duration,
    random: Pcg64Mcg,
}

impl Times {
    /// Starts with the first time.
    pub(super) fn beginning(first: Duration) -> Self {
        // Any generator will do: it only decides which times are kept.
        Self { kept: vec![first], count: 1, least: first, most: first, random: Pcg64Mcg::new(1) }
    }

    pub(super) fn add(&mut self, time: Duration) {
        self.count += 1;
        (self.least, self.most) = (self.least.min(time), self.most.max(time));
        if self.kept.len() < KEPT {
            self.kept.push(time);
            return;
        }
        let place = self.random.next_u64() % self.count as u64;
        if let Some(kept) = self.kept.get_mut(place as usize) {
            *kept = time;
        }
    }

    pub(super) fn round_trips(mut self) -> RoundTrips {
        self.kept.sort_unstable();
        let at = |share: f64| {
            let rank = (share * self.kept.len() as f64).ceil() as usize;
            microseconds(self.kept.get(rank.saturating_sub(1)).copied().unwrap_or_default())
        };
        RoundTrips {
            count: self.count,
            least_us: microseconds(self.least),
            median_us: at(0.5),
            p90_us: at(0.9),
            p99_us: at(0.99),
            most_us: microseconds(self.most),
        }
    }
}

fn microseconds(time: Duration) -> f64 {
    time.as_secs_f64() * 1e6
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(times: impl IntoIterator<Item = u64>) -> Times {
        let mut times = times.into_iter().map(Duration::from_micros);
        let mut all = Times::beginning(times.next().unwrap());
        times.for_each(|time| all.add(time));
        all
    }

    fn close(found: &RoundTrips, expected: [f64; 5], by: f64) {
        let found = [found.least_us, found.median_us, found.p90_us, found.p99_us, found.most_us];
        let is_close = found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < by);
        assert!(is_close, "{found:?}");
    }

    #[test]
    fn percentiles_are_the_nearest_ranks() {
        let found = of((1..=200).rev()).round_trips();
        assert_eq!(found.count, 200);
        close(&found, [1.0, 100.0, 180.0, 198.0, 200.0], 1e-6);
    }

    #[test]
    fn of_many_times_a_sample_is_kept_and_the_ends_are_those_of_all() {
        // Ten times as many as are kept, and sorted: keeping the first or the last ones would give a poor sample.
        let times = of(0..10 * KEPT as u64);
        assert_eq!((times.kept.len(), times.count), (KEPT, 10 * KEPT));
        let all = 10.0 * KEPT as f64;
        let found = times.round_trips();
        close(&found, [0.0, all / 2.0, 0.9 * all, 0.99 * all, all - 1.0], 0.005 * all);
        assert!(found.least_us < 1e-6 && (found.most_us - all + 1.0).abs() < 1e-6, "{found:?}");
    }
}
