//! Who does something, and why. The audit keeps both.

use clap::Args;

/// Who, and why.
#[derive(Debug, Args)]
pub(super) struct Why {
    /// Why
    #[arg(long, value_parser = said)]
    pub(super) reason: String,
    /// Your name, which the audit keeps
    #[arg(long, value_name = "NAME", value_parser = person)]
    pub(super) operator: String,
}

/// A reason, which blanks are not.
pub(super) fn said(text: &str) -> Result<String, String> {
    some(text, "say why in a few words")
}

/// The name of the person who acts. None is taken from the environment: `sudo -u halfrow` sets USER to a service's account.
pub(super) fn person(text: &str) -> Result<String, String> {
    some(text, "say who you are")
}

/// The text without blanks around it, or what is asked for in its place.
fn some(text: &str, asked: &str) -> Result<String, String> {
    let text = text.trim();
    if text.is_empty() { Err(asked.to_owned()) } else { Ok(text.to_owned()) }
}
