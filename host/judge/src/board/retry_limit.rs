//! How poor a link may be.

/// How many packets may be sent again before a link is too poor to judge a board over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RetryLimit {
    /// Retries that any run may use, for the noise of plugging in.
    pub fixed: u64,
    /// In addition, this share of the packets sent.
    pub share: f64,
}

impl Default for RetryLimit {
    /// 16 and 5 %.
    fn default() -> Self {
        Self { fixed: 16, share: 0.05 }
    }
}

impl RetryLimit {
    /// No limit, for when nothing is judged.
    pub const NONE: Self = Self { fixed: u64::MAX, share: 0.0 };

    /// The default's fixed part, and `percent` (0 to 100) of the packets sent.
    #[must_use]
    pub fn of_percent(percent: f64) -> Self {
        Self { share: percent / 100.0, ..Self::default() }
    }

    /// The most retries allowed among `packets` packets.
    #[must_use]
    pub fn of(self, packets: u64) -> u64 {
        self.fixed.saturating_add((packets as f64 * self.share) as u64)
    }

    /// Whether a link is too poor over which `packets` were sent, `lost` of them again because something was lost.
    #[must_use]
    pub(crate) fn is_exceeded(self, packets: u64, lost: u64) -> bool {
        lost > self.of(packets)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_retry_limit_is_a_share_beyond_a_fixed_number() {
        assert_eq!(RetryLimit::default().of(0), 16);
        assert_eq!(RetryLimit::default().of(1000), 66);
    }
}
