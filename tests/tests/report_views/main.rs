//! The views of a report, on reports made by hand.

// clippy.toml allows these inside #[test] functions, but not in the functions that several tests call.
#![allow(clippy::unwrap_used, clippy::panic)]

mod folder;
mod html;
mod json;
mod junit;
mod made;
mod page_size;
mod pictures;
mod text;
