//! The frames judged over the hours of a soak, and what differed in them.

use std::fmt::Write as _;

use maud::{Markup, html};

use super::suspects;
use crate::report::wording;
use crate::result::{SoakChart, SoakInterval, SoakReport};
use crate::words::{count, grouped, plain, span};

/// The height of the tallest bar.
const TALLEST: u64 = 100;
/// The height of the lowest bar, so that a few frames are visible next to many.
const LOWEST: u64 = 2;
/// The height of the lowest bar of frames that differ, which must catch the eye.
const LOWEST_WRONG: u64 = 15;

/// The section of a soak.
pub(super) fn section(soak: &SoakReport) -> Markup {
    html! {
        section {
            h2 { "At speed, over time" }
            p { (wording::soak(soak)) "." }
            (chart(&soak.chart))
            @if !soak.differences.is_empty() { (differences(soak)) }
        }
    }
}

/// A pale bar for each interval, as tall as the number of its frames, with a red one over it for those that differ or are
/// miscounted.
fn chart(chart: &SoakChart) -> Markup {
    let most = chart.intervals.iter().map(|interval| interval.frames).max().unwrap_or(0);
    let bars = |count: fn(&SoakInterval) -> u64, lowest: u64| {
        let counts = chart.intervals.iter().map(count).enumerate().filter(|(_, count)| *count > 0);
        counts.fold(String::new(), |mut path, (place, count)| {
            let height = (count * TALLEST / most.max(1)).max(lowest);
            let _ = write!(path, "M{place} {TALLEST}v-{height}h1v{height}z");
            path
        })
    };
    let interval = span(chart.interval_seconds);
    let (whole, longest) = (chart.interval_seconds * chart.intervals.len() as f64, grouped(most));
    let caption = format!("Frames judged in each {interval}: at most {longest}");
    html! {
        figure {
            div.chart.time {
                svg viewBox=(format!("0 0 {} {TALLEST}", chart.intervals.len().max(1)))
                    preserveAspectRatio="none" role="img" aria-label=(caption) {
                    title { (caption) }
                    path.judged d=(bars(|interval| interval.frames, LOWEST)) {}
                    path.wrong d=(bars(|interval| interval.wrong + interval.miscounted, LOWEST_WRONG)) {}
                }
            }
            div.axis { span { "0" } span { (span(whole)) } }
            figcaption { (caption) ". Red: wrong frames. Gaps: no frames judged." }
        }
    }
}

fn differences(soak: &SoakReport) -> Markup {
    let listed = soak.differences.len();
    let unlisted = soak.unlisted(listed);
    html! {
        h3 { "What differed" }
        ol.suspects { @for difference in &soak.differences {
            li {
                p { (plain(&wording::soak_difference(difference))) }
                @if !difference.suspects.is_empty() {
                    details {
                        summary { "Suspects" }
                        (suspects(&difference.suspects, false))
                    }
                }
            }
        } }
        @if unlisted > 0 {
            p { "… and " (count(unlisted, "more difference")) "; only the first " (listed) " are looked into." }
        }
    }
}
