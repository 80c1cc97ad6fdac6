//! A lane on the page. Only the server draws it, for the page itself and after every change.

use halfrow::Verdict;
use halfrow::words::plain;
use maud::{Markup, html};
use serde::Serialize;

use super::shapes::{does, said, shape};
use crate::clock;
use crate::engine::{LaneDoing, LaneState};
use crate::floor::{Act, Shown, Word};
use crate::web::language::Sentence;
use crate::web::routes::Who;
use crate::web::visit::Visit;

/// A lane as it is sent to pages. They draw no verdict without its run and the hash of its record.
#[derive(Debug, Serialize)]
pub(super) struct LaneEvent {
    lane: String,
    state: Word,
    run: Option<String>,
    verdict: Option<Verdict>,
    record_sha256: Option<String>,
    /// For those who do not see the page.
    said: String,
    html: String,
}

impl LaneEvent {
    /// The event of this state, for `visit`.
    pub(super) fn new(visit: &Visit, state: &LaneState, doing: Option<&LaneDoing>) -> Self {
        let shown = state.shown.as_ref().filter(|_| state.state.is_verdict());
        let serial = state.serial.as_deref().unwrap_or_default();
        let word = said(visit, state.state);
        Self {
            lane: state.lane.clone(),
            state: state.state,
            run: shown.map(|shown| shown.run.clone()),
            verdict: shown.map(|shown| shown.verdict),
            record_sha256: shown.map(|shown| shown.record_sha256.clone()),
            said: visit
                .words
                .fill("lane.said", &[("lane", &state.lane), ("state", word), ("serial", serial)]),
            html: lane(visit, state, doing, Scripted::Yes).into_string(),
        }
    }
}

/// Whether a page has a script, which chooses the lane whose name is pressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scripted {
    Yes,
    No,
}

/// The lane.
pub(super) fn lane(
    visit: &Visit,
    state: &LaneState,
    doing: Option<&LaneDoing>,
    scripted: Scripted,
) -> Markup {
    let shown = state.shown.as_ref().filter(|_| state.state.is_verdict());
    let word = said(visit, state.state);
    html! {
        article.lane.(state.state.as_ref()).(length(word)) id={ "lane-" (state.lane) } data-lane=(state.lane) aria-labelledby={ "name-" (state.lane) }
            data-run=[shown.map(|shown| &shown.run)] data-record=[shown.map(|shown| &shown.record_sha256)] {
            header {
                h2 id={ "name-" (state.lane) } aria-label=(visit.words.fill("lane.name", &[("lane", &state.lane)])) {
                    (name(visit, &state.lane, scripted))
                }
                div.acts { (acts(visit, state)) }
                @if let Some(shown) = shown { (saved(visit, shown)) }
            }
            p.word { (shape(state.state)) span { (word) } }
            @if let Some(last) = &state.last { p.last { (of_before(visit, &state.lane, last)) } }
            @else { p.serial { (serial(state, shown)) } }
            (says(visit, state))
            @if state.state == Word::Running { (progress(visit, &state.lane, doing)) }
        }
    }
}

/// The lane's name, by which it is chosen if a script listens.
fn name(visit: &Visit, lane: &str, scripted: Scripted) -> Markup {
    html! {
        @if scripted == Scripted::Yes {
            button.name.(length(lane)) id={ "arm-" (lane) } type="button" data-arm=(lane) aria-pressed="false"
                aria-label=(visit.words.fill("lane.arm", &[("lane", lane)])) {
                (lane)
            }
        } @else { span.name.(length(lane)) { (lane) } }
    }
}

/// The serial number; after a run it is a link to all that was found.
fn serial(state: &LaneState, shown: Option<&Shown>) -> Markup {
    let serial = state.serial.as_deref().unwrap_or_default();
    html! {
        @match shown {
            Some(shown) => { a id={ "run-" (state.lane) } href={ "/runs/" (shown.run) } { (serial) } }
            None => { (serial) }
        }
    }
}

/// The verdict of the board before the one that is in the lane.
fn of_before(visit: &Visit, lane: &str, last: &Shown) -> Markup {
    let values = [("state", said(visit, last.verdict.into())), ("serial", &last.serial)];
    html! { a id={ "last-" (lane) } href={ "/runs/" (last.run) } { (visit.words.fill("lane.last", &values)) } }
}

/// The class of the style sheet for how large a word or a name can be.
fn length(word: &str) -> &'static str {
    match word.chars().count() {
        0..=5 => "short",
        6..=9 => "middle",
        _ => "long",
    }
}

