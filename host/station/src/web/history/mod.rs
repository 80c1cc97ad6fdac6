//! What was judged, as pages: runs, units, yields, what fails most. They need no script.
//!
//! ```text
//!  /history ─► /runs/{run} ─► evidence and pictures by their hashes, exports
//!      └─────► /unit?serial=…      /yield      /pareto
//! ```

pub(super) mod acts;
mod bars;
mod csv;
mod evidence;
mod list;
pub(super) mod mismatch;
mod pareto;
mod pictures;
mod run;
mod run_filter;
pub(super) mod show;
mod unit;
mod yields;

pub(super) use run_filter::{station_address, unit_address};

use super::routes::{Route, Who, act, look};

pub(super) fn routes() -> Vec<Route> {
    vec![
        look("/history", Who::Reader, list::page),
        look("/history.csv", Who::Reader, csv::all),
        look("/runs/{run}", Who::Reader, run::page),
        act("/runs/{run}/waive", Who::Engineer, acts::waive),
        look("/runs/{run}/export/{format}", Who::Reader, evidence::export).while_program_is_same(),
        look("/runs/{run}/evidence/{hash}", Who::Reader, evidence::attachment).unchanging(),
        look("/runs/{run}/preview/{hash}", Who::Reader, pictures::preview).while_program_is_same(),
        look("/runs/{run}/difference/{found}/{expected}", Who::Reader, pictures::difference)
            .while_program_is_same(),
        look("/unit", Who::Reader, unit::page),
        act("/unit/rebind", Who::Engineer, acts::rebind),
        look("/yield", Who::Reader, yields::page),
        look("/pareto", Who::Reader, pareto::page),
    ]
}
