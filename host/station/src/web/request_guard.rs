//! The checks before every route: is the request for this station, who asks, and may they.

use std::net::{IpAddr, Ipv4Addr};
use std::time::Duration;

use axum::body::{self, Body, Bytes};
use axum::extract::{Request, State};
use axum::http::header::{self, HeaderName};
use axum::http::uri::PathAndQuery;
use axum::http::{HeaderMap, HeaderValue, Method, StatusCode};
use axum::middleware::Next;
use axum::response::{IntoResponse as _, Redirect, Response};
use tokio::time;

use super::access::Machine;
use super::login::Peer;
use super::routes::{Who, page_of};
use super::state::App;
use super::trouble::Trouble;
use super::visit::{User, Visit, cookie};
use crate::said::Said;

/// How long an answer may take to begin.
const PATIENCE: Duration = Duration::from_secs(30);
/// How long a form may take to arrive, because its connection takes up a slot meanwhile.
const FORM: Duration = Duration::from_secs(10);
/// The most bytes of a form.
const MOST: usize = 64 * 1024;
/// The field of every form that says for whom it was made.
const MARK: &str = "csrf";

/// What pages may load, which is only from the station, and who may frame them.
macro_rules! policy {
    ($frames:literal) => {
        concat!(
            "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src 'self'; ",
            "frame-src 'self'; form-action 'self'; base-uri 'none'; frame-ancestors ",
            $frames
        )
    };
}

/// The policy of a page that is framed by another page of the station.
pub(super) const FRAMED: &str = policy!("'self'");

