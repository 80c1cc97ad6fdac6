//! What all pages have in common.

use axum::http::header::{CACHE_CONTROL, CONTENT_SECURITY_POLICY, CONTENT_TYPE};
use axum::http::{HeaderValue, StatusCode};
use axum::response::{IntoResponse as _, Response};
use maud::{DOCTYPE, Markup, html};

use super::routes::Who;
use super::visit::Visit;
use super::{language, request_guard};

/// A place of the navigation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Here {
    /// A page that is not in the navigation.
    Elsewhere,
    /// The lanes.
    Lanes,
    /// A plant's stations.
    Stations,
    /// A plant's jobs and shared boards.
    Jobs,
    /// Runs.
    History,
    /// First-pass and final yield.
    Yield,
    /// What fails most.
    Pareto,
}

impl Here {
    /// The places of the navigation that stations and plants have, each with its path and the key of its name.
    const ALL: [(Self, &'static str, Label); 3] = [
        (Self::History, "/history", Label { key: "nav.history" }),
        (Self::Yield, "/yield", Label { key: "nav.yield" }),
        (Self::Pareto, "/pareto", Label { key: "nav.pareto" }),
    ];

    /// The first place.
    const fn first(visit: &Visit) -> (Self, &'static str, Label) {
        if visit.is_plant {
            (Self::Stations, "/", Label { key: "plant.stations" })
        } else {
            (Self::Lanes, "/", Label { key: "nav.lanes" })
        }
    }
    /// Every place, in order.
    fn places(visit: &Visit) -> impl Iterator<Item = (Self, &'static str, Label)> {
        let jobs = visit.is_plant.then_some((Self::Jobs, "/jobs", Label { key: "jobs.title" }));
        std::iter::once(Self::first(visit)).chain(jobs).chain(Self::ALL)
    }
}

struct Label {
    key: &'static str,
}

/// A page: its place, its title, what its head has in addition to the common style sheet, and its content.
#[derive(Debug)]
pub(super) struct Page<'a> {
    pub(super) here: Here,
    pub(super) title: &'a str,
    pub(super) head: Markup,
    pub(super) content: Markup,
}

impl Page<'_> {
    /// The page as an answer to `visit`.
    pub(super) fn answer(self, visit: &Visit) -> Response {
        self.with_status(visit, StatusCode::OK)
    }

    /// The page as a part of one of the station's own pages, without the navigation.
    pub(super) fn framed(self, visit: &Visit) -> Response {
        let mut response = text(StatusCode::OK, self.markup(visit, false));
        response
            .headers_mut()
            .insert(CONTENT_SECURITY_POLICY, HeaderValue::from_static(request_guard::FRAMED));
        response
    }

    /// The page as an answer with this status.
    pub(super) fn with_status(self, visit: &Visit, status: StatusCode) -> Response {
        text(status, self.markup(visit, true))
    }

    fn markup(&self, visit: &Visit, is_whole: bool) -> Markup {
        html! {
            (DOCTYPE)
            html lang=(visit.words.code) {
                head {
                    meta charset="utf-8";
                    meta name="viewport" content="width=device-width, initial-scale=1";
                    meta name="color-scheme" content="light dark";
                    title { (self.title) " – " (visit.station) }
                    link rel="stylesheet" href="/assets/style.css";
                    link rel="icon" href="data:,";
                    (self.head)
                }
                body {
                    @if is_whole { (navigation(visit, self.here)) }
                    main { (self.content) }
                }
            }
        }
    }
}

fn text(status: StatusCode, markup: Markup) -> Response {
    let kind = HeaderValue::from_static("text/html; charset=utf-8");
    let keep = HeaderValue::from_static("no-store");
    (status, [(CONTENT_TYPE, kind), (CACHE_CONTROL, keep)], markup.into_string()).into_response()
}

fn navigation(visit: &Visit, here: Here) -> Markup {
    html! {
        header.top {
            span.station {
                @if visit.may(Who::Reader) && !visit.plans.is_empty() { b.plans { (visit.plans) } " · " }
                @if visit.is_plant { (visit.say("nav.plant")) } @else { (visit.say("nav.station")) } " " b { (visit.station) }
            }
            nav aria-label=(visit.say("nav.pages")) {
                @for (place, path, Label { key }) in Here::places(visit) {
                    a href=(path) aria-current=[(place == here).then_some("page")] { (visit.say(key)) }
                }
            }
            (who(visit))
            (languages(visit))
        }
    }
}

/// Who is logged in, and the way in or out.
fn who(visit: &Visit) -> Markup {
    html! {
        @match &visit.user {
            // A plant without users lets everybody look, without a name.
            Some(user) if user.name.is_empty() => {}
            Some(user) => {
                span.who { (user.name) " " span.role { "(" (role(visit, user.who)) ")" } }
                @if visit.can_log_in {
                    form method="post" action="/logout" {
                        input type="hidden" name="csrf" value=(visit.csrf);
                        button { (visit.say("login.out")) }
                    }
                }
            }
            None if visit.can_log_in => { a.who href="/login" { (visit.say("login.title")) } }
            None => {}
        }
    }
}

fn role(visit: &Visit, who: Who) -> &'static str {
    match who {
        Who::Engineer => visit.say("role.engineer"),
        Who::Operator => visit.say("role.operator"),
        Who::Reader | Who::Anyone => visit.say("role.reader"),
    }
}

fn languages(visit: &Visit) -> Markup {
    html! {
        form.languages method="post" action="/language" {
            input type="hidden" name="csrf" value=(visit.csrf);
            @for (code, name) in language::all() {
                button name="language" value=(code) lang=(code) disabled[code == visit.words.code] { (name) }
            }
        }
    }
}
