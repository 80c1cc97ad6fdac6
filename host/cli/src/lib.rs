//! The program `halfrow`: its commands, its settings, and what it prints.

#[cfg(not(target_os = "linux"))]
compile_error!("halfrow-cli is for Linux alone; docs/portable.md says what works elsewhere");

mod arguments;
mod beside;
mod bitstreams;
mod call_error;
pub mod commands;
mod document;
pub mod failure;
mod files;
pub mod flags;
mod pool;
mod progress;
pub mod serve;
pub mod settings;
pub mod signals;
pub mod text;

use halfrow_program::{console, exit, json};
