//! Shares as bars. They draw the numbers beside them, and add nothing for those who do not see them.

use maud::{Markup, html};

use super::show;
use super::yields::FEW;
use crate::history::control::Limits;
use crate::history::rate::Rate;
use crate::web::visit::Visit;

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

/// The width of a day, the width of what stands beside the days, and the height of a chart, in pixels.
const DAY: usize = 12;
const BESIDE: usize = 52;
const HEIGHT: usize = 130;

/// A day of a yield, or a week.
#[derive(Clone, Debug)]
pub(super) struct Day {
    pub(super) name: String,
    /// What is shown when it is pointed at.
    pub(super) said: String,
    pub(super) rate: Rate,
    /// What its share may be if nothing has changed.
    pub(super) limits: Option<Limits>,
}

/// A column for each day of a yield, the earliest first: share and interval, in the band of what they may be. `of` says what
/// the shares are of.
pub(super) fn days(visit: &Visit, of: &str, days: &[Day]) -> Markup {
    let floor = floor(days);
    let width = days.len() * DAY + BESIDE;
    let y = |share: f64| 8.0 + 100.0 * (1.0 - share.max(floor)) / (1.0 - floor);
    let last = days.len().saturating_sub(1);
    html! {
        svg.days viewBox=(format!("0 0 {width} {HEIGHT}")) height=(HEIGHT) width=(width) role="img" aria-label=(of) {
            @for share in [1.0, f64::midpoint(1.0, floor), floor] {
                rect.grid x="0" y=(format!("{:.1}", y(share))) width=(days.len() * DAY) height="1" {}
                text x=(days.len() * DAY + 4) y=(format!("{:.1}", y(share) + 4.0)) { (show::number(visit, 100.0 * share)) " %" }
            }
            @for (place, one) in days.iter().enumerate() {
                (day(place * DAY, one, floor, &y))
                @if place == 0 { text x="0" y=(HEIGHT - 4) { (one.name) } }
                @if place == last && last > 14 {
                    text x=(days.len() * DAY) y=(HEIGHT - 4) text-anchor="end" { (one.name) }
                }
            }
        }
    }
}

/// The share at which a chart of these days begins: where shares are high, the lower part would be empty.
fn floor(days: &[Day]) -> f64 {
    let low = |day: &Day| day.rate.interval.map(|[low, _]| low);
    let limit = |day: &Day| day.limits.map(|Limits { limits: [low, _], .. }| low);
    let shares = days.iter().filter_map(|day| day.rate.share);
    // The interval of a day with few units would leave no room for the others, if there are any.
    let is_many = |day: &&Day| day.rate.of >= FEW;
    let has_many = days.iter().any(|day| is_many(&day));
    let lows =
        days.iter().filter(|day| !has_many || is_many(day)).flat_map(|day| [low(day), limit(day)]).flatten();
    let floors = |least: f64| [0.95, 0.9, 0.8, 0.5].into_iter().find(|floor| *floor <= least);
    shares.chain(lows).reduce(f64::min).and_then(floors).unwrap_or(0.0)
}

fn day(x: usize, Day { said, rate, limits, .. }: &Day, floor: f64, y: &dyn Fn(f64) -> f64) -> Markup {
    let Some((share, [low, high])) = rate.share.zip(rate.interval) else { return html! {} };
    let place = |share: f64| format!("{:.1}", y(share));
    let height = |low: f64, high: f64| format!("{:.1}", (y(low) - y(high)).max(1.0));
    let is_beyond = limits.is_some_and(|limits| limits.is_beyond);
    html! {
        g {
            title { (said) }
            @if let Some(Limits { mean, limits: [least, most], .. }) = limits {
                rect.band x=(x) y=(place(*most)) width=(DAY) height=(height(*least, *most)) {}
                rect.mean x=(x) y=(place(*mean)) width=(DAY) height="1" {}
            }
            rect.interval x=(x + 5) y=(place(high)) width="2" height=(height(low, high)) {}
            // It goes on below the chart.
            @if low < floor { path.cut d=(format!("M{} {:.0} l-4 -6 h8 z", x + 6, y(floor) + 7.0)) {} }
            @if is_beyond {
                path.beyond d=(format!("M{} {} l5 9 h-10 z", x + 6, place(share))) {}
            } @else {
                circle.point cx=(x + 6) cy=(place(share)) r="3" {}
            }
        }
    }
}
