//! The page's news, as server-sent events (HTML, section 9.2).

use std::convert::Infallible;
use std::fmt::Write as _;

use axum::body::Body;
use axum::extract::State;
use axum::http::header::{CACHE_CONTROL, CONTENT_TYPE, HeaderName};
use axum::response::{IntoResponse as _, Response};
use futures_util::stream;
use serde::Serialize;
use serde_json::{Value, json};
use tokio::sync::broadcast::Receiver;

use super::lane::LaneEvent;
use crate::clock;
use crate::engine::{Became, FailedHook, LaneDoing, News};
use crate::web::live::{Event, EventKind, Live, Now};
use crate::web::state::App;
use crate::web::trouble::Trouble;
use crate::web::visit::Visit;

/// The header that tells a proxy to pass everything on at once.
const UNBUFFERED: HeaderName = HeaderName::from_static("x-accel-buffering");

/// Everything as it is, then what changes.
pub(super) async fn events(State(app): State<App>, visit: Visit) -> Result<Response, Trouble> {
    let (now, told) = app.lanes(&visit)?.live.follow();
    let first = snapshot(&super::mark(&app, &visit), &visit, &now);
    let news = stream::unfold((Some(first), Follower { app, visit, told }), |(first, of)| next(first, of));
    let headers = [(CONTENT_TYPE, "text/event-stream"), (CACHE_CONTROL, "no-store"), (UNBUFFERED, "no")];
    Ok((headers, Body::from_stream(news)).into_response())
}

/// A page that is open.
struct Follower {
    app: App,
    visit: Visit,
    told: Receiver<Event>,
}

/// The next event. The stream ends for a page that lags too far behind, which then connects anew, and for one whose user has
/// logged out or is another now.
async fn next(
    first: Option<String>,
    mut of: Follower,
) -> Option<(Result<String, Infallible>, (Option<String>, Follower))> {
    let text = match first {
        Some(first) => first,
        None => {
            let told = of.told.recv().await.ok()?;
            if matches!(told.what, EventKind::Beat(_)) && !is_still(&of.app, &of.visit).await {
                return None;
            }
            news(&of.app.lanes(&of.visit).ok()?.live, &of.visit, &told)
        }
    };
    Some((Ok(text), (None, of)))
}

/// Whether the visitor is still who they were when they began to follow.
async fn is_still(app: &App, visit: &Visit) -> bool {
    let is_open = app.access().is_open();
    // A machine, which has no session, may go on to look where everybody may.
    if is_open && visit.session.is_empty() {
        return true;
    }
    match app.user(visit, Some(visit.session.clone()), false).await {
        Ok(Ok(user)) => user == visit.user,
        // While the people cannot be read, whoever is logged in stays so.
        Ok(Err(_)) => is_open,
        Err(_) => false,
    }
}

/// Everything, with the mark of the page that it is for.
fn snapshot(mark: &str, visit: &Visit, now: &Now) -> String {
    let event = |state| LaneEvent::new(visit, state, now.doing.get(&state.lane));
    let lanes: Vec<_> = now.lanes.iter().map(event).collect();
    let hooks: Vec<_> = now.failed.values().map(|failed| hook(visit, failed)).collect();
    event_text(now.id, "snapshot", &json!({ "mark": mark, "beat": now.beat, "lanes": lanes, "hooks": hooks }))
}

fn news(live: &Live, visit: &Visit, told: &Event) -> String {
    let id = told.id;
    let news = match &told.what {
        EventKind::Beat(beat) => {
            let clock = clock::local(clock::now_ms()).strftime("%H:%M:%S").to_string();
            return event_text(id, "beat", &json!({ "clock": clock, "beat": beat }));
        }
        EventKind::News(news) => news,
    };
    match &**news {
        News::Lane(state) => event_text(id, "lane", &{
            let doing = state.run.as_ref().and_then(|run| live.doing(&state.lane, run));
            LaneEvent::new(visit, state, doing.as_ref())
        }),
        News::Doing(LaneDoing { lane, run, what }) => event_text(id, "doing", &{
            let (told, rows) = (visit.words.doing(what), what.rows());
            json!({ "lane": lane, "run": run, "what": told.text, "lang": told.foreign, "rows": rows })
        }),
        // Only whoever scanned gets the whole answer: the scan may have been a badge.
        News::Scan(Became { is_taken, lane, .. }) => {
            event_text(id, "scan", &json!({ "is_taken": is_taken, "lane": lane }))
        }
        News::Hook(failed) => event_text(id, "hook", &hook(visit, failed)),
    }
}

/// A hook that failed.
fn hook(visit: &Visit, FailedHook { lane, serial, said, .. }: &FailedHook) -> Value {
    json!({ "lane": lane, "serial": serial, "said": visit.words.tell(said).text })
}

fn event_text(id: u64, name: &str, data: &impl Serialize) -> String {
    // JSON is written without line breaks, which would end the event.
    let data = serde_json::to_string(data).unwrap_or_default();
    let mut text = String::with_capacity(data.len() + 64);
    let _ = write!(text, "id: {id}\nevent: {name}\ndata: {data}\n\n");
    text
}
