//! Logging in and out, and the choice of a language.

use std::net::IpAddr;

use axum::extract::State;
use axum::http::{HeaderMap, HeaderValue, StatusCode, header};
use axum::response::{IntoResponse as _, Redirect, Response};
use axum::{Extension, Form};
use maud::{Markup, html};
use serde::Deserialize;

use super::access::{Claimant, Identified};
use super::fields::Fields;
use super::history::show;
use super::language::{self, Sentence};
use super::layout::{Here, Page};
use super::routes::{Route, Who, act, look, page_of};
use super::state::App;
use super::trouble::Trouble;
use super::visit::Visit;

/// How long the choice of a language is kept, in seconds.
const YEAR: u32 = 31_536_000;

/// Where a request comes from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Peer(pub(super) IpAddr);

pub(super) fn routes() -> Vec<Route> {
    vec![
        look("/login", Who::Anyone, page),
        act("/login", Who::Anyone, log_in),
        act("/logout", Who::Anyone, log_out),
        act("/language", Who::Anyone, choose),
    ]
}

/// Where a login leads.
#[derive(Default, Deserialize)]
#[serde(default)]
struct Wanted {
    page: String,
}

async fn page(visit: Visit, Fields(Wanted { page }): Fields<Wanted>) -> Response {
    asked(&visit, None, &page).answer(&visit)
}

/// The page that asks for a badge, below why the last one or an act was refused; a login leads to the address `page`.
pub(super) fn asked(visit: &Visit, refused: Option<&Sentence>, page: &str) -> Page<'static> {
    let title = visit.say("login.title");
    Page { here: Here::Elsewhere, title, head: html! {}, content: form(visit, refused, page) }
}

fn form(visit: &Visit, refused: Option<&Sentence>, page: &str) -> Markup {
    html! {
        section.login {
            h1 { (visit.say("login.title")) }
            @if let Some(refused) = refused { p.refused role="alert" { (show::told(refused)) } }
            form method="post" action="/login" autocomplete="off" {
                input type="hidden" name="csrf" value=(visit.csrf);
                @if !page.is_empty() { input type="hidden" name="page" value=(page); }
                label { (visit.say("login.badge")) input type="password" name="badge" required autofocus maxlength="200"; }
                label { (visit.say("login.password")) input type="password" name="password" maxlength="200"; }
                p { (visit.say("login.who")) }
                button { (visit.say("login.title")) }
            }
        }
    }
}

#[derive(Deserialize)]
struct Login {
    badge: String,
    #[serde(default)]
    password: String,
    /// The address that the login leads to.
    #[serde(default)]
    page: String,
}

async fn log_in(
    State(app): State<App>,
    Extension(Peer(peer)): Extension<Peer>,
    visit: Visit,
    Form(Login { badge, password, page }): Form<Login>,
) -> Result<Response, Trouble> {
    let badge = app.settings().scanner.label(&badge).map(str::to_owned).unwrap_or(badge);
    let refused = || Trouble::new(&visit, StatusCode::FORBIDDEN, visit.say("login.refused"));
    let known = identified(&app, &visit, Claimant::Stranger(peer), (badge, password)).await;
    let known = known
        .and_then(|known| known.ok_or_else(refused))
        .map_err(|trouble| trouble.at_login(page.clone()))?;
    let cookie = logged_in(&app, &visit, known).await?;
    Ok(([(header::SET_COOKIE, cookie)], Redirect::to(&page_of(&app, &page))).into_response())
}

/// Who has this badge and this password, if anybody. Whoever guesses has to wait after some failures.
pub(super) async fn identified(
    app: &App,
    visit: &Visit,
    by: Claimant,
    (badge, password): (String, String),
) -> Result<Option<Identified>, Trouble> {
    if let Some(wait) = app.access().attempt(&by) {
        return Err(Trouble::waits(visit, wait));
    }
    let access = app.clone();
    let known = app.blocking(visit, move || access.access().identify(&badge, &password)).await?;
    match (&known, &by) {
        // If it cannot be found out who this is, it was no guess.
        (Ok(Some(_)) | Err(_), _) => app.access().succeeded(&by),
        (Ok(None), Claimant::Stranger(peer)) => {
            app.audit(visit, "login refused", &peer.to_string(), "").await?;
        }
        // Most likely it was no badge at all.
        (Ok(None), Claimant::Person(_)) => {}
    }
    known.map_err(|error| Trouble::secret(visit, &error))
}

/// Logs somebody in, instead of whoever was; returns the cookie to be set.
pub(super) async fn logged_in(app: &App, visit: &Visit, who: Identified) -> Result<HeaderValue, Trouble> {
    let now = Visit { user: Some(who.user.clone()), ..visit.clone() };
    app.audit(&now, "login", if now.may(Who::Engineer) { "engineer" } else { "operator" }, "").await?;
    anew(app, visit, Some(who)).await
}

async fn log_out(State(app): State<App>, visit: Visit) -> Result<Response, Trouble> {
    if visit.user.is_some() {
        app.audit(&visit, "logout", "", "").await?;
    }
    let cookie = anew(&app, &visit, None).await?;
    Ok(([(header::SET_COOKIE, cookie)], Redirect::to("/")).into_response())
}

/// Ends the visitor's session and begins a new one; returns its cookie.
async fn anew(app: &App, visit: &Visit, who: Option<Identified>) -> Result<HeaderValue, Trouble> {
    let (of, session) = (app.clone(), visit.session.clone());
    let begun = move || {
        of.access().end(&session);
        of.access().begin(who)
    };
    let session = app.blocking(visit, begun).await?.map_err(|error| Trouble::broken(visit, &error))?;
    HeaderValue::from_str(&app.access().cookie(&session)).map_err(|error| Trouble::broken(visit, &error))
}

#[derive(Deserialize)]
struct Choice {
    language: String,
}

async fn choose(
    State(app): State<App>,
    visit: Visit,
    headers: HeaderMap,
    Form(choice): Form<Choice>,
) -> Result<Response, Trouble> {
    let known = language::all().find(|(code, _)| *code == choice.language);
    let (code, _) = known.ok_or_else(|| Trouble::wrong(&visit, visit.say("login.language")))?;
    let secure = if app.access().address().is_https() { "; Secure" } else { "" };
    let name = language::COOKIE;
    let cookie = format!("{name}={code}; Path=/; Max-Age={YEAR}; HttpOnly; SameSite=Lax{secure}");
    let back = from(&headers).map_or_else(|| "/".to_owned(), |from| page_of(&app, from));
    Ok(([(header::SET_COOKIE, cookie)], Redirect::to(&back)).into_response())
}

/// The address of what a form was on, with its query. That of the answer to an act is the act's.
fn from(headers: &HeaderMap) -> Option<&str> {
    let (_, page) = headers.get(header::REFERER)?.to_str().ok()?.split_once("://")?;
    page.get(page.find('/')?..)
}
