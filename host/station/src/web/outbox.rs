//! What is still to be sent on, and what of it waits for a person. It needs no script.

use axum::Form;
use axum::extract::{Path, State};
use axum::http::StatusCode;
use axum::response::{IntoResponse as _, Redirect, Response};
use halfrow::words::plain;
use maud::{Markup, html};
use serde::Deserialize;

use super::history::acts::{RefusedAct, fields};
use super::history::show;
use super::layout::{Here, Page};
use super::routes::{Route, Who, act, look};
use super::state::App;
use super::trouble::Trouble;
use super::visit::Visit;
use crate::said::Said;
use crate::store::{By, DEAD_SHOWN, Dead, Entry, Kind, Reason, Store, Unsent};

pub(super) fn routes() -> Vec<Route> {
    vec![look("/outbox", Who::Reader, page), act("/outbox/{id}/release", Who::Engineer, release)]
}

/// A form that was refused: below which subject it is, and what was typed.
type Refused = RefusedAct<(String, Release)>;

async fn page(State(app): State<App>, visit: Visit) -> Result<Response, Trouble> {
    shown(app, visit, None).await
}

/// The page, with the reason why nothing was tried again, if that was asked for.
async fn shown(app: App, visit: Visit, refused: Option<Refused>) -> Result<Response, Trouble> {
    let found = app.look(&visit, |now| {
        let unsent = now.unsent()?;
        let dead = now.dead(&unsent)?;
        Ok((unsent, dead))
    });
    let (unsent, dead) = found.await?;
    let status = refused.as_ref().map_or(StatusCode::OK, |refused| refused.status);
    let content = html! {
        @if let Some(refused) = &refused { (refused.markup()) }
        h1 { (visit.say("outbox.title")) }
        @if unsent.is_empty() { p.nothing { (visit.say("outbox.none")) } } @else { (sinks(&visit, &unsent)) }
        @if !dead.is_empty() {
            h2 { (visit.say("outbox.dead")) }
            p.soft { (visit.say("outbox.about")) }
            @for of in &unsent { (more(&visit, of)) }
            @for one in &dead { (letter(&visit, one, refused.as_ref())) }
        }
    };
    let title = visit.say("outbox.title");
    let page = Page { here: Here::Elsewhere, title, head: show::head(), content };
    Ok(page.with_status(&visit, status))
}

fn sinks(visit: &Visit, unsent: &[Unsent]) -> Markup {
    html! {
        div.wide tabindex="0" role="region" aria-label=(visit.say("outbox.title")) { table.runs {
            thead { tr {
                th { (visit.say("outbox.sink")) } th.number { (visit.say("outbox.entries")) }
                th.number { (visit.say("outbox.waits")) } th { (visit.say("outbox.since")) }
                th { (visit.say("outbox.said")) }
            } }
            tbody { @for Unsent { sink, entries, dead, since_ms, said, .. } in unsent {
                tr {
                    td { (show::said(sink)) } td.number { (entries) } td.number { (dead) }
                    td.when { (show::titled_moment(*since_ms)) }
                    td.headline { @if let Some(said) = said { (show::told(&visit.words.tell(said))) } }
                }
            } }
        } }
    }
}

/// How many wait for a person at a sink, where not all of them are shown.
fn more(visit: &Visit, Unsent { sink, dead, .. }: &Unsent) -> Markup {
    let (shown, dead) = (DEAD_SHOWN, *dead);
    let names = [("shown", &*shown.to_string()), ("dead", &dead.to_string()), ("sink", &plain(sink))];
    html! { @if dead > shown { p { (visit.words.fill("outbox.more", &names)) } } }
}

/// Something that waits for a person, with the form by which an engineer has it tried again. After a refusal it is as it was sent.
fn letter(visit: &Visit, Dead { sink, entry, dead_ms, said }: &Dead, refused: Option<&Refused>) -> Markup {
    let Entry { kind, subject, .. } = entry;
    let is_of = |id: &String, asked: &Release| id == subject && asked.sink.as_ref() == Some(sink);
    let typed = refused.map(|refused| &refused.typed).filter(|(id, asked)| is_of(id, asked));
    let reason = typed.map_or("", |(_, asked)| &asked.reason);
    html! {
        form.change method="post" action=(format!("/outbox/{subject}/release")) autocomplete="off" {
            p {
                b { (show::said(sink)) } " · "
                @if *kind == Kind::Run { a href=(show::run_address(subject)) { (subject) } } @else { (subject) }
                " · " (show::moment(*dead_ms))
            }
            p { (show::told(&visit.words.tell(said))) }
            @if visit.may(Who::Engineer) {
                (fields(visit, reason))
                input type="hidden" name="sink" value=(sink);
                button { (visit.say("outbox.release")) }
            }
        }
    }
}

#[derive(Debug, Deserialize)]
struct Release {
    #[serde(default)]
    reason: String,
    /// Where it is tried again; at every sink without it.
    sink: Option<String>,
}

async fn release(
    State(app): State<App>,
    visit: Visit,
    Path(id): Path<String>,
    Form(asked): Form<Release>,
) -> Result<Response, Trouble> {
    let reason = match Reason::of(&asked.reason) {
        Ok(reason) => reason,
        Err(error) => {
            let why = (StatusCode::BAD_REQUEST, &Said::of(&error));
            let refused = RefusedAct::new(&visit, why, (id, asked));
            return shown(app, visit, Some(refused)).await;
        }
    };
    let operator = visit.name().to_owned();
    let release = move |store: &mut Store| {
        let by = By { operator: &operator, reason: &reason };
        match asked.sink {
            Some(sink) => store.release_at(&sink, &id, by),
            None => store.release(&id, by),
        }
    };
    let released = app.change(&visit, release).await?;
    released.map_err(|error| Trouble::store(&visit, &error))?;
    Ok(Redirect::to("/outbox").into_response())
}
