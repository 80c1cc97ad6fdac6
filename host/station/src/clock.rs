//! The wall clock.

use std::fs;
use std::ops::{Add, Range};
use std::path::Path;
use std::sync::LazyLock;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use jiff::tz::TimeZone;
use jiff::{Timestamp, Zoned};
use nix::time::{ClockId, clock_gettime};

/// Where the system keeps its own time zone, and all time zones.
const HERE: &str = "/etc/localtime";
const ZONES: &str = "/usr/share/zoneinfo";

/// Milliseconds of a day of 24 hours.
pub(crate) const DAY_MS: i64 = 86_400_000;

/// Milliseconds since 1970, UTC; 0 if the clock is set before that.
#[must_use]
pub(crate) fn now_ms() -> i64 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    i64::try_from(since.as_millis()).unwrap_or(i64::MAX)
}

/// A moment on the clock that nobody sets and that keeps running while the computer sleeps, on which `Instant` stands still.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Moment {
    since_start_ms: i64,
}

impl Moment {
    pub(crate) fn now() -> Self {
        Self { since_start_ms: since_start_ms() }
    }

    /// Milliseconds since the computer was started.
    pub(crate) fn since_start_ms(self) -> i64 {
        self.since_start_ms
    }

    /// The time that has passed since then.
    pub(crate) fn elapsed(self) -> Duration {
        let passed_ms = since_start_ms().saturating_sub(self.since_start_ms);
        Duration::from_millis(u64::try_from(passed_ms).unwrap_or(0))
    }

    #[cfg(test)]
    pub(crate) fn ago(time: Duration) -> Self {
        Self { since_start_ms: since_start_ms() - time.as_millis() as i64 }
    }
}

impl Add<Duration> for Moment {
    type Output = Self;

    fn add(self, time: Duration) -> Self {
        let time_ms = i64::try_from(time.as_millis()).unwrap_or(i64::MAX);
        Self { since_start_ms: self.since_start_ms.saturating_add(time_ms) }
    }
}

/// Another computer's clock, as it was last heard.
#[derive(Clone, Copy, Debug)]
pub struct HeardClock {
    ms: i64,
    heard_ms: i64,
}

/// How long another computer's clock is trusted once it was heard, in milliseconds. While a virtual computer is paused
/// all its clocks stand still, and afterwards only its wall clock is set right.
const TELLS_MS: i64 = 5 * 60_000;

impl HeardClock {
    /// It shows `ms`, milliseconds since 1970, UTC, at this moment.
    #[must_use]
    pub fn shows(ms: i64) -> Self {
        Self { ms, heard_ms: since_start_ms() }
    }

    /// What it shows now, however this computer's own clock was set since; `None` if it was heard too long ago.
    pub(crate) fn now_ms(&self) -> Option<i64> {
        self.at(since_start_ms())
    }

    /// What it shows `since_start_ms` milliseconds after this computer was started.
    fn at(&self, since_start_ms: i64) -> Option<i64> {
        let passed_ms = since_start_ms.saturating_sub(self.heard_ms);
        (passed_ms < TELLS_MS).then(|| self.ms.saturating_add(passed_ms))
    }
}

/// Milliseconds since the computer was started, by the clock that nobody sets and that keeps running while the
/// computer sleeps (`CLOCK_BOOTTIME` of clock_gettime(2)).
fn since_start_ms() -> i64 {
    let now = clock_gettime(ClockId::CLOCK_BOOTTIME).map(|now| (now.tv_sec(), now.tv_nsec()));
    let (seconds, nanoseconds) = now.unwrap_or_default();
    seconds.saturating_mul(1000).saturating_add(nanoseconds / 1_000_000)
}

/// The moment `ms` as a clock on the station's wall shows it.
#[must_use]
pub(crate) fn local(ms: i64) -> Zoned {
    static ZONE: LazyLock<TimeZone> = LazyLock::new(|| {
        let named = std::env::var("TZ").ok().filter(|name| !name.is_empty());
        named.map_or_else(|| read(Path::new(HERE)), |name| zone(&name)).unwrap_or(TimeZone::UTC)
    });
    at(ms, &ZONE)
}

