//! The page itself.

use std::ops::Range;

use axum::extract::State;
use axum::response::{Html, IntoResponse as _, Response};
use maud::{Markup, html};

use super::acts::ScanReply;
use super::lane::{Scripted, lane};
use crate::clock::{self, Moment};
use crate::floor::CHOSEN;
use crate::history::Period;
use crate::history::rate::Rate;
use crate::history::yields::{By, Wanted, Yields, yields};
use crate::store::{SINK_OF_PLANT, Snapshot, Unsent};
use crate::web::history::show;
use crate::web::layout::{Here, Page};
use crate::web::live::Now;
use crate::web::routes::Who;
use crate::web::state::{App, Lanes};
use crate::web::trouble::Trouble;
use crate::web::visit::Visit;

/// How often the lanes are loaded anew without the page's script, in seconds.
const ANEW: u32 = 5;

pub(super) async fn page(State(app): State<App>, visit: Visit) -> Result<Response, Trouble> {
    drawn(app, visit, None).await
}

/// The page with the result of a scan that was sent without a script.
pub(super) async fn answered(app: App, visit: Visit, answer: ScanReply) -> Result<Response, Trouble> {
    drawn(app, visit, Some(answer)).await
}

async fn drawn(app: App, visit: Visit, answer: Option<ScanReply>) -> Result<Response, Trouble> {
    let Lanes { live, hints, .. } = app.lanes(&visit)?;
    let (now, today) = (live.now(), counted(&app, &visit).await);
    let changes = app.settings().sink_names().next().is_some();
    let head = html! {
        link rel="stylesheet" href="/assets/operator.css";
        noscript { link rel="stylesheet" href="/assets/still.css"; }
        script type="module" src="/assets/operator.js" {}
    };
    let content = html! {
        section #station data-csrf=(visit.csrf) data-mark=(super::mark(&app, &visit)) data-not-live=(visit.say("live.not")) data-live=(visit.say("live.live"))
            data-unsent=(visit.say("scan.unsent")) data-unpressed=(visit.say("lane.unsent")) data-undrawn=(visit.say("live.undrawn"))
            data-chosen=(CHOSEN.as_millis()) data-over=(visit.say("scan.over"))
            data-known[visit.user.is_some()] {
            h1.heard { (visit.say("nav.lanes")) }
            (scan_box(&visit, &now, answer.as_ref()))
            p #notice .notice role="alert" data-lane=(visit.say("hand.lane")) {}
            (hint(hints, &now, |values| visit.words.fill("demo.try", values)))
            noscript { (hint(hints, &now, |values| visit.words.fill("demo.still", values))) }
            // What is typed stays when the lanes are loaded anew, because they are in a page of their own.
            noscript { iframe src="/still" title=(visit.say("nav.lanes")) {} }
            (floor(&visit, &now, Scripted::Yes))
            footer #today data-changes[changes] { (or_why(today)) }
            div #said .heard role="log" {}
        }
    };
    Ok(Page { here: Here::Lanes, title: visit.say("nav.lanes"), head, content }.answer(&visit))
}

/// The lanes alone, which are loaded anew without a script.
pub(super) async fn still(State(app): State<App>, visit: Visit) -> Result<Response, Trouble> {
    let (now, today) = (app.lanes(&visit)?.live.now(), counted(&app, &visit).await);
    let head = html! {
        meta http-equiv="refresh" content=(ANEW);
        base target="_top";
        link rel="stylesheet" href="/assets/operator.css";
    };
    let content = html! {
        section #station {
            h1.heard { (visit.say("nav.lanes")) }
            (untold(&visit))
            (floor(&visit, &now, Scripted::No))
            footer #today { (or_why(today)) " · " (live_lamp(&visit)) }
        }
    };
    Ok(Page { here: Here::Lanes, title: visit.say("nav.lanes"), head, content }.framed(&visit))
}

/// What a visitor of a demonstration may try, in these words.
fn hint(hints: &[String], now: &Now, words: impl FnOnce(&[(&str, &str)]) -> String) -> Markup {
    let Some((serial, lane)) = hints.first().zip(now.lanes.last()) else { return html! {} };
    html! { p.hint { (words(&[("lane", lane.lane.as_str()), ("serial", serial)])) } }
}

/// Every lane.
fn floor(visit: &Visit, now: &Now, scripted: Scripted) -> Markup {
    html! {
        div #floor .floor.{ "of-" (shape_of(now.lanes.len())) } {
            @for state in &now.lanes { (lane(visit, state, now.doing.get(&state.lane), scripted)) }
        }
    }
}

/// Which arrangement this many lanes have.
fn shape_of(lanes: usize) -> usize {
    [1, 2, 3, 4, 8].into_iter().find(|&most| lanes <= most).unwrap_or(16)
}

/// Why it is not known who looks, which is the reason that nobody can do anything.
fn untold(visit: &Visit) -> Markup {
    html! {
        @if let Some(why) = &visit.untold { p.badge { (show::told(&visit.words.tell(why))) } }
    }
}

