//! Every route of the station, in one table. What is not in it is not served.

use axum::Router;
use axum::handler::Handler;
use axum::http::Method;
use axum::middleware;
use axum::routing::{self, MethodRouter};

use super::request_guard::{self, Guarded};
use super::state::App;
use super::{assets, etag, history, jobs, login, metrics, operator, outbox, plant};

/// Who may use a route.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Who {
    /// Everybody: what is needed to log in.
    Anyone,
    /// Who may see what is tested: everybody at the station itself, whoever is logged in elsewhere.
    Reader,
    /// Who tests boards.
    Operator,
    /// Who answers for the station.
    Engineer,
}

/// A line of the table.
#[derive(Clone, Debug)]
pub struct Route {
    /// The method. Whatever changes something is a POST.
    pub method: Method,
    /// The path, with `{name}` for a part that varies.
    pub path: &'static str,
    /// Who may.
    pub who: Who,
    handler: MethodRouter<App>,
}

impl Route {
    /// For content that never changes, because its hash is in its address.
    pub(super) fn unchanging(self) -> Self {
        self.tagged(etag::ONLY_VERSION.to_owned())
    }

    /// For content that never changes until another version of the program makes it.
    pub(super) fn while_program_is_same(self) -> Self {
        self.tagged(etag::of_program())
    }

    fn tagged(self, tag: String) -> Self {
        Self { handler: self.handler.layer(middleware::from_fn_with_state(tag, etag::revalidated)), ..self }
    }
}

/// A page to look at.
pub(super) fn look<H, T>(path: &'static str, who: Who, handler: H) -> Route
where
    H: Handler<T, App>,
    T: 'static,
{
    Route { method: Method::GET, path, who, handler: routing::get(handler) }
}

/// An act, which changes something.
pub(super) fn act<H, T>(path: &'static str, who: Who, handler: H) -> Route
where
    H: Handler<T, App>,
    T: 'static,
{
    Route { method: Method::POST, path, who, handler: routing::post(handler) }
}

/// The table.
#[must_use]
pub fn routes() -> Vec<Route> {
    let pages = [assets::routes(), login::routes(), operator::routes(), history::routes(), outbox::routes()];
    [pages.concat(), metrics::routes()].concat()
}

/// The table of a plant, whose pages only look.
#[must_use]
pub(crate) fn routes_of_plant() -> Vec<Route> {
    let looks = history::routes().into_iter().filter(|route| route.method == Method::GET).collect();
    [assets::routes(), login::routes(), plant::routes(), jobs::routes(), metrics::routes(), looks].concat()
}

/// The table of what is served.
fn table(app: &App) -> Vec<Route> {
    if app.is_plant() { routes_of_plant() } else { routes() }
}

/// Whether there is a page at this path.
fn is_page(app: &App, path: &str) -> bool {
    let is_at = |route: &Route| {
        let (known, asked) = (route.path.split('/'), path.split('/'));
        known.clone().count() == asked.clone().count()
            && known.zip(asked).all(|(known, asked)| known.starts_with('{') || known == asked)
    };
    table(app).iter().any(|route| route.method == Method::GET && is_at(route))
}

/// The page at this address, or else the nearest one above it, which is where the form of an act is; with the query.
pub(super) fn page_of(app: &App, asked: &str) -> String {
    let (mut path, query) = asked.split_once('?').map_or((asked, None), |(path, query)| (path, Some(query)));
    while !is_page(app, path) {
        match path.rsplit_once('/') {
            Some((above, _)) if !above.is_empty() => path = above,
            _ => return "/".to_owned(),
        }
    }
    let page = query.map_or_else(|| path.to_owned(), |query| format!("{path}?{query}"));
    // A form can send what no header holds.
    if page.bytes().all(|byte| byte.is_ascii_graphic()) { page } else { "/".to_owned() }
}

/// The table as a service. What all routes have in common goes around the whole, what depends on a line goes around its route.
pub(super) fn router(app: &App) -> Router {
    let with = |router: Router<App>, Route { method, path, who, handler }: Route| {
        let guarded = Guarded { app: app.clone(), who, is_act: method == Method::POST };
        router.route(path, handler.layer(middleware::from_fn_with_state(guarded, request_guard::route)))
    };
    let router = table(app).into_iter().fold(Router::new(), with).fallback(request_guard::nothing_here);
    router.layer(middleware::from_fn_with_state(app.clone(), request_guard::every)).with_state(app.clone())
}
