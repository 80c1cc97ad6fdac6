//! The program `halfrow`: its commands, its settings, and what it prints.

pub mod commands;
pub mod console;
pub mod guard;
mod progress;
pub mod serve;
pub mod settings;
pub mod signals;
