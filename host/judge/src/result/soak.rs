//! The results of a soak: hours of frames that a board makes at its full pixel clock.

use std::time::Duration;

use serde::{Deserialize, Serialize};

use super::{Finding, Suspect};

/// The most intervals of a [`SoakChart`].
const MOST_INTERVALS: usize = 240;

/// The requested length of a soak.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "of", rename_all = "kebab-case")]
pub enum SoakLength {
    /// A time on the link's clock.
    Time {
        /// The time in seconds. With 0, a negative number or NaN the soak is over before anything is judged; with infinity it
        /// never ends.
        seconds: f64,
    },
    /// Frames.
    Frames {
        /// Their number.
        frames: u64,
    },
}

/// The result of a soak, up to where it ended.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SoakReport {
    /// What was asked for.
    pub asked: SoakLength,
    /// How long it took on the link's clock, in seconds.
    pub seconds: f64,
    /// In how many of these seconds no frames were made: tables were changed, the board was away, or this computer stood still; 0 in
    /// earlier reports.
    #[serde(default)]
    pub idle_seconds: f64,
    /// Bursts, each with its own content.
    pub bursts: u32,
    /// Frames judged.
    pub frames: u64,
    /// Frames whose signature is not the reference's.
    pub wrong: u64,
    /// Frames whose signature is right and of which the board counts something wrong.
    #[serde(default)]
    pub miscounted: u64,
    /// Frames in which the enable was off at times, so that they were not at speed.
    pub paused: u64,
    /// Frames that waited until the host had the records of earlier ones.
    pub held_back: u64,
    /// The first difference of each burst, in order; only the first [`SoakReport::MOST_DIFFERENCES`] are kept.
    pub differences: Vec<SoakDifference>,
    /// Bursts in which something differed, those included that `differences` has no room for; 0 in earlier reports.
    #[serde(default)]
    pub differing_bursts: u32,
    /// Why it ended early although the run's finding is something that had differed before; none if it did not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ended: Option<Finding>,
    /// When frames were judged.
    pub chart: SoakChart,
}

impl SoakReport {
    /// The most differences that are kept.
    pub const MOST_DIFFERENCES: usize = 32;

    /// The report of a soak that has judged nothing yet.
    pub(crate) fn new(asked: SoakLength) -> Self {
        Self {
            asked,
            seconds: 0.0,
            idle_seconds: 0.0,
            bursts: 0,
            frames: 0,
            wrong: 0,
            miscounted: 0,
            paused: 0,
            held_back: 0,
            differences: Vec::new(),
            differing_bursts: 0,
            ended: None,
            chart: SoakChart::default(),
        }
    }

    /// Whether frames were made in less than nine tenths of the time that a soak by time took.
    #[must_use]
    pub fn is_idle(&self) -> bool {
        matches!(self.asked, SoakLength::Time { .. }) && self.idle_seconds > self.seconds / 10.0
    }

    /// How many bursts with a difference are missing where the first `listed` of the differences are told.
    #[must_use]
    pub fn unlisted(&self, listed: usize) -> usize {
        let kept = self.differences.len();
        kept.max(self.differing_bursts as usize) - kept.min(listed)
    }
}

/// What differed in a burst.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SoakDifference {
    /// When it was seen, in seconds of the link's clock since the soak began.
    pub seconds: f64,
    /// Seed of the burst's content (AT-SPEED.md).
    pub seed: u32,
    /// The generation of the tables active when the burst began; every other frame of a burst may have those of the other bank.
    pub generation: u8,
    /// What was seen. Its frame is counted from the beginning of the soak, and its other figures are those of the burst.
    pub finding: Finding,
    /// The parts to which it points, the likeliest first.
    pub suspects: Vec<Suspect>,
}

/// Frames judged over time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SoakChart {
    /// How long an interval is, in seconds.
    pub interval_seconds: f64,
    /// The intervals from the beginning on. In one without frames the board was away, or its tables were being changed.
    pub intervals: Vec<SoakInterval>,
}

/// What was judged in an interval.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct SoakInterval {
    /// Frames.
    pub frames: u64,
    /// How many of them have another signature than the reference's.
    pub wrong: u64,
    /// How many have the right signature and a wrong count.
    #[serde(default)]
    pub miscounted: u64,
}

impl SoakInterval {
    /// What was judged besides `other`, which is a part of it.
    pub(crate) fn without(self, other: Self) -> Self {
        Self {
            frames: self.frames - other.frames,
            wrong: self.wrong - other.wrong,
            miscounted: self.miscounted - other.miscounted,
        }
    }
}

impl Default for SoakChart {
    fn default() -> Self {
        Self { interval_seconds: 1.0, intervals: Vec::new() }
    }
}

impl SoakChart {
    /// Counts frames that were judged `time` after the soak began. When there would be too many intervals, they are merged in
    /// pairs.
    pub(crate) fn add(&mut self, time: Duration, judged: SoakInterval) {
        let mut index = (time.as_secs_f64() / self.interval_seconds) as usize;
        while index >= MOST_INTERVALS {
            let pairs = self.intervals.chunks(2);
            self.intervals =
                pairs.map(|pair| pair.iter().copied().fold(SoakInterval::default(), sum)).collect();
            self.interval_seconds *= 2.0;
            index /= 2;
        }
        if self.intervals.len() <= index {
            self.intervals.resize(index + 1, SoakInterval::default());
        }
        self.intervals[index] = sum(self.intervals[index], judged);
    }
}

fn sum(one: SoakInterval, other: SoakInterval) -> SoakInterval {
    SoakInterval {
        frames: one.frames + other.frames,
        wrong: one.wrong + other.wrong,
        miscounted: one.miscounted + other.miscounted,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_chart_keeps_every_frame_in_its_place_however_long_it_becomes() {
        let mut chart = SoakChart::default();
        for second in 0..28_800 {
            let wrong = u64::from(second == 14_400);
            chart.add(Duration::from_secs(second), SoakInterval { frames: 46, wrong, miscounted: 0 });
        }
        // 28,800 s / 128 s.
        assert_eq!((chart.interval_seconds, chart.intervals.len()), (128.0, 225));
        assert_eq!(chart.intervals.iter().map(|interval| interval.frames).sum::<u64>(), 46 * 28_800);
        let wrong = chart.intervals.iter().position(|interval| interval.wrong > 0);
        assert_eq!(wrong, Some(14_400 / 128));
        assert!(chart.intervals.iter().all(|interval| interval.frames == 46 * 128));
    }

    #[test]
    fn time_without_frames_is_an_empty_interval() {
        let mut chart = SoakChart::default();
        let judged = SoakInterval { frames: 1, wrong: 0, miscounted: 0 };
        chart.add(Duration::ZERO, judged);
        chart.add(Duration::from_millis(2500), judged);
        assert_eq!(chart.intervals.iter().map(|interval| interval.frames).collect::<Vec<_>>(), [1, 0, 1]);
    }
}