/// The headers of every answer that does not have its own. By default nobody may frame a page.
///
/// With `no-referrer` browsers send the origin `null` with forms; `same-origin` tells other sites just as little.
const HEADERS: [(HeaderName, &str); 4] = [
    (header::CONTENT_SECURITY_POLICY, policy!("'none'")),
    (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
    (header::REFERRER_POLICY, "same-origin"),
    (HeaderName::from_static("cross-origin-resource-policy"), "same-origin"),
];

/// A route with what it demands.
#[derive(Clone, Debug)]
pub(super) struct Guarded {
    pub(super) app: App,
    pub(super) who: Who,
    pub(super) is_act: bool,
}

/// Goes around all routes: whether a request is for this station at all, how long it may take, and the headers of every answer.
pub(super) async fn every(State(app): State<App>, request: Request, next: Next) -> Response {
    let visit = app.stranger(request.headers());
    let is_ours = host(request.headers()).is_some_and(|host| app.access().address().is_host(host));
    let mut response = if app.access().is_open() && is_forwarded(request.headers()) {
        Trouble::new(&visit, StatusCode::MISDIRECTED_REQUEST, visit.say("trouble.proxied")).into_response()
    } else if is_ours {
        // What is late is the station's answer, not the request.
        let is_act = request.method() == Method::POST;
        let said = if is_act { visit.say("trouble.late_act") } else { visit.say("trouble.late") };
        let late = || Trouble::new(&visit, StatusCode::SERVICE_UNAVAILABLE, said);
        time::timeout(PATIENCE, next.run(request)).await.unwrap_or_else(|_| late().into_response())
    } else {
        // A foreign page whose name was made to resolve to this address can read this, so it says little.
        (StatusCode::MISDIRECTED_REQUEST, visit.say("trouble.host")).into_response()
    };
    for (name, value) in HEADERS {
        response.headers_mut().entry(name).or_insert(HeaderValue::from_static(value));
    }
    response
}

/// Goes around a route: who asks, and whether they may.
pub(super) async fn route(State(guarded): State<Guarded>, request: Request, next: Next) -> Response {
    let Guarded { app, who, is_act } = guarded;
    // A browser asks for it whose address bar still has an act's address.
    if is_act && [Method::GET, Method::HEAD].contains(request.method()) {
        return Redirect::to(&page_of(&app, asked(&request))).into_response();
    }
    let visit = match bearer(request.headers()).filter(|_| !app.access().asks_nobody()) {
        None => app.visit(request.headers(), is_act).await.map_err(troubled),
        Some(token) => {
            let peer =
                request.extensions().get().map_or(IpAddr::V4(Ipv4Addr::UNSPECIFIED), |Peer(peer)| *peer);
            let stranger = Visit { is_new: false, ..app.stranger(request.headers()) };
            machine(&app, token, (stranger, peer), is_act).await
        }
    };
    let visit = match visit {
        Ok(visit) => visit,
        Err(refused) => return *refused,
    };
    let checked = if is_act { act(&app, &visit, who, request).await } else { look(&visit, who, request) };
    match checked {
        Err(refused) => *refused,
        Ok(mut request) => {
            let cookie = if is_act { None } else { new_cookie(&app, &visit) };
            request.extensions_mut().insert(visit);
            let mut response = next.run(request).await;
            if let Some(cookie) = cookie {
                response.headers_mut().insert(header::SET_COOKIE, cookie);
            }
            response
        }
    }
}

/// The address that is asked for, with its query.
fn asked(request: &Request) -> &str {
    request.uri().path_and_query().map_or("/", PathAndQuery::as_str)
}

/// The cookie that a visitor without one is given.
fn new_cookie(app: &App, visit: &Visit) -> Option<HeaderValue> {
    visit.is_new.then(|| HeaderValue::from_str(&app.access().cookie(&visit.session)).ok()).flatten()
}

/// A refusal on the way to a route.
type RefusedRequest = Box<Response>;

fn refused(visit: &Visit, status: StatusCode, said: &'static str) -> RefusedRequest {
    Box::new(Trouble::new(visit, status, said).into_response())
}

fn troubled(trouble: Trouble) -> RefusedRequest {
    Box::new(trouble.into_response())
}

/// The token of a machine (RFC 6750, section 2.1).
fn bearer(headers: &HeaderMap) -> Option<&str> {
    let (scheme, token) = headers.get(header::AUTHORIZATION)?.to_str().ok()?.split_once(' ')?;
    scheme.eq_ignore_ascii_case("Bearer").then_some(token)
}

/// A machine that asks with a token: it is let in to look, and not to act.
async fn machine(
    app: &App,
    token: &str,
    (stranger, peer): (Visit, IpAddr),
    is_act: bool,
) -> Result<Visit, RefusedRequest> {
    let told = |visit: Visit, act, from: String| async move {
        let told = app.audit(&visit, act, &from, "").await.map(|()| visit);
        told.map_err(troubled)
    };
    let (of, token) = (app.clone(), token.to_owned());
    let asked = app.blocking(&stranger, move || of.access().machine(&token, peer)).await;
    match asked.map_err(troubled)?.map_err(|error| troubled(Trouble::secret(&stranger, &error)))? {
        Machine::Waits(wait) => Err(troubled(Trouble::waits(&stranger, wait))),
        Machine::Unknown => {
            let visit = told(stranger, "token refused", peer.to_string()).await?;
            Err(refused(&visit, StatusCode::UNAUTHORIZED, visit.say("trouble.login")))
        }
        Machine::Known { name, is_noted } => {
            let user = Some(User { name: name.clone(), who: Who::Reader });
            let visit = Visit { user, ..stranger };
            if is_act {
                return Err(refused(&visit, StatusCode::FORBIDDEN, visit.say("trouble.forbidden")));
            }
            if is_noted {
                return Ok(visit);
            }
            let visit = told(visit, "token", peer.to_string()).await?;
            app.access().noted(name, peer);
            Ok(visit)
        }
    }
}

/// Checks a request for a page: whoever may not see it is sent to log in.
fn look(visit: &Visit, who: Who, request: Request) -> Result<Request, RefusedRequest> {
    if visit.may(who) {
        return Ok(request);
    }
    let wants_page = request
        .headers()
        .get(header::ACCEPT)
        .is_some_and(|accept| accept.to_str().is_ok_and(|accept| accept.contains("text/html")));
    match visit.user {
        None if wants_page && visit.untold.is_none() => Err(Box::new(to_login(asked(&request)))),
        _ => Err(Box::new(Trouble::barred(visit).into_response())),
    }
}

/// The way to the login, which leads back to what was asked for.
fn to_login(asked: &str) -> Response {
    let page: String = form_urlencoded::byte_serialize(asked.as_bytes()).collect();
    Redirect::to(&format!("/login?page={page}")).into_response()
}

/// Checks an act: it comes from a page of the station, made for this browser, by somebody who may do it.
async fn act(app: &App, visit: &Visit, who: Who, request: Request) -> Result<Request, RefusedRequest> {
    let headers = request.headers();
    let is_own = host(headers).zip(only(headers, &header::ORIGIN));
    if !is_own.is_some_and(|(host, origin)| app.access().address().is_origin(origin, host)) {
        return Err(refused(visit, StatusCode::FORBIDDEN, visit.say("trouble.origin")));
    }
    if !visit.may(who) {
        let barred = Trouble::barred(visit);
        let is_over = visit.user.is_none() && visit.untold.is_none() && visit.can_log_in;
        let page = page_of(app, asked(&request));
        return Err(if is_over { with_form(app, visit, barred, page) } else { troubled(barred) });
    }
    if app.is_ending() {
        return Err(refused(visit, StatusCode::SERVICE_UNAVAILABLE, visit.say("trouble.ending")));
    }
    let is_login = request.uri().path() == "/login";
    let unmarked = || if is_login { login_anew(app, visit) } else { troubled(Trouble::stale(visit)) };
    if visit.is_new {
        return Err(unmarked());
    }
    let (parts, body) = request.into_parts();
    let body = time::timeout(FORM, body::to_bytes(body, MOST)).await;
    let body =
        body.map_err(|_| refused(visit, StatusCode::REQUEST_TIMEOUT, visit.say("trouble.late_form")))?;
    let body = body.map_err(|_| refused(visit, StatusCode::PAYLOAD_TOO_LARGE, visit.say("trouble.large")))?;
    if !mark(&body).is_some_and(|mark| app.access().is_form_mark(&visit.session, &mark)) {
        return Err(unmarked());
    }
    Ok(Request::from_parts(parts, Body::from(body)))
}

/// The answer to a login with a form that was made for another cookie: a form for the cookie that the visitor has, or is given.
fn login_anew(app: &App, visit: &Visit) -> RefusedRequest {
    let stale = Trouble::new(visit, StatusCode::FORBIDDEN, visit.say("login.stale"));
    with_form(app, visit, stale, String::new())
}

/// A refusal with a form that logs in for the cookie that the visitor has, or is given, and leads to `page`.
fn with_form(app: &App, visit: &Visit, refused: Trouble, page: String) -> RefusedRequest {
    let mut response = refused.at_login(page).into_response();
    if let Some(cookie) = new_cookie(app, visit) {
        response.headers_mut().insert(header::SET_COOKIE, cookie);
    }
    Box::new(response)
}

/// The mark that a form carries.
fn mark(body: &Bytes) -> Option<String> {
    let text = std::str::from_utf8(body).ok()?;
    let mut marks = text.split('&').filter_map(|pair| pair.split_once('=')).filter(|(name, _)| *name == MARK);
    let (_, mark) = marks.next()?;
    // Hexadecimal digits need no escapes, so none are undone.
    marks.next().is_none().then(|| mark.to_owned())
}

/// The answer where there is no route.
pub(super) async fn nothing_here(State(app): State<App>, headers: HeaderMap) -> Trouble {
    app.visit(&headers, false).await.map_or_else(|trouble| trouble, |visit| Trouble::missing(&visit))
}

/// Whether a proxy says that it forwards a request of somebody else, who need not be at this computer as whoever sees open pages is.
fn is_forwarded(headers: &HeaderMap) -> bool {
    let names = ["forwarded", "via", "x-real-ip", "x-forwarded-for", "x-forwarded-host", "x-forwarded-proto"];
    names.iter().any(|name| headers.contains_key(*name))
}

fn host(headers: &HeaderMap) -> Option<&str> {
    only(headers, &header::HOST)
}

/// The value of a header that is there exactly once.
fn only<'a>(headers: &'a HeaderMap, name: &HeaderName) -> Option<&'a str> {
    let mut values = headers.get_all(name).into_iter();
    let value = values.next()?.to_str().ok()?;
    values.next().is_none().then_some(value)
}

