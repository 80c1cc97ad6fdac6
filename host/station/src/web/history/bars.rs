//! Shares as bars. They are drawings of the numbers beside them, and say nothing to who does not see them.

use maud::{Markup, html};

use crate::history::rate::Rate;

/// A bar as long as the share, and the 95 % interval over it.
pub(super) fn share(rate: &Rate) -> Markup {
    let Some((share, [low, high])) = rate.share.zip(rate.interval) else { return html! {} };
    let at = |value: f64| format!("{:.2}", 200.0 * value);
    html! {
        svg.bar viewBox="0 0 200 16" width="200" height="16" aria-hidden="true" {
            rect.all x="0" y="3" width="200" height="10" {}
            rect.share x="0" y="3" width=(at(share)) height="10" {}
            rect.interval x=(at(low)) y="7" width=(at((high - low).max(0.005))) height="2" {}
            rect.interval x=(at(low)) y="4" width="1" height="8" {}
            rect.interval x=(at(high.min(0.995))) y="4" width="1" height="8" {}
        }
    }
}

/// A bar for `count`, where the longest stands for `most`.
pub(super) fn length(count: u64, most: u64) -> Markup {
    let width = format!("{:.2}", 200.0 * count as f64 / most.max(1) as f64);
    html! {
        svg.bar viewBox="0 0 200 16" width="200" height="16" aria-hidden="true" {
            rect.all x="0" y="3" width="200" height="10" {}
            rect.fails x="0" y="3" width=(width) height="10" {}
        }
    }
}

/// Pixels of a day, of what stands beside the days, and of a chart's height.
const DAY: usize = 12;
const BESIDE: usize = 52;
const HEIGHT: usize = 130;

/// A column for each day of a yield: share and interval, the earliest first. Each day has its name and what stands there
/// when it is pointed at; `of` says what they are for.
pub(super) fn days(of: &str, days: &[(String, String, Rate)]) -> Markup {
    let least = days.iter().filter_map(|(.., rate)| rate.interval).map(|[low, _]| low).fold(1.0, f64::min);
    // Where shares are high, what is below would be empty.
    let floor = [0.95, 0.9, 0.8, 0.5].into_iter().find(|floor| *floor <= least).unwrap_or(0.0);
    let width = days.len() * DAY + BESIDE;
    let y = |share: f64| 8.0 + 100.0 * (1.0 - share) / (1.0 - floor);
    let last = days.len().saturating_sub(1);
    html! {
        svg.days viewBox=(format!("0 0 {width} {HEIGHT}")) height=(HEIGHT) width=(width) role="img" aria-label=(of) {
            @for share in [1.0, f64::midpoint(1.0, floor), floor] {
                rect.grid x="0" y=(format!("{:.1}", y(share))) width=(days.len() * DAY) height="1" {}
                text x=(days.len() * DAY + 4) y=(format!("{:.1}", y(share) + 4.0)) { (100.0 * share) " %" }
            }
            @for (place, (name, said, rate)) in days.iter().enumerate() {
                (day(place * DAY, said, rate, &y))
                @if place == 0 { text x="0" y=(HEIGHT - 4) { (name) } }
                @if place == last && last > 14 {
                    text x=(days.len() * DAY) y=(HEIGHT - 4) text-anchor="end" { (name) }
                }
            }
        }
    }
}

fn day(x: usize, said: &str, rate: &Rate, y: &dyn Fn(f64) -> f64) -> Markup {
    let Some((share, [low, high])) = rate.share.zip(rate.interval) else { return html! {} };
    html! {
        g {
            title { (said) }
            rect.interval x=(x + 5) y=(format!("{:.1}", y(high))) width="2"
                height=(format!("{:.1}", (y(low) - y(high)).max(1.0))) {}
            circle.point cx=(x + 6) cy=(format!("{:.1}", y(share))) r="3" {}
        }
    }
}
