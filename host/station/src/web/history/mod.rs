//! What was judged, as pages: runs, units, yields, what fails most.

use super::routes::Route;

pub(super) fn routes() -> Vec<Route> {
    Vec::new()
}
