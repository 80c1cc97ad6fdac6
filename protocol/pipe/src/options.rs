//! The properties of a pipe without faults.

use std::num::NonZeroU64;
use std::time::Duration;

use crate::value::{Decimal, Limits, ValueError};

const SPEED: Limits = Limits::new("speed", 1, 1_000_000_000_000);
const DELAY: Decimal = Decimal::new("delay", 0.0, 60.0);
const BUFFER: Limits = Limits::new("buffer", 0, 1 << 30);

/// The properties of a pipe, the same in both directions.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PipeOptions {
    /// Bytes per second; none for no limit.
    pub speed: Option<NonZeroU64>,
    /// Time from when a byte has left one end until it arrives at the other.
    pub delay: Duration,
    /// Bytes that a direction holds before they are handed over. As on a real link, a buffer smaller than speed times delay
    /// slows the pipe down. With 0, the host's bytes are taken only while the board has nothing to send: a host that sends
    /// without listening waits for ever.
    pub buffer: usize,
}

impl Default for PipeOptions {
    /// No limit, no delay and 64 KiB.
    fn default() -> Self {
        Self { speed: None, delay: Duration::ZERO, buffer: 1 << 16 }
    }
}

impl PipeOptions {
    /// The names of all options.
    pub(crate) const KEYS: [&str; 3] = [SPEED.key(), DELAY.key(), BUFFER.key()];

    /// Sets one option from text, as in `speed=1200000` (bytes per second), `delay=0.001` (seconds) or `buffer=4096`
    /// (bytes). Returns false, with nothing changed, for a key that is no option.
    ///
    /// # Errors
    /// If the value is outside the option's range.
    pub fn set(&mut self, key: &str, value: &str) -> Result<bool, ValueError> {
        if key == SPEED.key() {
            self.speed = NonZeroU64::new(SPEED.parse(value)?);
        } else if key == DELAY.key() {
            self.delay = Duration::from_secs_f64(DELAY.parse(value)?);
        } else if key == BUFFER.key() {
            self.buffer = BUFFER.parse(value)?;
        } else {
            return Ok(false);
        }
        Ok(true)
    }
}
