//! The program `halfrow`: its commands, its settings, and what it prints.

pub mod commands;
pub mod flags;
mod progress;
pub mod serve;
pub mod settings;
pub mod signals;
pub mod text;

pub use halfrow_program::{console, exit, guard, json};
