//! Style sheets and scripts, which are part of the program.

use axum::extract::Path;
use axum::http::header::{CACHE_CONTROL, CONTENT_TYPE};
use axum::response::{IntoResponse as _, Response};

use super::routes::{Route, Who, look};
use super::trouble::Trouble;
use super::visit::Visit;

const CSS: &str = "text/css; charset=utf-8";
const SCRIPT: &str = "text/javascript; charset=utf-8";

/// Every file by its name.
const ASSETS: [(&str, &str, &str); 9] = [
    ("style.css", CSS, include_str!("../../assets/style.css")),
    ("history.css", CSS, include_str!("../../assets/history.css")),
    ("operator.css", CSS, include_str!("../../assets/operator.css")),
    ("still.css", CSS, include_str!("../../assets/still.css")),
    ("operator.js", SCRIPT, include_str!("../../assets/operator.js")),
    ("scanner.js", SCRIPT, include_str!("../../assets/scanner.js")),
    ("live.js", SCRIPT, include_str!("../../assets/live.js")),
    ("floor.js", SCRIPT, include_str!("../../assets/floor.js")),
    ("sound.js", SCRIPT, include_str!("../../assets/sound.js")),
];

/// The texts of all files.
pub(super) fn texts() -> impl Iterator<Item = &'static str> {
    ASSETS.into_iter().map(|(_, _, text)| text)
}

pub(super) fn routes() -> Vec<Route> {
    vec![look("/assets/{name}", Who::Anyone, asset)]
}

async fn asset(visit: Visit, Path(name): Path<String>) -> Result<Response, Trouble> {
    let found = ASSETS.into_iter().find(|(known, _, _)| *known == name);
    let (_, kind, text) = found.ok_or_else(|| Trouble::missing(&visit))?;
    // Another version of the program may have others under the same names.
    Ok(([(CONTENT_TYPE, kind), (CACHE_CONTROL, "no-cache")], text).into_response())
}
