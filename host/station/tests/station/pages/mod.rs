//! The station's pages, by their program and over its socket.

mod access;
mod browser;
mod changes;
mod fuzz;
mod http;
mod lanes;
mod station;
mod table;