impl App {
    /// Who asks, and in which language. A visitor without a cookie gets a new one.
    ///
    /// # Errors
    /// [`Trouble`] when that broke off.
    async fn visit(&self, headers: &HeaderMap, is_act: bool) -> Result<Visit, Trouble> {
        let (access, stranger) = (self.access(), self.stranger(headers));
        let sent = cookie(headers, &access.cookie_name()).map(str::to_owned);
        let (mut user, untold) = match self.user(&stranger, sent.clone(), is_act).await? {
            Ok(user) => (user, None),
            Err(error) => (None, Some(Said::of(&error))),
        };
        if let Some(why) = &untold {
            tracing::error!("{}", why.with_codes());
        }
        if let Some(user) = user.as_mut().filter(|_| self.is_plant()) {
            user.who = user.who.min(Who::Reader);
        }
        let is_new = sent.is_none();
        let session = sent.or_else(|| access.begin(None).ok()).unwrap_or_default();
        let (csrf, can_log_in) = (access.form_mark(&session), access.has_people());
        Ok(Visit { csrf, user, untold, session, is_new, can_log_in, ..stranger })
    }
}

#[cfg(test)]
pub(super) mod tests {
    use std::sync::Arc;

    use tokio::runtime::Builder;

    use super::*;
    use crate::engine::{self, Engine};
    use crate::web::access::Access;

