//! The plant, on a real PostgreSQL server, and what stations send to it.

pub(crate) mod checked;
pub(crate) mod clocks;
mod cut;
mod figures;
mod late;
pub(crate) mod link;
mod million;
mod mismatch;
pub(crate) mod pages;
mod plans;
mod plans_kept;
mod put_back;
mod refused;
mod rights;
pub(crate) mod sent;
pub(crate) mod server;
mod shift_units;
mod silent;
mod station_named;
mod tables;
mod tampered;
mod texts;
mod twice;
mod waiting;
pub(crate) mod way;
