//! What stands before every route: is it for this station, who asks, and may they.

use std::time::Duration;

use axum::extract::{Request, State};
use axum::http::header::{self, HeaderName};
use axum::http::{HeaderMap, HeaderValue, StatusCode};
use axum::middleware::Next;
use axum::response::{IntoResponse as _, Response};
use tokio::time;

use super::routes::Who;
use super::state::App;
use super::trouble::Trouble;
use super::visit::Visit;

/// How long an answer may take to begin.
const PATIENCE: Duration = Duration::from_secs(30);

/// What every answer carries. A page may load from the station alone, and stands in nobody's frame.
///
/// With `no-referrer` browsers send the origin `null` with forms; `same-origin` tells others as little.
const HEADERS: [(HeaderName, &str); 4] = [
    (
        header::CONTENT_SECURITY_POLICY,
        "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src 'self'; \
         form-action 'self'; base-uri 'none'; frame-ancestors 'none'",
    ),
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

/// Around all: whether it is for this station at all, how long it may take, and what every answer carries.
pub(super) async fn every(State(app): State<App>, request: Request, next: Next) -> Response {
    let visit = app.stranger(request.headers());
    let mut response = if host(request.headers()).is_some_and(|host| app.access().address().is_host(host)) {
        let late =
            || Trouble::new(&visit, StatusCode::REQUEST_TIMEOUT, visit.say("trouble.late")).into_response();
        time::timeout(PATIENCE, next.run(request)).await.unwrap_or_else(|_| late())
    } else {
        Trouble::new(&visit, StatusCode::MISDIRECTED_REQUEST, visit.say("trouble.host")).into_response()
    };
    for (name, value) in HEADERS {
        response.headers_mut().insert(name, HeaderValue::from_static(value));
    }
    response
}

/// Around a route: who asks, and whether they may.
pub(super) async fn route(State(guarded): State<Guarded>, request: Request, next: Next) -> Response {
    let Guarded { app, who, .. } = guarded;
    let mut visit = app.stranger(request.headers());
    visit.user = app.access().everybody().cloned();
    if who > Who::Reader && !visit.may(who) {
        return Trouble::new(&visit, StatusCode::FORBIDDEN, visit.say("trouble.forbidden")).into_response();
    }
    let mut request = request;
    request.extensions_mut().insert(visit);
    next.run(request).await
}

/// Where nothing is.
pub(super) async fn nothing_here(visit: Visit) -> Trouble {
    Trouble::missing(&visit)
}

fn host(headers: &HeaderMap) -> Option<&str> {
    let mut hosts = headers.get_all(header::HOST).into_iter();
    let host = hosts.next()?.to_str().ok()?;
    hosts.next().is_none().then_some(host)
}
