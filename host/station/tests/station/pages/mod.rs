//! The station's pages, served by its program over a socket.

mod access;
mod browser;
mod changes;
mod clock_set;
mod fuzz;
mod gone;
mod guesses;
pub(crate) mod http;
mod lanes;
mod languages;
mod places;
mod pressed;
mod prompt;
mod secrets;
mod slow;
pub(crate) mod station;
mod table;
mod unaudited;
