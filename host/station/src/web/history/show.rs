//! How moments, verdicts and shares are shown on every page of the history.

use halfrow::Verdict;
use halfrow::words::plain;
use jiff::Timestamp;
use maud::{Markup, html};

use crate::history::rate::Rate;
use crate::history::runs::RunLine;
use crate::web::language::Sentence;
use crate::web::visit::Visit;

/// What a page of the history has in its head.
pub(in crate::web) fn head() -> Markup {
    html! { link rel="stylesheet" href="/assets/history.css"; }
}

/// A moment to the second, where nothing else says that it is UTC.
pub(in crate::web) fn moment(ms: i64) -> Markup {
    html! { (titled_moment(ms)) " UTC" }
}

/// A moment below or beside a title that says UTC.
pub(in crate::web) fn titled_moment(ms: i64) -> Markup {
    let Ok(moment) = Timestamp::from_millisecond(ms) else { return html! { (ms) } };
    html! { time datetime=(format!("{moment:.3}")) { (moment.strftime("%Y-%m-%d %H:%M:%S")) } }
}

/// What a scanner, a board or a person said, without control characters, which could reverse the text of the page.
pub(in crate::web) fn said(text: &str) -> Markup {
    html! { (plain(text)) }
}

/// A sentence, marked if its language is not that of the page.
pub(in crate::web) fn told(told: &Sentence) -> Markup {
    match told.foreign {
        Some(language) => html! { span lang=(language) { (said(&told.text)) } },
        None => said(&told.text),
    }
}

/// A sentence in English.
pub(in crate::web) fn english(visit: &Visit, text: &str) -> Markup {
    told(&visit.words.english(text.to_owned()))
}

/// A verdict as word, shape and colour; without one, that the run is open.
pub(in crate::web) fn verdict(visit: &Visit, verdict: Option<Verdict>) -> Markup {
    let Some(verdict) = verdict else {
        return html! { span.verdict.open { "▶ " (visit.say("history.open")) } };
    };
    let (class, shape) = match verdict {
        Verdict::Pass => ("verdict pass", "✔"),
        Verdict::Fail => ("verdict fail", "✖"),
        Verdict::Error => ("verdict error", "⚠"),
    };
    html! { span class=(class) { span aria-hidden="true" { (shape) " " } (verdict) } }
}

/// The verdict of a run, and that its FAIL is waived.
pub(super) fn outcome(visit: &Visit, run: &RunLine) -> Markup {
    html! {
        (verdict(visit, run.verdict))
        @if run.waived { " " span.waived { (visit.say("history.waived")) } }
    }
}

/// The address of a run's page.
pub(in crate::web) fn run_address(id: &str) -> String {
    format!("/runs/{id}")
}

/// A share in per cent, never without its interval.
pub(super) fn share(visit: &Visit, rate: &Rate) -> Markup {
    let Some(texts) = rate.per_cent() else { return html! { "–" } };
    let [share, low, high] = texts.map(|text| visit.words.figures(&text));
    html! {
        span.share { (share) " %" }
        " " span.interval { "(" (low) "–" (high) ")" }
    }
}

/// The two counts of a share.
pub(super) fn of(rate: &Rate) -> Markup {
    html! { (rate.count) "/" (rate.of) }
}

/// A number with the language's decimal point, to a millionth.
pub(super) fn number(visit: &Visit, value: f64) -> String {
    let text =
        if value.abs() >= 1e6 { format!("{value:.0}") } else { format!("{}", (value * 1e6).round() / 1e6) };
    visit.words.figures(&text)
}

/// A term with its value.
pub(super) fn pair(term: &str, value: impl maud::Render) -> Markup {
    html! { div { dt { (term) } dd { (value) } } }
}
