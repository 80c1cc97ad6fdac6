//! A production station: judges boards by plans, and keeps every result.
//!
//! ```text
//!  plan.toml, serial number ─► run ─► lane (a process of its own) ─► the judge, halfrow
//!                               │        │ JSON lines
//!                               ▼        ▼
//!                             record: one JSON file, by its hash ─► store: SQLite, its index
//!
//!  station.toml ─► settings ─► engine: scans in, news out; the floor says what is to be done, runs do it
//!                                ▲ ▼
//!                               web: the pages
//! ```

#![allow(
    clippy::result_large_err,
    clippy::large_enum_variant,
    reason = "a sentence carries its code, its figures and its causes, and is made a few times a run"
)]

#[cfg(not(target_os = "linux"))]
compile_error!("halfrow-station is for Linux alone; docs/portable.md says what works elsewhere");

pub mod check;
mod clock;
mod codes;
pub mod commands;
pub mod demo;
pub mod disk;
pub mod engine;
pub mod export;
pub mod floor;
pub mod history;
mod ids;
pub(crate) mod input_error;
pub mod kept;
pub mod labgrid;
pub mod lane;
pub mod outbox;
pub mod plan;
mod presence;
mod process_group;
pub mod progress;
pub mod published;
pub mod record;
pub mod run;
pub mod said;
pub mod secret;
pub mod settings;
pub mod store;
pub mod trust;
pub mod web;
pub mod work;

pub use halfrow_program::{console, exit, guard};
pub use ids::NoRandomness;
pub use input_error::InputError;
