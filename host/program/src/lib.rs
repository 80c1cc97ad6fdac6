//! What the programs `halfrow` and `halfrow-station` stand on, so that scripts and people find the same in both.
//!
//! * [`exit`]: the exit codes, which are the library's.
//! * [`console`]: the one place that writes to stdout and stderr.
//! * [`log`]: what goes to stderr when somebody wants to know.
//! * [`guard`]: a panic is an error with exit code 3, never 101.
//! * [`json`]: what documents of both programs begin with, and [`codes`]: why there is no result.
//! * [`mod@line`]: what a command line that asks for help, or is wrong, is told, and [`built`]: what `--version --verbose` tells.
//! * [`number`]: options that take a number within limits.
//! * [`man_pages`]: man pages and completion scripts, and [`mod@reference`]: the page of all commands.
//! * [`signals`]: those that are not to be heard.

pub mod built;
pub mod codes;
pub mod console;
pub mod guard;
pub mod json;
pub mod line;
pub mod log;
pub mod man_pages;
pub mod number;
pub mod reference;
pub mod signals;
mod variables;

pub use halfrow::exit;
