//! What was taken of a run that had to keep within a time, and what other times would find.

use std::fmt::Write as _;

use maud::{Markup, html};

use crate::report::wording;
use crate::result::WithinReport;
use crate::words::{grouped, span};

/// Width and height of the chart.
const WIDE: f64 = 240.0;
const HIGH: f64 = 100.0;

/// The section of a run within a time.
pub(super) fn section(within: &WithinReport) -> Markup {
    html! {
        section {
            h2 { "Within " (span(within.seconds)) }
            @for told in wording::within(within) { p { (told) "." } }
            (chart(within))
        }
    }
}

/// The faults found over time, with a step for each part that is taken. It ends where nothing more is found or the allowed
/// time is over, whichever is later.
fn chart(within: &WithinReport) -> Markup {
    let (Some(last), most) = (within.curve.last(), within.faults.max(1)) else { return Markup::default() };
    let longest = last.seconds.max(within.seconds).max(f64::MIN_POSITIVE);
    let across = |seconds: f64| seconds / longest * WIDE;
    let mut path = String::new();
    for point in &within.curve {
        let height = point.found as f64 / most as f64 * HIGH;
        let (left, width) = (across(point.seconds), WIDE - across(point.seconds));
        let _ = write!(path, "M{left:.1} {HIGH}v-{height:.1}h{width:.1}V{HIGH}z");
    }
    let limit = format!("M{:.1} 0h1v{HIGH}h-1z", across(within.seconds).min(WIDE - 1.0));
    let (faults, found) = (grouped(within.faults), grouped(last.found));
    let [width, height] = within.measured_at;
    let measured =
        if within.measured { String::new() } else { format!(", as measured at {width} x {height}") };
    let caption = format!("Faults found (of {faults}){measured} against time on this link, up to {found}");
    html! {
        figure {
            div.chart.time {
                svg viewBox=(format!("0 0 {WIDE} {HIGH}")) preserveAspectRatio="none" role="img" aria-label=(caption) {
                    title { (caption) }
                    path.judged d=(path) {}
                    path.wrong d=(limit) {}
                }
            }
            div.axis { span { "0" } span { (span(longest)) } }
            figcaption { (caption) "; the red line is the time that was given." }
        }
    }
}
