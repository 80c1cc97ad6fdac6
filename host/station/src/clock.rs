//! The wall's clock.

use std::fs;
use std::path::Path;
use std::sync::LazyLock;
use std::time::{Instant, SystemTime, UNIX_EPOCH};

use jiff::tz::TimeZone;
use jiff::{Timestamp, Zoned};

/// Where the system keeps its time zone, and all others.
const HERE: &str = "/etc/localtime";
const ZONES: &str = "/usr/share/zoneinfo";

/// Milliseconds since 1970, UTC; 0 for a clock that stands before.
#[must_use]
pub(crate) fn now_ms() -> i64 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    i64::try_from(since.as_millis()).unwrap_or(i64::MAX)
}

/// Another computer's clock, as it was heard.
#[derive(Clone, Copy, Debug)]
pub struct HeardClock {
    ms: i64,
    heard: Instant,
}

impl HeardClock {
    /// It shows `ms`, milliseconds since 1970, UTC, at this moment.
    #[must_use]
    pub fn shows(ms: i64) -> Self {
        Self { ms, heard: Instant::now() }
    }

    /// What it shows by now, however the own clock was set since.
    pub(crate) fn now_ms(&self) -> i64 {
        self.ms.saturating_add(i64::try_from(self.heard.elapsed().as_millis()).unwrap_or(i64::MAX))
    }
}

/// This moment as a clock on the station's wall shows it.
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

/// The midnight by the station's clock before this moment, in milliseconds since 1970, UTC.
#[must_use]
pub(crate) fn midnight_ms(ms: i64) -> i64 {
    midnight(&local(ms)).unwrap_or(ms)
}

fn midnight(moment: &Zoned) -> Option<i64> {
    moment.start_of_day().ok().map(|midnight| midnight.timestamp().as_millisecond())
}

/// The zone of the variable `TZ`: a name, or a rule (POSIX.1-2024, 8.3).
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
    fn a_clock_on_the_wall_is_that_of_the_systems_zone() {
        // India is half an hour off the full one; Central Europe changes its clocks by a rule.
        let [india, europe] = ["IST-5:30", "CET-1CEST,M3.5.0,M10.5.0/3"].map(|rule| zone(rule).unwrap());
        let shown = |zone, ms| at(ms, zone).strftime("%d %H:%M").to_string();
        assert_eq!(shown(&india, DAY), "22 05:30");
        assert_eq!(
            (shown(&europe, DAY), shown(&europe, DAY - 180 * 24 * HOUR)),
            ("22 01:00".into(), "26 02:00".into())
        );
        assert_eq!(midnight(&at(DAY, &india)), Some(DAY - 11 * HOUR / 2));
        assert_eq!(midnight(&at(DAY + 23 * HOUR, &europe)), Some(DAY + 23 * HOUR));
        assert_eq!(zone("no/such/place"), None);
    }
}
