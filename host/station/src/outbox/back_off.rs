//! How long to wait before something is tried again.

use rand::{RngExt as _, rng};

use crate::store::{FIRST_WAIT_MS, LONGEST_WAIT_MS};

/// How long to wait after `vain` failed tries and one more, in milliseconds: twice as long each time, and a little
/// different for each station, so that they do not all come at once when a plant is back.
pub(super) fn ms(vain: u32) -> i64 {
    let wait = FIRST_WAIT_MS.saturating_mul(1 << vain.min(20)).min(LONGEST_WAIT_MS);
    wait - rng().random_range(0..=wait / 4)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wait_doubles_up_to_five_minutes_and_is_never_longer() {
        for (vain, most) in [(0, 1_000), (1, 2_000), (5, 32_000), (9, 300_000), (u32::MAX, 300_000)] {
            for _ in 0..100 {
                let wait = ms(vain);
                assert!((3 * most / 4..=most).contains(&wait), "{wait} ms behind {vain} tries");
            }
        }
    }
}
