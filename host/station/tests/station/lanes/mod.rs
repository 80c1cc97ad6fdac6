//! A station with several lanes, by its program: scans in, news out.

mod ends;
mod floor;
mod hooks;
mod refused;
mod shift;
