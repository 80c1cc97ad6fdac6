//! Options that are times, and options without effect because of another one.

use std::ops::RangeInclusive;
use std::time::Duration;

use thiserror::Error;

/// How often a call can have its frames streamed.
pub const REPEATS: RangeInclusive<u32> = 1..=1000;

/// The most seconds that an option takes: some thirty years.
pub const MOST_SECONDS: f64 = 1e9;

/// The longest time that a run can be asked to keep within, in seconds.
const LONGEST: f64 = 1_000_000.0;

/// Advice on what [`within`] takes.
pub const WITHIN_TAKES: &str = "give a number of seconds, more than 0 and at most 1000000";

/// The option would have no effect beside another one that is given.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{option} {reason}")]
pub struct VoidOption {
    /// The option, as the caller names it.
    pub option: String,
    /// Why it does nothing, and what to do.
    pub reason: &'static str,
}

/// The option's value is not a number of seconds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error(
    "{option} takes a number of seconds; give {}, and at most {MOST_SECONDS:e}",
    if *.is_limit { "more than 0" } else { "0 or more" }
)]
pub struct NoTime {
    /// The option, as the caller names it.
    pub option: &'static str,
    /// Whether it limits the time of something that takes some.
    pub is_limit: bool,
}

/// Options that have no effect because something else decides in their place.
#[derive(Clone, Copy, Debug)]
pub struct Voided {
    /// The options, in small letters with `_` between words.
    pub options: &'static [&'static str],
    /// The words that follow the option's name: why, and what to do.
    pub reason: &'static str,
}

/// The frames to stream. A call of `verify` may name several.
pub const FRAMES: &str = "frame";

/// For a recording that is judged again. Its time limit is on the board's clock, so `timeout` remains for this computer's.
pub const BESIDE_RECORDING: Voided = Voided {
    options: &[
        FRAMES,
        "tables",
        "kernel",
        "phase",
        "raw",
        "fit",
        "repeat",
        "at_speed",
        "fail_fast",
        "within",
        "seed",
        "take_over",
        "retry_limit",
        "reconnect",
    ],
    reason: "does nothing beside a recording, which holds what was streamed, and how; leave it out, or judge a board",
};

/// For a recording that is being made.
pub const WHILE_RECORDED: Voided = Voided {
    options: &["reconnect"],
    reason: "does nothing beside a recording to make, which is of one link; give one of them",
};

/// For a time to judge within, for which the frames are chosen.
pub const WITHIN: Voided = Voided {
    options: &[FRAMES, "repeat"],
    reason: "does nothing beside a time to judge within, for which the frames are chosen; give one of them",
};

impl Voided {
    /// Refuses the first of these options that the call gives. `is_given` says which it gives, and `named` what it calls an
    /// option.
    ///
    /// # Errors
    /// [`VoidOption`]
    pub fn refuse(
        &self,
        is_given: impl Fn(&str) -> bool,
        named: impl FnOnce(&str) -> String,
    ) -> Result<(), VoidOption> {
        match self.options.iter().find(|option| is_given(option)) {
            Some(option) => Err(VoidOption { option: named(option), reason: self.reason }),
            None => Ok(()),
        }
    }
}

/// The time of an `option` in seconds.
///
/// # Errors
/// [`NoTime`] when it is below 0, not a number, or above [`MOST_SECONDS`].
pub fn seconds(option: &'static str, seconds: Option<f64>) -> Result<Option<Duration>, NoTime> {
    seconds.map(|seconds| time(seconds).ok_or(NoTime { option, is_limit: false })).transpose()
}

/// The most time that an `option` gives, in seconds.
///
/// # Errors
/// [`NoTime`] when it is no time that anything could end within: not above 0, not a number, or above [`MOST_SECONDS`].
pub fn time_limit(option: &'static str, seconds: Option<f64>) -> Result<Option<Duration>, NoTime> {
    let limit = |seconds| time(seconds).filter(|limit| !limit.is_zero());
    seconds.map(|seconds| limit(seconds).ok_or(NoTime { option, is_limit: true })).transpose()
}

fn time(seconds: f64) -> Option<Duration> {
    (0.0..=MOST_SECONDS).contains(&seconds).then(|| Duration::from_secs_f64(seconds))
}

/// `seconds` as a time to judge within; none if it is not what [`WITHIN_TAKES`] asks for.
#[must_use]
pub fn within(seconds: f64) -> Option<Duration> {
    let is_time = seconds > 0.0 && seconds <= LONGEST;
    is_time.then(|| Duration::from_secs_f64(seconds))
}
