//! A station with several lanes, by its program: scans in, news out.

mod again;
mod dated;
pub(crate) mod ends;
mod flat;
pub(crate) mod floor;
mod held;
mod hooks;
mod labgrid;
mod moved;
mod operators;
mod refused;
mod replaced;
mod shift;
pub(crate) mod stuck;
mod supervised;
mod threads;
