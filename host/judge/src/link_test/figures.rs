//! The figures of a link test.

use std::time::Duration;

use serde::Serialize;

use crate::board::{RetryLimit, Tally};

/// Everything that a link test measured.
#[derive(Clone, Debug, Serialize)]
pub struct Figures {
    /// The link's name, for people.
    pub link: String,
    /// The bytes a second that the link itself carries each way, if known.
    pub limit: Option<f64>,
    /// The errors of all parts together.
    pub errors: Errors,
    /// Empty requests and their answers.
    pub round_trips: RoundTrips,
    /// Full packets to the board, answered with short ones.
    pub to_board: Throughput,
    /// Full packets to the host, requested with short ones.
    pub to_host: Throughput,
    /// Rows, both ways at once.
    pub together: Throughput,
}

/// Errors of a link.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Errors {
    /// Packets, both ways.
    pub packets: u64,
    /// Bytes, both ways.
    pub bytes: u64,
    /// Packets that were sent, those among them that were sent again.
    pub packets_out: u64,
    /// Packets that reached the board damaged.
    pub damaged_out: u64,
    /// Packets that reached the host damaged.
    pub damaged_in: u64,
    /// Packets sent again.
    pub retries: u64,
    /// Of those, the ones without a loss: the first answer was only late.
    pub late: u64,
    /// Answers that differ from what was sent although their CRC is right, which is not the link's fault.
    pub wrong: u64,
    /// Damaged packets as a share of all packets.
    pub rate: f64,
    /// The upper bound of the rate at 95 % confidence.
    pub bound: f64,
}

impl Errors {
    pub(super) fn between(before: Tally, after: Tally, damaged_out: u64, wrong: u64) -> Self {
        let damaged_in = after.damaged_in - before.damaged_in;
        let packets =
            after.packets_out + after.packets_in - before.packets_out - before.packets_in + damaged_in;
        let (damaged, all) = ((damaged_out + damaged_in) as f64, packets.max(1) as f64);
        Self {
            packets,
            packets_out: after.packets_out - before.packets_out,
            bytes: after.bytes_out + after.bytes_in - before.bytes_out - before.bytes_in,
            damaged_out,
            damaged_in,
            retries: after.retries - before.retries,
            late: after.late - before.late,
            wrong,
            rate: damaged / all,
            // Never below the exact Poisson bound, which is 3.0 for no error, 4.7 for one and 17.0 for ten.
            bound: ((damaged + 3.0 + 1.645 * damaged.sqrt()) / all).min(1.0),
        }
    }
}

impl Errors {
    /// Packets that arrived damaged on either side.
    #[must_use]
    pub fn damaged(&self) -> u64 {
        self.damaged_out + self.damaged_in
    }

    /// Packets that had to be sent again, since something was lost.
    #[must_use]
    pub fn lost(&self) -> u64 {
        self.retries.saturating_sub(self.late)
    }

    /// Whether a run over such a link would find it too poor.
    #[must_use]
    pub fn are_beyond(&self, limit: RetryLimit) -> bool {
        limit.is_exceeded(self.packets_out, self.lost())
    }
}

/// Round-trip times in microseconds of the link's clock.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RoundTrips {
    /// How many.
    pub count: usize,
    /// The shortest.
    pub least_us: f64,
    /// Half of them take no longer.
    pub median_us: f64,
    /// Nine in ten take no longer.
    pub p90_us: f64,
    /// Ninety-nine in a hundred take no longer.
    pub p99_us: f64,
    /// The longest.
    pub most_us: f64,
}

/// Bytes on the wire, including stuffing and headers.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Throughput {
    /// To the board.
    pub out: Rate,
    /// To the host.
    #[serde(rename = "in")]
    pub back: Rate,
    /// Duration by the link's clock, in seconds.
    pub seconds: f64,
}

/// How much went in one direction.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Rate {
    /// Bytes.
    pub bytes: u64,
    /// Bytes a second; none if the link's clock stood still.
    pub bytes_per_second: Option<f64>,
    /// The rate as a share of what the link itself carries, if that is known.
    pub share: Option<f64>,
}

impl Throughput {
    pub(super) fn between(before: Tally, after: Tally, time: Duration, limit: Option<f64>) -> Self {
        let seconds = time.as_secs_f64();
        let rate = |bytes: u64| {
            let bytes_per_second = (seconds > 0.0).then(|| bytes as f64 / seconds);
            let share = bytes_per_second.zip(limit).map(|(rate, limit)| rate / limit);
            Rate { bytes, bytes_per_second, share }
        };
        let (out, back) = (after.bytes_out - before.bytes_out, after.bytes_in - before.bytes_in);
        Self { out: rate(out), back: rate(back), seconds }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_error_among_n_packets_bounds_the_rate_by_three_in_n() {
        let after =
            Tally { packets_out: 500, packets_in: 500, bytes_out: 7, bytes_in: 8, ..Tally::default() };
        let errors = Errors::between(Tally::default(), after, 0, 0);
        assert_eq!((errors.packets, errors.bytes, errors.rate, errors.bound), (1000, 15, 0.0, 0.003));
        let errors = Errors::between(Tally::default(), Tally { damaged_in: 4, ..after }, 6, 0);
        // The exact bound for ten events is 16.96.
        assert_eq!((errors.packets, errors.rate), (1004, 10.0 / 1004.0));
        assert!((16.9..18.5).contains(&(errors.bound * 1004.0)), "{}", errors.bound);
    }

    /// As over a link that brings answers in another order. The limit of 100 packets is 16 and 5.
    #[test]
    fn packets_sent_again_although_nothing_was_lost_make_no_link_too_poor() {
        for (retries, late, too_poor) in [(21, 0, false), (22, 0, true), (40, 19, false), (40, 18, true)] {
            let tally = Tally { packets_out: 100, retries, late, ..Tally::default() };
            let errors = Errors::between(Tally::default(), tally, 0, 0);
            assert_eq!(errors.are_beyond(RetryLimit::default()), too_poor, "{retries}, {late} late");
        }
    }

    #[test]
    fn a_clock_that_stood_still_tells_no_rate() {
        let after = Tally { bytes_out: 100, bytes_in: 50, ..Tally::default() };
        let between = |time| Throughput::between(Tally::default(), after, time, Some(400.0));
        let still = between(Duration::ZERO);
        assert_eq!((still.out.bytes_per_second, still.back.share), (None, None));
        let moving = between(Duration::from_millis(500));
        assert_eq!((moving.out.bytes_per_second, moving.back.share), (Some(200.0), Some(0.25)));
    }
}
