//! What was judged, read back: pages, units, yields, what fails most; and what is kept.

mod commands;
mod counted;
mod exports;
mod generated;
mod kept;
mod looked_at;
mod made;
mod pages;
mod pareto;
mod released;
mod served;
mod units;
mod unnamed;
mod waivers;
mod wilson;
mod yields;
