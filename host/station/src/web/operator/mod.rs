//! The operator's page: every lane with its state, and the box in which scans appear.

mod acts;
mod events;
mod lane;
mod page;
mod shapes;

use super::routes::{Route, Who, act, look};
use super::state::App;
use super::visit::Visit;

/// By this an open page finds out whether it still fits the station and whoever is logged in.
fn mark(app: &App, visit: &Visit) -> String {
    let user = visit.user.as_ref().map(|user| format!(" {:?} {}", user.who, user.name));
    format!("{}{}", app.mark(), user.unwrap_or_default())
}

pub(super) fn routes() -> Vec<Route> {
    vec![
        look("/", Who::Reader, page::page),
        look("/still", Who::Reader, page::still),
        look("/live", Who::Reader, events::events),
        look("/today", Who::Reader, page::today),
        // A badge logs somebody in, so anyone may scan.
        act("/scan", Who::Anyone, acts::scan),
        act("/lanes/{lane}/start", Who::Operator, acts::start),
        act("/lanes/{lane}/abort", Who::Operator, acts::abort),
        act("/lanes/{lane}/out", Who::Engineer, acts::out),
        act("/lanes/{lane}/in", Who::Engineer, acts::back),
    ]
}
