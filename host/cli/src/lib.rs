//! The program `halfrow`: its commands, its settings, and what it prints.

pub mod commands;
mod progress;
pub mod serve;
pub mod settings;
