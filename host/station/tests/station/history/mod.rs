//! What was judged, read back: pages, units, yields, the most frequent failures; and what is kept.

pub(crate) mod commands;
mod control;
mod copied;
mod copied_plans;
mod counted;
mod damaged;
mod exports;
pub(crate) mod generated;
pub(crate) mod in_time;
mod kept;
mod looked_at;
pub(crate) mod made;
mod pages;
mod pareto;
mod pictures;
mod piped;
mod put_back;
mod read_only;
pub(crate) mod released;
pub(crate) mod served;
mod units;
mod unnamed;
mod untested;
mod upgraded;
mod waivers;
mod wilson;
mod yields;
