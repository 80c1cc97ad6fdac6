//! What the programs `halfrow` and `halfrow-station` have in common, so that both behave alike for scripts and people.
//!
//! * [`exit`]: the exit codes, which are the library's.
//! * [`console`]: the one place that writes to stdout and stderr.
//! * [`log`]: what goes to stderr on request.
//! * [`guard`]: a panic is an error with exit code 3, never 101.
//! * [`json`]: the common part of documents, and [`codes`]: why there is no result.
//! * [`mod@line`]: the answer to a command line that asks for help or is wrong, and [`built`]: to `--version --verbose`.
//! * [`number`]: options that take a number within limits, and [`choice`]: one of a few words.
//! * [`files`]: where a command writes.
//! * [`man_pages`]: man pages and completion scripts, and [`mod@reference`]: the page of all commands.
//! * [`signals`]: signals that are ignored or must not end the program.

pub mod built;
pub mod choice;
pub mod codes;
pub mod console;
pub mod files;
pub mod guard;
pub mod json;
pub mod line;
pub mod log;
pub mod man_pages;
pub mod number;
pub mod reference;
pub mod signals;
mod usage;
mod variables;

pub use halfrow::exit;