    /// The pages of a station with one lane, whose settings are in `folder`.
    pub(in crate::web) fn station(folder: &std::path::Path) -> (App, Arc<Engine>) {
        let (settings, engine) = engine::tests::station(folder);
        let weber = User { name: "weber".to_owned(), who: Who::Operator };
        let access = Access::of(&settings, weber).unwrap();
        (App::new(settings, Arc::clone(&engine), access, Vec::new()).unwrap(), engine)
    }

    /// A request of the station's own page.
    fn own(app: &App, session: &str) -> Request {
        let here = "127.0.0.1:8612";
        let request =
            Request::builder().header(header::HOST, here).header(header::ORIGIN, format!("http://{here}"));
        let cookie = format!("{}={session}", app.access().cookie_name());
        let mark = format!("{MARK}={}", app.access().form_mark(session));
        request.header(header::COOKIE, cookie).body(Body::from(mark)).unwrap()
    }

    /// As between SIGTERM and the end of the pages, however long runs and sinks then take.
    #[test]
    fn no_act_begins_while_the_station_ends() {
        let folder = tempfile::tempdir().unwrap();
        let (app, engine) = station(folder.path());
        let session = app.access().begin(None).unwrap();
        let asked = || async {
            let request = own(&app, &session);
            let visit = app.visit(request.headers(), true).await.unwrap();
            let refused = act(&app, &visit, Who::Operator, request).await.err();
            refused.map(|refused| refused.status())
        };
        let runtime = Builder::new_current_thread().enable_all().build().unwrap();
        assert_eq!(runtime.block_on(asked()), None, "the control");
        engine.close(None);
        assert_eq!(runtime.block_on(asked()), Some(StatusCode::SERVICE_UNAVAILABLE));
    }
}
