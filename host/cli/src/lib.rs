//! The program `halfrow`: its commands, its settings, and what it prints.

pub mod commands;
pub mod console;
pub mod exit;
pub mod flags;
pub mod guard;
pub mod json;
mod progress;
pub mod serve;
pub mod settings;
pub mod signals;
pub mod text;
