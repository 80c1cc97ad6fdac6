//! Content that never changes, or only with the program: a browser that has it is not sent it again, but asks each time whether
//! it may still show it, because whoever has logged out may not see it.

use axum::extract::{Request, State};
use axum::http::header::{CACHE_CONTROL, ETAG, IF_NONE_MATCH};
use axum::http::{HeaderValue, StatusCode};
use axum::middleware::Next;
use axum::response::{IntoResponse as _, Response};

/// The entity tag of the only version that there is.
pub(super) const ONLY_VERSION: &str = "\"1\"";

/// The entity tag of what another version of the program may make differently.
pub(super) fn of_program() -> String {
    format!("\"{}\"", halfrow::result::sha256([halfrow::VERSION]))
}

/// Goes around a route, within the check of who asks; `tag` is the entity tag of its content.
pub(super) async fn revalidated(State(tag): State<String>, request: Request, next: Next) -> Response {
    let mut known = request.headers().get_all(IF_NONE_MATCH).iter();
    let is_known = known.any(|known| known.to_str().is_ok_and(|known| known.contains(&tag)));
    let mut response =
        if is_known { StatusCode::NOT_MODIFIED.into_response() } else { next.run(request).await };
    if is_known || response.status() == StatusCode::OK {
        let headers = response.headers_mut();
        headers.insert(CACHE_CONTROL, HeaderValue::from_static("private, no-cache"));
        if let Ok(tag) = HeaderValue::from_str(&tag) {
            headers.insert(ETAG, tag);
        }
    }
    response
}
