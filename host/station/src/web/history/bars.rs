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

/// A column for each day of a yield: share and interval, the earliest first. `days` says what a column is.
pub(super) fn days(days: &[(String, Rate)]) -> Markup {
    let step = 12;
    let width = days.len() * step;
    let y = |share: f64| format!("{:.1}", 4.0 + 100.0 * (1.0 - share));
    html! {
        svg.days viewBox=(format!("0 0 {} 108", width.max(step))) height="108" width=(width) role="img" {
            @for share in [0.0, 0.5, 1.0] { rect.grid x="0" y=(y(share)) width=(width) height="0.5" {} }
            @for (place, (name, rate)) in days.iter().enumerate() {
                @if let Some((share, [low, high])) = rate.share.zip(rate.interval) {
                    g {
                        title { (name) }
                        rect.interval x=(place * step + 5) y=(y(high)) width="2"
                            height=(format!("{:.1}", (100.0 * (high - low)).max(1.0))) {}
                        circle.point cx=(place * step + 6) cy=(y(share)) r="3" {}
                    }
                }
            }
        }
    }
}
