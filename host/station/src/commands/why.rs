//! Who does something, and why. The audit keeps both.

use clap::Args;

/// Who, and why.
#[derive(Debug, Args)]
pub(super) struct Why {
    /// Why
    #[arg(long, value_parser = said)]
    pub(super) reason: String,
    /// Who says so
    #[arg(long, value_name = "NAME", env = "USER", default_value = "unknown")]
    pub(super) operator: String,
}

/// A reason, which blanks are not.
fn said(text: &str) -> Result<String, String> {
    let reason = text.trim();
    if reason.is_empty() { Err("say why in a few words".to_owned()) } else { Ok(reason.to_owned()) }
}
