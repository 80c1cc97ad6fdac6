//! What Prometheus gets, read by Prometheus' own programs.

mod counts;
mod figures;
pub(crate) mod of_plant;
mod prometheus;
mod rules;
pub(crate) mod text;