/// Where scans appear. It is also there while nobody is logged in, because badges are scanned.
fn scan_box(visit: &Visit, now: &Now, answer: Option<&ScanReply>) -> Markup {
    let class = answer.map_or("", |answer| if answer.is_taken { "taken" } else { "refused" });
    html! {
        (untold(visit))
        @if visit.can_log_in && !visit.may(Who::Operator) && visit.untold.is_none() {
            p.badge { strong { (visit.say("scan.badge")) } " " a href="/login" { (visit.say("scan.login")) } }
        }
        div.scan {
            span.scans { (visit.say("scan.scan")) }
            output #typed .typed aria-label=(visit.say("scan.typed")) {}
            span #armed .armed data-for=(visit.say("scan.for")) {}
            output #answer .answer.(class) role="status" { @if let Some(answer) = answer { (answer.said) } }
            span #counter .counter title=(visit.say("scan.counter")) {}
            span.tools {
                button #type type="button" hidden aria-pressed="false" { (visit.say("scan.type")) }
                button #sound type="button" hidden aria-pressed="true" { (visit.say("scan.sound")) }
            }
            (live_lamp(visit))
        }
        (by_hand(visit, now, None))
        noscript { (by_hand(visit, now, Some(answer.and_then(|answer| answer.armed.as_deref()).unwrap_or_default()))) }
    }
}

fn live_lamp(visit: &Visit) -> Markup {
    html! {
        span #live .live { span #lamp role="status" { (visit.say("live.page")) } " " time #clock { (clock::local(clock::now_ms()).strftime("%H:%M:%S").to_string()) } }
    }
}

/// The form for people who type. For browsers without scripts it has the lane that was chosen last.
fn by_hand(visit: &Visit, now: &Now, unscripted: Option<&str>) -> Markup {
    let is_scripted = unscripted.is_none();
    html! {
        form id=[is_scripted.then_some("hand")] .hand method="post" action="/scan" autocomplete="off" {
            input type="hidden" name="csrf" value=(visit.csrf);
            input type="hidden" name="typed" value="true";
            @if let Some(chosen) = unscripted.filter(|chosen| !chosen.is_empty()) {
                input type="hidden" name="chosen" value=(chosen);
                input type="hidden" name="made_ms" value=(Moment::now().since_start_ms());
            }
            @if now.lanes.len() > 1 {
                label { (visit.say("hand.lane")) " "
                    select name="lane" {
                        option value="" { "–" }
                        @for state in &now.lanes { option selected[unscripted == Some(&state.lane)] { (state.lane) } }
                    }
                }
            }
            label { (visit.say("hand.serial")) " "
                input id=[is_scripted.then_some("hand-text")] name="text" required maxlength="200" spellcheck="false" autofocus[!is_scripted];
            }
            button { (visit.say("hand.send")) }
        }
    }
}

/// What was judged today, for everybody who may look.
pub(super) async fn today(State(app): State<App>, visit: Visit) -> Response {
    Html(or_why(counted(&app, &visit).await).into_string()).into_response()
}

/// What was judged today, or why that cannot be told, after which it is asked again: lanes are shown whatever the store says.
fn or_why(today: Result<Markup, Trouble>) -> Markup {
    today.unwrap_or_else(|trouble| html! { span data-again { (trouble.told()) } })
}

async fn counted(app: &App, visit: &Visit) -> Result<Markup, Trouble> {
    let now_ms = clock::now_ms();
    let Range { start: from_ms, end: until_ms } = clock::day_ms(now_ms);
    let period = Period { from_ms, until_ms };
    let wanted = Wanted { period, ..Wanted::default() };
    let look = move |snapshot: &Snapshot| Ok((yields(snapshot, &wanted, By::Plan)?, snapshot.unsent()?));
    let (counted, unsent) = app.look(visit, look).await?;
    let has_plant = app.settings().plant.is_some();
    Ok(html! { (summed(visit, &counted, now_ms)) (left(visit, &unsent, has_plant)) })
}

/// What the plant does not have yet, and what that other sink does not have that lacks most: a result that two of them lack
/// is one result.
fn left(visit: &Visit, unsent: &[Unsent], has_plant: bool) -> Markup {
    let (of_plant, others): (Vec<_>, Vec<_>) =
        unsent.iter().partition(|unsent| has_plant && unsent.sink == SINK_OF_PLANT);
    let [at_plant, elsewhere] =
        [of_plant, others].map(|sinks| sinks.iter().map(|unsent| unsent.results).max().unwrap_or_default());
    let number = |results: u32| results.to_string();
    html! {
        @if has_plant || elsewhere > 0 {
            " · " a href="/outbox" {
                @if has_plant { (visit.words.fill("today.unsent", &[("entries", &number(at_plant))])) }
                @if has_plant && elsewhere > 0 { " · " }
                @if elsewhere > 0 { (visit.words.fill("today.waiting", &[("entries", &number(elsewhere))])) }
            }
        }
    }
}

/// What was judged on the day of `now_ms`, by the clock on the wall. The history has days of UTC, so it is told which one is meant.
fn summed(visit: &Visit, Yields { lines, .. }: &Yields, now_ms: i64) -> Markup {
    let sum = |of: fn(&crate::history::yields::Yield) -> Rate| {
        lines.iter().map(of).fold((0, 0), |(count, all), rate| (count + rate.count, all + rate.of))
    };
    let (passed, units) = sum(|line| line.first_pass);
    let (errors, runs) = sum(|line| line.errors);
    let first_pass = visit.words.figures(&Rate::new(passed, units).text());
    let [judged, units, errors] = [runs - errors, units, errors].map(|count| count.to_string());
    let date = clock::local(now_ms).strftime("%Y-%m-%d (UTC%:z)").to_string();
    let values = [
        ("date", &*date),
        ("judged", &judged),
        ("units", &units),
        ("first", &first_pass),
        ("errors", &errors),
    ];
    html! { (visit.words.fill("today.counted", &values)) }
}