fn at(ms: i64, zone: &TimeZone) -> Zoned {
    Timestamp::from_millisecond(ms).unwrap_or_default().to_zoned(zone.clone())
}

/// The day of `ms` by the station's clock, from midnight to midnight, in milliseconds since 1970, UTC.
#[must_use]
pub(crate) fn day_ms(ms: i64) -> Range<i64> {
    day(&local(ms)).unwrap_or(ms..i64::MAX)
}

/// It has 23 or 25 hours when clocks are changed.
fn day(moment: &Zoned) -> Option<Range<i64>> {
    let [first, next] = [moment.start_of_day(), moment.tomorrow().and_then(|next| next.start_of_day())]
        .map(|midnight| midnight.ok().map(|midnight| midnight.timestamp().as_millisecond()));
    Some(first?..next?)
}

/// The zone that the variable `TZ` names, or describes by a rule (POSIX.1-2024, 8.3).
fn zone(name: &str) -> Option<TimeZone> {
    let name = name.trim_start_matches(':');
    TimeZone::posix(name).ok().or_else(|| read(&Path::new(ZONES).join(name)))
}

fn read(path: &Path) -> Option<TimeZone> {
    TimeZone::tzif("station", &fs::read(path).ok()?).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 22 November 2026, midnight UTC.
    const DAY: i64 = 1_795_305_600_000;
    const HOUR: i64 = 3_600_000;

    #[test]
    fn a_clock_that_was_heard_long_ago_tells_nothing() {
        let clock = HeardClock { ms: DAY, heard_ms: 7_000 };
        assert_eq!(clock.at(8_000), Some(DAY + 1_000));
        // Five minutes.
        assert_eq!(clock.at(7_000 + 299_999), Some(DAY + 299_999));
        assert_eq!(clock.at(7_000 + 300_000), None);
    }

    #[test]
    fn a_clock_on_the_wall_is_that_of_the_systems_zone() {
        // India is half an hour off the full one; Central Europe changes its clocks by a rule.
        let [india, europe] = ["IST-5:30", "CET-1CEST,M3.5.0,M10.5.0/3"].map(|rule| zone(rule).unwrap());
        let shown = |zone, ms| at(ms, zone).strftime("%d %H:%M").to_string();
        assert_eq!(shown(&india, DAY), "22 05:30");
        assert_eq!(
            (shown(&europe, DAY), shown(&europe, DAY - 180 * 24 * HOUR)),
            ("22 01:00".into(), "26 02:00".into())
        );
        let midnight = DAY - 11 * HOUR / 2;
        assert_eq!(day(&at(DAY, &india)), Some(midnight..midnight + 24 * HOUR));
        assert_eq!(day(&at(DAY + 23 * HOUR, &europe)), Some(DAY + 23 * HOUR..DAY + 47 * HOUR));
        // Some write a colon first, which POSIX.1-2024, 8.3 has only for values that are not rules.
        let with_colon = zone(":IST-5:30").unwrap();
        assert_eq!(shown(&with_colon, DAY), "22 05:30");
        assert_eq!(zone("no/such/place"), None);
    }

    #[test]
    fn the_days_on_which_clocks_are_changed_are_an_hour_shorter_and_longer() {
        let europe = zone("CET-1CEST,M3.5.0,M10.5.0/3").unwrap();
        // 29 March 2026, midnight UTC+1, and 25 October 2026, midnight UTC+2.
        for (midnight, hours) in [(1_774_738_800_000, 23), (1_792_879_200_000, 25)] {
            for hour in [0, hours - 1] {
                let of = day(&at(midnight + hour * HOUR, &europe));
                assert_eq!(of, Some(midnight..midnight + hours * HOUR), "{hour}");
            }
        }
    }
}