/// What the operator should do now, and why.
fn says(visit: &Visit, state: &LaneState) -> Markup {
    let shown = state.shown.as_ref().filter(|_| state.state.is_verdict());
    let refused = state.refused.as_ref().map(|why| visit.words.parted(why, None));
    // What kept the last scan from being tested has to be dealt with first.
    let is_second = refused.as_ref().is_some_and(|(_, asked)| asked.is_some());
    let note = state.note.as_ref().map(|note| match state.state {
        // There is only one thing to do, whatever the reason.
        Word::Unsaved => (visit.words.tell(note), None),
        _ if is_second => (visit.words.tell(note), None),
        _ => visit.words.parted(note, None),
    });
    let error = shown.filter(|_| state.state == Word::Error).map(|shown| of_error(visit, shown));
    let fail = shown.filter(|_| state.state == Word::Fail);
    let is_unchecked = shown.is_some_and(|shown| state.state == Word::Pass && !shown.is_identity_checked);
    let told: Vec<_> = refused.into_iter().chain(note).chain(error).collect();
    let asked = told.iter().find_map(|(_, asked)| asked.as_ref());
    html! {
        @if let Some(does) = does(visit, state, asked.is_some()) { p.does { (does) } }
        @if let Some(asked) = asked { p.asks lang=[asked.foreign] { (plain(&asked.text)) } }
        @for (told, _) in &told { (why(told, None)) }
        @if let Some(shown) = fail {
            @let remedy = shown.remedy.as_ref().map(|text| visit.words.remedy(shown.finding.as_ref(), text));
            (why(&headline(visit, shown), remedy.as_ref()))
        }
        @if is_unchecked { p.why { (visit.say("run.unchecked")) } }
    }
}

/// Why there is no verdict, and what to do about it.
fn of_error(visit: &Visit, shown: &Shown) -> (Sentence, Option<Sentence>) {
    let recorded = shown.remedy.as_deref();
    match &shown.finding {
        Some(finding) => visit.words.parted(finding, recorded),
        None => (headline(visit, shown), recorded.map(|text| visit.words.english(text.to_owned()))),
    }
}

fn headline(visit: &Visit, shown: &Shown) -> Sentence {
    match &shown.finding {
        Some(finding) => visit.words.tell(finding),
        None => visit.words.english(shown.headline.clone()),
    }
}

/// The reason; what an engineer should do is shown when it is pointed at.
fn why(told: &Sentence, remedy: Option<&Sentence>) -> Markup {
    html! { p.why lang=[told.foreign] title=[remedy.map(|remedy| &remedy.text)] { (plain(&told.text)) } }
}

/// When the verdict was saved, by the station's clock; with the day, because a verdict may stay for days.
fn saved(visit: &Visit, shown: &Shown) -> Markup {
    let at = clock::local(shown.saved_ms);
    html! {
        p.saved {
            span { (visit.say("lane.saved")) } " "
            time datetime=(format!("{:.3}", at.timestamp())) title=(at.strftime("%Y-%m-%d %H:%M:%S %:z").to_string()) {
                (at.strftime("%Y-%m-%d %H:%M").to_string())
            }
        }
    }
}

/// What the run does; the script puts in what is reported later.
fn progress(visit: &Visit, lane: &str, of: Option<&LaneDoing>) -> Markup {
    let (rows, told) = (of.and_then(|of| of.what.rows()), of.map(|of| visit.words.doing(&of.what)));
    html! {
        p.doing lang=[told.as_ref().and_then(|told| told.foreign)] {
            @if let Some(told) = &told { (plain(&told.text)) }
        }
        progress aria-labelledby={ "name-" (lane) } max=[rows.map(|(_, of)| of)] value=[rows.map(|(done, _)| done)] {}
    }
}

/// What can be done with the lane, and may be by this visitor. A lane that waits is aborted, not taken out of service.
fn acts(visit: &Visit, state: &LaneState) -> Markup {
    let is_wanted = |act: &Act| *act != Act::Out || !matches!(state.state, Word::Waiting | Word::Out);
    let may =
        |act: &Act| visit.may(if matches!(act, Act::Out | Act::In) { Who::Engineer } else { Who::Operator });
    html! {
        @for act in state.can.iter().filter(|act| is_wanted(act) && may(act)) {
            @let (path, name) = button(visit, *act);
            form.act method="post" action={ "/lanes/" (state.lane) "/" (path) } {
                input type="hidden" name="csrf" value=(visit.csrf);
                @if *act == Act::Abort { input type="hidden" name="of" value=[state.run.as_ref().or(state.serial.as_ref())]; }
                button id={ (path) "-" (state.lane) } { (name) }
            }
        }
    }
}

/// The end of the button's address, and its label.
fn button(visit: &Visit, act: Act) -> (&'static str, &'static str) {
    match act {
        Act::Start => ("start", visit.say("lane.start")),
        Act::Abort => ("abort", visit.say("lane.abort")),
        Act::Out => ("out", visit.say("lane.out")),
        Act::In => ("in", visit.say("lane.in")),
    }
}
