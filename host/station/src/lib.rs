//! A production station: judges boards by plans, and keeps every result.
//!
//! ```text
//!  plan.toml, serial number ─► run ─► lane (a process of its own) ─► the judge, halfrow
//!                               │        │ JSON lines
//!                               ▼        ▼
//!                             record: one JSON file, by its hash ─► store: SQLite, its index
//! ```

pub mod check;
mod clock;
pub mod commands;
pub mod console;
pub mod exit;
mod ids;
pub mod input_error;
pub mod lane;
pub mod plan;
pub mod record;
pub mod run;
pub mod store;
