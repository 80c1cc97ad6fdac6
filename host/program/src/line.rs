//! Command lines that lead to no command.

use crate::console::{self, Unprinted};
use crate::exit::Exit;

/// Tells what the reader of a command line has to tell: help and version on stdout, what is wrong with a call on stderr.
///
/// # Errors
/// [`Unprinted`] when somebody asked for help or version, and stdout does not take it.
pub fn tell(told: &clap::Error) -> Result<Exit, Unprinted> {
    let text = told.render().ansi().to_string();
    if told.use_stderr() {
        console::diagnose_raw(&text);
        return Ok(Exit::Usage);
    }
    console::print_raw(&text).map(|()| Exit::Pass)
}
