//! The program `halfrow`: its commands, its settings, and what it prints.

pub mod commands;
pub mod exit;
pub mod flags;
pub mod json;
mod progress;
pub mod serve;
pub mod settings;
pub mod text;
