//! What was judged, as pages: runs, units, yields, what fails most. They need no script.
//!
//! ```text
//!  /history ─► /runs/{run} ─► evidence and pictures by their hashes, exports
//!      └─────► /unit?serial=…      /yield      /pareto
//! ```

mod asked;
mod bars;
mod evidence;
mod list;
mod pareto;
mod pictures;
mod run;
mod show;
mod unit;
mod yields;

use super::routes::{Route, Who, look};

pub(super) fn routes() -> Vec<Route> {
    vec![
        look("/history", Who::Reader, list::page),
        look("/runs/{run}", Who::Reader, run::page),
        look("/runs/{run}/export/{format}", Who::Reader, evidence::export),
        look("/runs/{run}/evidence/{hash}", Who::Reader, evidence::attachment),
        look("/runs/{run}/preview/{hash}", Who::Reader, pictures::preview),
        look("/runs/{run}/difference/{found}/{expected}", Who::Reader, pictures::difference),
        look("/unit", Who::Reader, unit::page),
        look("/yield", Who::Reader, yields::page),
        look("/pareto", Who::Reader, pareto::page),
    ]
}
