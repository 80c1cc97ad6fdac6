//! A lane on the page. The server alone draws it, for the page's first look as for every change.

use halfrow::Verdict;
use maud::{Markup, html};
use serde::Serialize;

use super::shapes::{class, does, said, shape};
use crate::engine::LaneState;
use crate::floor::Word;
use crate::web::live::Doing;
use crate::web::routes::Who;
use crate::web::visit::Visit;

/// A lane as pages are told of it. They draw no verdict without its run and the hash of its record.
#[derive(Debug, Serialize)]
pub(super) struct LaneEvent {
    lane: String,
    state: Word,
    run: Option<String>,
    verdict: Option<Verdict>,
    record_sha256: Option<String>,
    /// For those who do not see it.
    said: String,
    html: String,
}

impl LaneEvent {
    /// Of this state, for `visit`.
    pub(super) fn new(visit: &Visit, state: &LaneState, doing: Option<&Doing>) -> Self {
        let shown = state.shown.as_ref().filter(|_| is_verdict(state.state));
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
            html: lane(visit, state, doing).into_string(),
        }
    }
}

fn is_verdict(word: Word) -> bool {
    matches!(word, Word::Pass | Word::Fail | Word::Error)
}

/// The lane.
pub(super) fn lane(visit: &Visit, state: &LaneState, doing: Option<&Doing>) -> Markup {
    let shown = state.shown.as_ref().filter(|_| is_verdict(state.state));
    let word = said(visit, state.state);
    html! {
        article.lane.(class(state.state)).(length(word)) id={ "lane-" (state.lane) } data-lane=(state.lane)
            data-run=[shown.map(|shown| &shown.run)] data-record=[shown.map(|shown| &shown.record_sha256)] {
            header {
                h2 {
                    button.name type="button" data-arm=(state.lane) aria-label=(visit.words.fill("lane.arm", &[("lane", &state.lane)])) {
                        (state.lane)
                    }
                }
                (acts(visit, state))
            }
            p.word { (shape(state.state)) span { (word) } }
            p.serial { (state.serial.as_deref().unwrap_or_default()) }
            (says(visit, state))
            @if state.state == Word::Running { (progress(doing)) }
        }
    }
}

/// How large the word can be: a class of the style sheet.
fn length(word: &str) -> &'static str {
    match word.chars().count() {
        0..=5 => "short",
        6..=9 => "middle",
        _ => "long",
    }
}

/// What the operator does now, and why.
fn says(visit: &Visit, state: &LaneState) -> Markup {
    let shown = state.shown.as_ref().filter(|_| matches!(state.state, Word::Fail | Word::Error));
    html! {
        p.does { (does(visit, state.state)) }
        @if let Some(note) = &state.note { p.why lang="en" { (note) } }
        @if let Some(shown) = shown {
            p.why lang="en" title=(shown.remedy.as_deref().unwrap_or_default()) { (shown.headline) }
        }
    }
}

/// What the run does; the script puts in what is told later.
fn progress(doing: Option<&Doing>) -> Markup {
    let rows = doing.and_then(|doing| doing.rows);
    html! {
        p.doing lang="en" { (doing.map_or("", |doing| doing.what.as_str())) }
        progress max=[rows.map(|(_, of)| of)] value=[rows.map(|(done, _)| done)] {}
    }
}

/// What may be done with the lane.
fn acts(visit: &Visit, state: &LaneState) -> Markup {
    let (start, abort) =
        (Act::new("start", visit.say("lane.start")), Act::new("abort", visit.say("lane.abort")));
    let (out, back) = (Act::new("out", visit.say("lane.out")), Act::new("in", visit.say("lane.in")));
    let acts = match state.state {
        Word::Waiting if state.is_present => vec![start, abort],
        Word::Waiting | Word::Running => vec![abort],
        Word::Out => vec![back],
        Word::Saving | Word::Unsaved => vec![],
        _ => vec![out],
    };
    let may =
        |act: &Act| visit.may(if ["out", "in"].contains(&act.path) { Who::Engineer } else { Who::Operator });
    html! {
        @for act in acts.into_iter().filter(may) {
            form.act method="post" action={ "/lanes/" (state.lane) "/" (act.path) } {
                input type="hidden" name="csrf" value=(visit.csrf);
                button id={ (act.path) "-" (state.lane) } { (act.name) }
            }
        }
    }
}

struct Act {
    path: &'static str,
    name: &'static str,
}

impl Act {
    fn new(path: &'static str, name: &'static str) -> Self {
        Self { path, name }
    }
}
